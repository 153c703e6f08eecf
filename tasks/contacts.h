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
/// One contact a link reaches the tasks, or up to `per-link`: its point and normal are the force-weighted means of its
/// records, its force their sum.  A contact comes when the force stays above `on-force` for `hold`, and goes
/// when the force stays below `off-force` for `hold`; while it lingers, it moves with the link.
/// So a contact comes and goes at most once in two `hold`, and one that flickers faster than `hold` stays as it is.
/// Links without skin feel nothing.
///
/// With `per-link` above 1 a record belongs to the link's nearest contact that is not farther than `apart` from it,
/// as it was last felt on the link; else it begins a new one; where there is no place for that, it belongs to the nearest.
class Contacts final : public control::Signal {
 public:
  explicit Contacts(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  void columns(std::vector<control::LogColumn>& columns) const override;

 private:
  struct Touch {
    bool on = false;
    double pending_since = -1;                                     ///< s; start of a change that must hold, -1 = none
    double force_N = 0;                                            ///< this tick, all its records
    Eigen::Vector3d point_W, normal_W;                             ///< this tick's mean
    Eigen::Vector3d point_L = Eigen::Vector3d::Zero(), normal_L = Eigen::Vector3d::Zero();  ///< last felt, link frame
    bool isTaken() const { return on || pending_since >= 0 || force_N > 0; }
    void archive(control::Archive& archive);
  };
  struct LinkTouch {
    bool feels = false;
    bool desired = false;
    int slot = -1;                                                 ///< among the desired links
    std::vector<Touch> touches;                                    ///< per_link of them
    Eigen::Vector3d centre_L;                                      ///< the desired point: the middle of the link's shapes
    std::vector<Eigen::Vector3d> recent;                           ///< last touched points, a ring
    int recent_next = 0;
    void archive(control::Archive& archive);
  };

  void doUpdate(const control::Tick& tick) override;
  const void* doPort(std::string_view name) const override;
  void doArchive(control::Archive& archive) override;
  void accumulateRecords(const control::Tick& tick);
  Touch& touchOf(LinkTouch& link, const Eigen::Vector3d& point_L) const;
  void average(Touch& touch, const Eigen::Isometry3d& X_WL) const;
  void applyHysteresis(Touch& touch, double time) const;
  void rememberPoint(LinkTouch& link, int frame, const control::ContactRecord& record, double time);
  void publish(const control::Tick& tick);

  double on_force_, off_force_, hold_, spacing_, apart_;
  std::vector<LinkTouch> links_;                                   ///< by frame index
  control::ContactSet held_, undesired_, all_;
  control::MissingSet missing_;
  control::TouchedPoints points_;
  control::FrameSet desired_;
  double n_held_ = 0, n_undesired_ = 0, n_points_ = 0, n_self_ = 0, n_touching_ = 0;
};

}  // namespace tactus::tasks
