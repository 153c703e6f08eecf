#pragma once

#include "framework/control/registry.h"

namespace wrist {

/// What the world does to all that hangs at a link; about the link's origin, world axes.
struct Wrench {
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();               ///< N
  Eigen::Vector3d moment_W = Eigen::Vector3d::Zero();              ///< N m
};

/// `<wrist.wrench>`: a force–torque sensor at a link, made of the contacts of the skin beyond it.
///
/// With the contact forces f_i that the robot exerts at p_i (along the normal and tangentially), and p the link's
/// origin,
///
///   force = −Σ f_i,   moment = −Σ (p_i − p) × f_i,
///
/// each through a first-order low-pass of time constant `filter`, as a real sensor's electronics has one.  A contact
/// counts when its link hangs at the sensor's link, itself included.  A sensor under a real hand feels the hand's
/// weight and inertia too, which a driver takes off; here nothing of that is in the contacts.
class WrenchSensor final : public tactus::control::Signal {
 public:
  explicit WrenchSensor(const tactus::control::BuildContext& context);
  static void registerIn(tactus::control::Registry& registry);

  void columns(std::vector<tactus::control::LogColumn>& columns) const override;

 private:
  void doUpdate(const tactus::control::Tick& tick) override;
  const void* doPort(std::string_view name) const override;
  void doArchive(tactus::control::Archive& archive) override;

  int frame_;
  double filter_;                                                  // s
  std::vector<char> beyond_;                                       // by link: hangs at the sensor
  Wrench wrench_;
  double force_N_ = 0;                                             // of the force
};

}  // namespace wrist

/// The port's type, by which a stack's references are checked; a plugin may bring its own.
template <>
struct tactus::control::PortType<wrist::Wrench> {
  static constexpr const char* name = "wrist.wrench";
};
