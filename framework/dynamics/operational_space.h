#pragma once

#include <Eigen/Core>
#include <vector>

namespace tactus::dynamics {

struct OperationalSpaceOptions {
  /// Rows of J L⁻ᵀ shorter than this share of the longest count as zero; so does what is left of a row of unit
  /// length, after the part that the other rows span is taken off, when it is shorter than this.
  double rank_tolerance = 1e-9;
};

/// Operational-space inertia Λ = (J M⁻¹ Jᵀ)⁻¹ (Khatib 1987) of the rows J, also when they depend on each other.
///
/// With M = L Lᵀ and A = J L⁻ᵀ, J M⁻¹ Jᵀ = A Aᵀ.  Its rank is found from A, never from the Gram matrix, whose
/// condition is that of A squared: the rows are brought to unit length, A = D Â, and Âᵀ is factored by Householder
/// reflections with column pivoting.  Then Λ = D⁻¹ (Â Âᵀ)⁺ D⁻¹, the inverse when the rows are independent, and a
/// generalised inverse (G Λ G = G, Λ G Λ = Λ) when they are not; Jᵀ Λ J is the same for every choice of units.
/// Takes no memory after construction.
class OperationalSpace {
 public:
  OperationalSpace(int max_rows, int dof);

  /// `mass_factor` is L.  J has at most max_rows rows.
  void compute(const Eigen::Ref<const Eigen::MatrixXd>& J, const Eigen::MatrixXd& mass_factor,
               const OperationalSpaceOptions& options = {});

  int rank() const { return rank_; }
  auto inertia() const { return inertia_.topLeftCorner(rows_, rows_); }      ///< Λ, rows × rows

 private:
  int dof_, rows_ = 0, rank_ = 0;
  Eigen::MatrixXd transposed_;                                     // Âᵀ, then R of Âᵀ P = Q R
  Eigen::MatrixXd trapezoid_;                                      // Rᵀ, then T of Rᵀ = Q₂ T
  Eigen::MatrixXd inverse_;                                        // (Â⁺)ᵀ = P Q₂ T⁻ᵀ
  Eigen::MatrixXd inertia_;
  Eigen::VectorXd lengths_, reflection_, scratch_;
  std::vector<int> order_;                                         // P
};

}  // namespace tactus::dynamics
