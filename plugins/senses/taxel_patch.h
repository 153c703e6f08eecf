#pragma once

#include <Eigen/Core>
#include <vector>

#include "plugins/senses/layout.h"

namespace tactus::plugins {

/// A contact as taxels tell it, link axes.
struct TaxelContact {
  SurfacePoint place;                                              ///< the normal points out of the link
  double force_N = 0;
};

/// The taxels of one link: what a contact does to them, and what contacts are read out of them.
///
/// **Pressing.**  A contact of force F and depth δ on a link whose radius there is R presses around its place s on the
/// surface.  Hertz's patch of a ball on a plane has the radius a = √(Rδ) and the pressure ∝ √(1 − ρ²/a²), of variance
/// a²/5 along each axis (Johnson, Contact Mechanics, 1985, 4.2); the cover above the taxels spreads it by `spread`.
/// Their convolution is taken as a Gaussian of the same variance,
///
///   σ² = spread² + a²/5,   f_c = F w_c / Σ w,   w_c = A_c exp(−(d_c² − d_min²)/2σ²),   0 where d_c² − d_min² > (3σ)²,
///
/// over all cells c of the link's surface that do not face away from s, covered by taxels or not, with the area A_c and
/// the distance d_c from s.  A taxel feels the sum of its cells: all taxels together feel F where all of the footprint
/// is covered, and the covered share of it at the edge of a patch.
///
/// **Reading.**  Taxels of one link are neighbours when they are no farther apart than `adjacency` times the pitch.
/// Active ones, above 0, that hang together by neighbours are one contact: its force is their sum, its place the
/// nearest on the surface to their centre weighted by force, its normal that of the surface there (thesis 4.4.2,
/// experiment 4, with clusters instead of the whole link).  Clusters of fewer than `min_taxels`, or weaker than
/// `min_force`, are none.  They come in the order of their first taxels.  So two contacts are told apart when taxels
/// between them are silent: surely, on a grid, from 6σ + (adjacency + 1.6)·pitch on, which is twice the footprint, half
/// a taxel on either side, and a gap.
///
/// Takes no memory after construction.
class TaxelPatch {
 public:
  TaxelPatch(const description::Link& link, TaxelPlan plan, double spread, double adjacency);

  int count() const { return static_cast<int>(taxels_.size()); }
  const std::vector<Taxel>& taxels() const { return taxels_; }
  double pitch() const { return pitch_; }

  /// Adds what a contact does to the taxels (N).  The place need not lie exactly on the surface.
  void press(const Eigen::Vector3d& point_L, double force_N, double depth, Eigen::Ref<Eigen::VectorXd> forces_N);
  /// Adds the contacts that the taxels' forces (N) tell; `contacts` has room for one a taxel.
  void read(Eigen::Ref<const Eigen::VectorXd> forces_N, int min_taxels, double min_force,
            std::vector<TaxelContact>& contacts);

 private:
  Surface surface_;
  std::vector<Taxel> taxels_;
  double pitch_, spread_;
  Eigen::ArrayX3d cells_, cell_normals_;                           // one row a cell
  Eigen::ArrayXd areas_;
  std::vector<int> owners_;                                        // by cell: its taxel, −1 = none
  std::vector<int> neighbours_, first_neighbour_;                  // of taxel i: from first_neighbour_[i] up to [i + 1]
  Eigen::ArrayXd distances_;                                       // squared, by cell
  struct Pressed {
    int taxel;
    double weight;
  };
  std::vector<Pressed> pressed_;                                   // cells within the footprint
  std::vector<int> pending_;
  std::vector<char> seen_;                                         // by taxel
};

}  // namespace tactus::plugins
