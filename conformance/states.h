#pragma once

#include <random>

#include "conformance/bench.h"

namespace tactus::conformance {

/// Ticks of one stretch of steady motion.
inline constexpr int kStretch = 20;

/// The stack as it stands where the whole world is moved by X: the robot's base and every value in world axes.  What
/// hangs at no joint of the base, the root link itself, stays.
dsl::Stack movedStack(const dsl::Stack& stack, const Eigen::Isometry3d& X);

/// Random states of a robot near the stack's start, with contacts.  The same seed draws the same states, `moved` with
/// the world.  Every `kStretch` ticks joints jump elsewhere and other links touch; in between all joints move steadily
/// and the contacts with their links.
class States {
 public:
  States(const dsl::Stack& stack, unsigned seed, const Eigen::Isometry3d& moved = Eigen::Isometry3d::Identity());

  /// Puts the next state into bench.sensed; the time is the bench's.
  void next(Bench& bench);
  /// The contacts of this stretch, on their links as they stand in state q.
  void touch(Bench& bench) const;

 private:
  struct Touch {
    int link;
    Eigen::Vector3d point_L, normal_W;
    double force_N;
  };
  double uniform(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(random_); }
  void jump(const Bench& bench);

  Eigen::VectorXd start_, q_, qd_;
  std::vector<int> skin_;
  std::vector<Touch> touches_;
  Eigen::Isometry3d moved_;
  std::mt19937 random_;
  int ticks_ = 0;
};

}  // namespace tactus::conformance
