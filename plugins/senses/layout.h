#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/control/element_values.h"
#include "plugins/senses/surface.h"

namespace tactus::plugins {

/// A taxel and what of the surface presses on it.
struct Taxel : SurfacePoint {
  std::vector<int> cells = {};                                     ///< indices into TaxelPlan::cells
};

/// The taxels of one link.
struct TaxelPlan {
  std::vector<SurfaceCell> cells;                                  ///< of the whole surface, covered or not
  std::vector<Taxel> taxels;
  double pitch = 0;                                                ///< m, about from taxel to taxel
};

/// Where taxels lie, the same each time.
///
/// | layout           | taxels                                                       | each collects              |
/// |------------------|--------------------------------------------------------------|----------------------------|
/// | `tekscan`        | the pieces of `Surface::cells(pitch)`, 4 mm                  | its piece                  |
/// | `counts`         | rows along the straight part, columns around it              | what is nearest to it      |
/// | `positions`      | given ones, put on the surface                               | what is within pitch/2     |
/// | `icub-fingertip` | 12 on the round end far from the link's origin               | what is nearest to it      |
/// | `six-node`       | 6 on the links, in a row along their `facing` side           | 9 mm along, 5 mm across    |
///
/// `facing` and `arc` leave the parts of the first two whose normal is within `arc` of `facing`; columns of `counts`
/// spread over these 2 arc.  The 12 are a Fibonacci lattice of the half sphere: taxel i at cos θ = 1 − (i + ½)/12 from
/// the pole, φ = i π (3 − √5).  Six nodes share the links in their order, as many on each, at equal distances on the
/// straight part (thesis, figure 3.11: six patches from the first phalanx to the fingertip).
class Layout {
 public:
  /// Throws ElementError.
  Layout(const control::ElementValues& values, int links);

  /// Throws ElementError where the link has no such place.
  TaxelPlan plan(const description::Link& link) const;

  /// What a layout says of its electronics where the stack does not: 0 = no such limit.
  struct Electronics {
    double range_N = 0;
    int levels = 0;
    double rate_Hz = 0;
    bool counts = false;                                           ///< values are told in counts
  };
  Electronics electronics() const;

 private:
  enum class Kind { tekscan, counts, positions, fingertip, six_node };

  bool faces(const Eigen::Vector3d& normal_L) const;
  const description::CapsuleShape& capsuleOf(const description::Link& link) const;
  void addGrid(const Surface& surface, TaxelPlan& plan) const;
  void addCounts(const description::Link& link, TaxelPlan& plan) const;
  void addPositions(const Surface& surface, TaxelPlan& plan) const;
  void addFingertip(const description::Link& link, TaxelPlan& plan) const;
  void addNodes(const description::Link& link, TaxelPlan& plan) const;
  bool collects(const Taxel& taxel, const SurfaceCell& cell, const description::Link& link) const;
  void assignCells(const description::Link& link, TaxelPlan& plan) const;

  Kind kind_;
  int links_;
  double pitch_;
  int rows_ = 0, columns_ = 0;
  std::vector<Eigen::Vector3d> positions_;
  std::optional<Eigen::Vector3d> facing_;                          // unit
  double arc_;
};

}  // namespace tactus::plugins
