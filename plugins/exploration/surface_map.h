#pragma once

#include <array>
#include <vector>

#include "framework/control/registry.h"
#include "plugins/exploration/gaussian_process.h"

namespace tactus::exploration {

/// The signal `surface-map`: what is known of a surface from touched points, and the place that is known least.
///
/// The surface is where a Gaussian process is 0 (implicit surface: Williams and Fitzgibbon 2007; by touch: Dragiev,
/// Toussaint and Gienger 2011).  Each touched point that is `spacing` away from all others so far, of at most `capacity`,
/// brings two observations: 0 where it touched, and −1 at the depth `depth` behind it, along the contact normal.  The
/// prior mean is 1, outside.
///
/// Places are looked for around what is known: `step` away from each point in eight directions of its tangent plane,
/// brought onto the surface that the mean tells by Newton's method along its gradient.  A place counts when it lies
/// within the box `within` and its outward normal is no more than `facing-angle` from `facing`, which together say where
/// the hand can go.  A place is known when s is below `known` and, with `met-within`, a touched point is as near as that:
/// between lines of touches the process knows the surface long before a finger has been everywhere.  The best place has the greatest s − w d: s its standard deviation over the prior one, d its
/// distance from the middle of the contacts, w `nearness`.
///
/// `next` is that place, as a goal for `frame`: it is shifted so that the middle of the contacts, not the frame, gets
/// there.  With `heading` = outwards it also has a heading, from the middle of what is known to the place, across `facing`:
/// so a hand puts its fingers over each side of a thing in turn; the shift is turned with it.  A place that is nearer to that
/// middle than half a `step` leaves the heading as it was.  It is left for the next one when it becomes known (reached), or when `patience` passes without the
/// middle of the contacts coming `progress` nearer (given up: within `clearance` of it no other is chosen for a while).
///
/// Work is spread: every `every`-th tick adds one observation, O(n²), or looks at one place.  Takes no memory after
/// construction.
class SurfaceMap final : public control::Signal {
 public:
  explicit SurfaceMap(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  void columns(std::vector<control::LogColumn>& columns) const override;
  void metrics(std::vector<control::Metric>& metrics) const override;

  const GaussianProcess& process() const { return process_; }

 private:
  struct Candidate {
    bool found = false;
    double score = -1e9;
    double uncertainty = 0;                                        ///< s
    Eigen::Vector3d point_W = Eigen::Vector3d::Zero();
    void archive(control::Archive& archive);
  };

  void doUpdate(const control::Tick& tick) override;
  const void* doPort(std::string_view name) const override;
  void doArchive(control::Archive& archive) override;

  bool learn();
  void look();
  bool placeAround(int point, int direction, Eigen::Vector3d& place_W) const;
  void choose();
  void followGoal(double time);
  void leaveGoal(bool reached, double time);
  void headOutwards();
  Eigen::Matrix3d turnTo(const Eigen::Vector3d& forward_W) const;
  double uncertaintyAt(const Eigen::Vector3d& p_W);
  void meet(const Eigen::Vector3d& p_W);
  bool isMet(const Eigen::Vector3d& p_W) const;

  const control::TouchedPoints& touched_;
  const control::ContactSet& contacts_;
  int frame_;
  double spacing_, depth_, step_, facing_cosine_, known_, nearness_, patience_, progress_;
  int every_;
  double clearance_;
  bool outwards_;
  std::array<Eigen::Vector3d, 2> box_W_;
  Eigen::Vector3d facing_W_, first_W_, forward_F_;
  int capacity_;

  GaussianProcess process_;
  std::vector<Eigen::Vector3d> points_W_, normals_W_;              ///< kept; normals out of the object
  std::size_t read_ = 0;                                           ///< touched points that were looked at
  double met_within_ = 0;                                          ///< m; 0: nobody asks
  std::vector<Eigen::Vector3d> met_W_;                             ///< touched points, half of that apart
  bool owes_depth_ = false;                                        ///< the last point's second observation is due
  int tick_ = 0, looked_ = 0;                                      ///< places of this round
  Candidate best_;                                                 ///< of this round
  Eigen::Vector3d middle_W_ = Eigen::Vector3d::Zero();             ///< of the contacts, when there were some last
  bool has_middle_ = false;
  Eigen::Vector3d goal_W_ = Eigen::Vector3d::Zero();
  bool has_goal_ = false;
  Eigen::Vector3d heading_W_ = Eigen::Vector3d::Zero();            ///< towards the goal; zero: none yet
  double nearest_ = 0, progress_time_ = 0, goal_time_ = -1, goal_uncertainty_ = 0;
  bool goal_met_ = false;
  std::array<Eigen::Vector3d, 16> left_W_;                         ///< given up, a ring
  int left_next_ = 0;
  control::Place next_;
  double n_points_ = 0, most_uncertain_ = 1, reached_ = 0, given_up_ = 0;
  double given_up_s_ = 0;                                          ///< spent on places that were given up
};

}  // namespace tactus::exploration
