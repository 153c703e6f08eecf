#pragma once

#include <vector>

#include "framework/control/registry.h"

namespace tactus::tasks {

/// The signal `contacts`: what the skin feels, as the contact sets of the thesis (table 4.1).
///
/// C are the current contacts, D the desired links (attribute `desired`).  Ports:
/// `held` C∩D, `undesired` C\D, `missing` D\C, `all` C, `points` every point touched so far, `desired` D,
/// `touching` the size of `held`, `self` how often the robot touches itself: such touches are in no set, for they are
/// none of the world.
///
/// One contact a link reaches the tasks: its point and normal are the force-weighted means of the link's records,
/// its force their sum.  A link comes into contact when the force stays above `on-force` for `hold`, and leaves it
/// when the force stays below `off-force` for `hold`; while it lingers, the last contact moves with the link.
/// So a link comes and goes at most once in two `hold`, and one that flickers faster than `hold` stays as it is.
/// Links without skin feel nothing.
class Contacts final : public control::Signal {
 public:
  explicit Contacts(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  void columns(std::vector<control::LogColumn>& columns) const override;

 private:
  struct LinkTouch {
    bool feels = false;
    bool desired = false;
    int slot = -1;                                                 ///< among the desired links
    bool on = false;
    double pending_since = -1;                                     ///< s; start of a change that must hold, -1 = none
    double force_N = 0;                                            ///< this tick, all records
    Eigen::Vector3d point_W, normal_W;                             ///< this tick's mean
    Eigen::Vector3d point_L, normal_L;                             ///< last felt, in the link frame
    Eigen::Vector3d centre_L;                                      ///< the desired point: the middle of the link's shapes
    std::vector<Eigen::Vector3d> recent;                           ///< last touched points, a ring
    int recent_next = 0;
    void archive(control::Archive& archive);
  };

  void doUpdate(const control::Tick& tick) override;
  const void* doPort(std::string_view name) const override;
  void doArchive(control::Archive& archive) override;
  void accumulateRecords(const control::Tick& tick);
  void applyHysteresis(LinkTouch& link, double time) const;
  void rememberPoint(LinkTouch& link, int frame, const control::ContactRecord& record, double time);
  void publish(const control::Tick& tick);

  double on_force_, off_force_, hold_, spacing_;
  std::vector<LinkTouch> links_;                                   ///< by frame index
  control::ContactSet held_, undesired_, all_;
  control::MissingSet missing_;
  control::TouchedPoints points_;
  control::FrameSet desired_;
  double n_held_ = 0, n_undesired_ = 0, n_points_ = 0, n_self_ = 0;
};

}  // namespace tactus::tasks
