#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "framework/control/registry.h"
#include "plugins/senses/encoders.h"
#include "plugins/senses/fault.h"
#include "plugins/senses/force_torque.h"
#include "plugins/senses/skin.h"

/// A finger of two capsules in a row that swing about y, and sensors on it without a stack.
namespace tactus::testing {

inline constexpr double kPeriod = 0.001;                           // s, of the control

inline description::Robot finger() {
  description::Robot robot;
  robot.name = "finger";
  const auto addLink = [&robot](const char* name) -> description::Link& {
    robot.links.push_back({});
    robot.links.back().name = name;
    return robot.links.back();
  };
  addLink("base");
  for (const char* name : {"near", "far"}) {
    description::Link& link = addLink(name);
    link.has_inertial = true;
    link.mass = 0.1;
    link.centre_of_mass = {0.05, 0, 0};
    link.inertia = 1e-4 * Eigen::Matrix3d::Identity();
    link.shapes = {description::CapsuleShape{{0, 0, 0}, {0.1, 0, 0}, 0.01}};
    description::Joint joint;
    joint.name = name;
    joint.type = description::JointType::revolute;
    joint.axis = Eigen::Vector3d::UnitY();
    joint.child = static_cast<int>(robot.links.size()) - 1;
    joint.parent = joint.child - 1;
    if (joint.parent > 0) joint.origin = Eigen::Translation3d(0.12, 0, 0);
    robot.joints.push_back(joint);
  }
  return robot;
}

/// One sensor, and what it makes of what there is.
class SensorOnFinger {
 public:
  SensorOnFinger(const std::string& element, const std::map<std::string, std::string>& attributes,
                 std::uint64_t seed = 1, std::vector<control::ReadingRow> before = {},
                 description::Robot robot = finger())
      : robot_(std::move(robot)), model_(robot_) {
    plugins::Skin::registerIn(registry_);
    plugins::ForceTorque::registerIn(registry_);
    plugins::Encoders::registerIn(registry_);
    plugins::Fault::registerIn(registry_);
    values_ = control::makeValues(*registry_.elements().find(element), withName(attributes));
    for (const control::ReadingRow& row : before) first_ += row.count;
    const control::BuildContext context(values_, robot_, model_, kPeriod, {});
    sensor_ = registry_.makeSensor(control::SensorContext(context, scene_, seed, before));
    for (const control::PortRow& port : values_.ports()) count_ += sensor_->count(port);
    truth.q.setZero(2);
    truth.qd.setZero(2);
    told = truth;
    told.contacts.reserve(1024);
    told.readings.setZero(first_ + count_);
    given.setZero(first_);
  }

  control::Sensed truth;                                           ///< what there is
  std::vector<control::ContactRecord> felt_before;                 ///< contacts that other sensors told
  Eigen::VectorXd felt_q;                                          ///< joints that others told; empty = the true ones
  Eigen::VectorXd given;                                           ///< readings of the sensors before it
  control::Sensed told;                                            ///< what is felt

  /// Feels, and lets a period pass.
  void tick() {
    told.time = truth.time;
    told.q = felt_q.size() ? felt_q : truth.q;
    told.qd = truth.qd;
    told.contacts = truth.contacts;
    told.contacts.insert(told.contacts.end(), felt_before.begin(), felt_before.end());
    told.readings.head(first_) = given;
    sensor_->sense(truth, told, told.readings.segment(first_, count_));
    truth.time = ++ticks_ * kPeriod;
  }
  Eigen::VectorXd readings() const { return told.readings.segment(first_, count_); }
  const control::Sensor& sensor() const { return *sensor_; }
  Eigen::Isometry3d pose(int link, const Eigen::VectorXd& q) const {
    dynamics::Workspace workspace(model_);
    dynamics::forwardKinematics(model_, q, workspace);
    return dynamics::framePose(model_, workspace, link);
  }

 private:
  static std::map<std::string, std::string> withName(std::map<std::string, std::string> attributes) {
    attributes["name"] = "it";
    return attributes;
  }

  control::Registry registry_;
  description::Robot robot_;
  dynamics::Model model_;
  description::Scene scene_;
  control::ElementValues values_;
  std::unique_ptr<control::Sensor> sensor_;
  int first_ = 0, count_ = 0;
  long ticks_ = 0;
};

}  // namespace tactus::testing
