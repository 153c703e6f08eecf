#pragma once

#include <Eigen/Core>
#include <vector>

namespace tactus::exploration {

/// Squared exponential covariance with an isotropic length scale (Rasmussen and Williams 2006, 4.9, 2.31):
/// k(p, q) = σ_f² exp(−‖p − q‖² / 2ℓ²), and independent noise of variance σ_n² on what is observed.
struct Covariance {
  double length = 0.05;                                            ///< ℓ, m
  double deviation = 1;                                            ///< σ_f
  double noise = 0.02;                                             ///< σ_n
};

/// Regression over R³ by a Gaussian process with a constant prior mean m (Rasmussen and Williams 2006, 2.25, 2.26, 2.38):
///
///   mean      f̄(p) = m + k(p)ᵀ (K + σ_n² I)⁻¹ (y − m)
///   variance  V(p) = k(p, p) − k(p)ᵀ (K + σ_n² I)⁻¹ k(p)
///
/// by the Cholesky factor K + σ_n² I = L Lᵀ, to which every observation adds a row, O(n²).  Takes no memory after
/// construction; a full process refuses more.
class GaussianProcess {
 public:
  GaussianProcess(const Covariance& covariance, double prior_mean, int capacity);

  /// False when it is full, or the observation adds nothing that rounding leaves.
  bool observe(const Eigen::Vector3d& p, double y);
  int size() const { return count_; }
  int capacity() const { return static_cast<int>(points_.cols()); }
  const Covariance& covariance() const { return covariance_; }

  double mean(const Eigen::Vector3d& p) const;
  /// Mean and its gradient.
  double mean(const Eigen::Vector3d& p, Eigen::Vector3d& gradient) const;
  double variance(const Eigen::Vector3d& p);

  template <class Archive>
  void archive(Archive& archive) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < count_; ++i) points.push_back(points_.col(i));
    std::vector<double> values(values_.data(), values_.data() + count_);
    archive.growing("points", points);
    archive.growing("values", values);
    clear();
    for (std::size_t i = 0; i < points.size() && i < values.size(); ++i) observe(points[i], values[i]);
  }
  void clear() { count_ = 0; }

 private:
  double kernel(const Eigen::Vector3d& p, int i) const;

  Covariance covariance_;
  double prior_mean_;
  int count_ = 0;
  Eigen::Matrix3Xd points_;
  Eigen::VectorXd values_;                                         // y
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> factor_;  // L
  Eigen::VectorXd forward_;                                        // L⁻¹ (y − m), grows with L
  Eigen::VectorXd weights_;                                        // L⁻ᵀ of it
  Eigen::VectorXd work_;
};

}  // namespace tactus::exploration
