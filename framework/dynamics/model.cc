#include "framework/dynamics/model.h"

#include <algorithm>

#include "framework/dynamics/check_robot.h"

namespace tactus::dynamics {
namespace {

using description::JointType;

/// A right-handed frame whose z axis is `axis`; without rounding when that is a coordinate axis.
Eigen::Isometry3d frameWithZ(const Eigen::Vector3d& axis) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  if (axis == Eigen::Vector3d::UnitZ()) return frame;
  int smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  const Eigen::Vector3d other = Eigen::Vector3d::Unit(smallest);
  const Eigen::Vector3d x = (other - axis * axis.dot(other)).normalized();
  frame.linear() << x, axis.cross(x), axis;
  return frame;
}

RigidBodyInertia linkInertia(const description::Link& link) {
  if (!link.has_inertial) return {};
  return RigidBodyInertia::aboutCentreOfMass(link.mass, link.centre_of_mass, link.inertia);
}

/// The thin disk of description::Joint::rotor_inertia: pure inertia, the same about every point.
RigidBodyInertia rotorInertia(const description::Joint& joint, const Eigen::Vector3d& axis) {
  RigidBodyInertia disk;
  disk.rotational = 0.5 * joint.rotor_inertia * (Eigen::Matrix3d::Identity() + axis * axis.transpose());
  return disk;
}

}  // namespace

Model::Model(const description::Robot& robot, MassPolicy policy) {
  const std::vector<int> joint_order = checkStructure(robot);
  checkNumbers(robot);

  frames_.resize(robot.links.size());
  for (size_t i = 0; i < robot.links.size(); ++i) frames_[i].name = robot.links[i].name;
  std::vector<int> carrier_links;                                  // of each body: the link that its joint carries
  std::vector<double> lower, upper, effort, velocity;

  for (const int j : joint_order) {
    const description::Joint& joint = robot.joints[j];
    const Frame& parent = frames_[joint.parent];
    Frame& child = frames_[joint.child];
    if (joint.type == JointType::fixed) {
      child.body = parent.body;
      child.pose = parent.pose * joint.origin;
    } else {
      const Eigen::Vector3d axis = joint.axis.normalized();
      const Eigen::Isometry3d aligned = frameWithZ(axis);
      Body body;
      body.parent = parent.body;
      body.type = joint.type;
      body.origin = parent.pose * joint.origin * aligned;
      child.body = dof();
      child.pose = aligned.inverse();
      body.inertia = rotorInertia(joint, axis).transformed(child.pose);
      bodies_.push_back(body);
      joint_names_.push_back(joint.name);
      parents_.push_back(body.parent);
      carrier_links.push_back(joint.child);
      lower.push_back(joint.lower);
      upper.push_back(joint.upper);
      effort.push_back(joint.effort);
      velocity.push_back(joint.velocity);
    }
    if (child.body >= 0) {
      bodies_[child.body].inertia += linkInertia(robot.links[joint.child]).transformed(child.pose);
    }
  }

  for (Body& body : bodies_) {
    body.centre_of_mass = body.inertia.centreOfMass();
    body.central_inertia = body.inertia.inertiaAboutCentreOfMass();
  }
  subtree_ends_.resize(bodies_.size());
  for (int i = 0; i < dof(); ++i) {
    subtree_ends_[i] = i + 1;
    for (int ancestor = parents_[i]; ancestor >= 0; ancestor = parents_[ancestor]) subtree_ends_[ancestor] = i + 1;
  }
  if (policy == MassPolicy::required) {
    for (int i = 0; i < dof(); ++i) checkBodyInertia(bodies_[i].inertia, robot.links[carrier_links[i]]);
  }
  const auto toVector = [](const std::vector<double>& values) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<int>(values.size())));
  };
  lower_ = toVector(lower);
  upper_ = toVector(upper);
  effort_ = toVector(effort);
  velocity_ = toVector(velocity);
}

int Model::frameIndex(std::string_view link) const {
  const auto found = std::ranges::find(frames_, link, &Frame::name);
  return found == frames_.end() ? -1 : static_cast<int>(found - frames_.begin());
}

int Model::jointIndex(std::string_view joint) const {
  const auto found = std::ranges::find(joint_names_, joint);
  return found == joint_names_.end() ? -1 : static_cast<int>(found - joint_names_.begin());
}

bool Model::supports(int joint, int frame) const {
  const int body = frames_[frame].body;
  return joint <= body && body < subtree_ends_[joint];
}

}  // namespace tactus::dynamics
