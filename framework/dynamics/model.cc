#include "framework/dynamics/model.h"

#include <algorithm>

#include "framework/dynamics/check_robot.h"

namespace tactus::dynamics {
namespace {

using description::JointType;

RigidBodyInertia linkInertia(const description::Link& link) {
  if (!link.has_inertial) return {};
  return RigidBodyInertia::aboutCentreOfMass(link.mass, link.centre_of_mass, link.inertia);
}

/// The thin disk of description::Joint::reflectedInertia: pure inertia, the same about every point.
RigidBodyInertia rotorInertia(const description::Joint& joint, const Eigen::Vector3d& axis) {
  RigidBodyInertia disk;
  disk.rotational =
      0.5 * joint.reflectedInertia() * (Eigen::Matrix3d::Identity() + axis * axis.transpose());
  return disk;
}

Eigen::Isometry3d turned(const Eigen::Matrix3d& R) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = R;
  return X;
}

/// One step of the chain of bodies that makes a joint: `frame` is that of the body in the joint frame at q = 0.
struct Step {
  Motion motion;
  Eigen::Isometry3d frame;
};

std::vector<Step> steps(const description::Joint& joint) {
  const auto along = [](Motion motion, const Eigen::Vector3d& axis) {
    return Step{motion, turned(description::planeFrame(axis))};
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  const Eigen::Isometry3d same = Eigen::Isometry3d::Identity();
  const std::vector<Step> ball{{Motion::ball_x, same}, {Motion::ball_y, same}, {Motion::ball_z, same}};
  switch (joint.type) {
    case JointType::fixed: return {};
    case JointType::revolute: return {along(Motion::rotation, joint.axis.normalized())};
    case JointType::prismatic: return {along(Motion::translation, joint.axis.normalized())};
    case JointType::planar: {
      const Eigen::Matrix3d plane = description::planeFrame(joint.axis.normalized());
      return {along(Motion::translation, plane.col(0)), along(Motion::translation, plane.col(1)),
              along(Motion::rotation, plane.col(2))};
    }
    case JointType::spherical: return ball;
    case JointType::floating:
      return {along(Motion::translation, x), along(Motion::translation, y), along(Motion::translation, z), ball[0],
              ball[1], ball[2]};
  }
  return {};
}

void append(Eigen::VectorXd& values, Eigen::Index count, double value) {
  values.conservativeResize(values.size() + count);
  values.tail(count).setConstant(value);
}

}  // namespace

Model::Model(const description::Robot& robot, MassPolicy policy) {
  const std::vector<int> joint_order = checkStructure(robot);
  checkNumbers(robot);
  const std::vector<Drive> drives = resolveMimics(robot);

  frames_.resize(robot.links.size());
  for (size_t i = 0; i < robot.links.size(); ++i) frames_[i].name = robot.links[i].name;

  // Coordinates first: a driven joint may stand before its driver.
  std::vector<int> index_of(robot.joints.size(), -1);              // into joints_
  for (const int j : joint_order) {
    const description::Joint& joint = robot.joints[j];
    if (joint.type == JointType::fixed) continue;
    index_of[j] = static_cast<int>(joints_.size());
    joints_.push_back({.name = joint.name, .type = joint.type});
    if (!joint.mimic) addCoordinates(joint);
  }
  for (const int j : joint_order) {
    if (!robot.joints[j].mimic) continue;
    Joint& driven = joints_[index_of[j]];
    driven.driver = index_of[drives[j].driver];
    const Joint& driver = joints_[driven.driver];
    driven.position = driver.position;
    driven.coordinate = driver.coordinate;
    addDriven(robot.joints[j], driven.coordinate, drives[j]);
  }

  std::vector<int> carrier_links;                                  // of each body: the link that its joint carries
  for (const int j : joint_order) {
    const description::Joint& joint = robot.joints[j];
    Frame& child = frames_[joint.child];
    const Frame& parent = frames_[joint.parent];
    child.body = parent.body;
    child.pose = parent.pose * joint.origin;
    if (joint.type != JointType::fixed) {
      Joint& added = joints_[index_of[j]];
      added.first_body = bodyCount();
      added.body_count = description::velocityCount(joint.type);
      addBodies(joint, drives[j], added, child);
      carrier_links.resize(bodies_.size(), joint.child);
    }
    if (child.body >= 0) bodies_[child.body].inertia += linkInertia(robot.links[joint.child]).transformed(child.pose);
  }
  finishBodies();
  if (policy == MassPolicy::required) {
    for (const Joint& joint : joints_) {
      const int last = joint.first_body + joint.body_count - 1;
      checkBodyInertia(bodies_[last].inertia, robot.links[carrier_links[last]]);
    }
  }
}

void Model::addCoordinates(const description::Joint& joint) {
  Joint& added = joints_.back();
  added.position = positionCount();
  added.position_count = description::positionCount(joint.type);
  added.coordinate = dof();
  added.coordinate_count = description::velocityCount(joint.type);
  for (std::string& name : dynamics::positionNames(joint)) position_names_.push_back(std::move(name));
  for (std::string& name : dynamics::coordinateNames(joint)) coordinate_names_.push_back(std::move(name));
  const bool limited = added.coordinate_count == 1;
  append(lower_, added.coordinate_count, limited ? joint.lower : -description::infinity);
  append(upper_, added.coordinate_count, limited ? joint.upper : description::infinity);
  append(effort_, added.coordinate_count, joint.effort);
  append(velocity_, added.coordinate_count, joint.velocity);
  append(damping_, added.coordinate_count, joint.damping);
  append(friction_, added.coordinate_count, joint.friction);
}

// The joint's angle is ratio · q + offset: its limits, damping and friction are the coordinate's too.
void Model::addDriven(const description::Joint& joint, int coordinate, const Drive& drive) {
  const double a = std::abs(drive.ratio);
  damping_[coordinate] += drive.ratio * drive.ratio * joint.damping;
  friction_[coordinate] += a * joint.friction;
  if (a == 0) return;
  const double at_lower = (joint.lower - drive.offset) / drive.ratio;
  const double at_upper = (joint.upper - drive.offset) / drive.ratio;
  lower_[coordinate] = std::max(lower_[coordinate], std::min(at_lower, at_upper));
  upper_[coordinate] = std::min(upper_[coordinate], std::max(at_lower, at_upper));
  velocity_[coordinate] = std::min(velocity_[coordinate], joint.velocity / a);
}

// `child` comes as the joint frame in the parent body, and leaves as the link in the joint's last body.
void Model::addBodies(const description::Joint& joint, const Drive& drive, const Joint& added, Frame& child) {
  const int parent = child.body;
  Eigen::Isometry3d joint_in_body = child.pose;
  int count = 0;
  for (const Step& step : steps(joint)) {
    const bool is_ball = step.motion != Motion::rotation && step.motion != Motion::translation;
    Body body;
    body.parent = count == 0 ? parent : bodyCount() - 1;
    body.carrier = is_ball && step.motion != Motion::ball_x ? bodies_.back().carrier : body.parent;
    body.motion = step.motion;
    body.coordinate = added.coordinate + count;
    body.position = step.motion == Motion::ball_y || step.motion == Motion::ball_z ? bodies_.back().position
                                                                                   : added.position + count;
    body.ratio = drive.ratio;
    body.offset = drive.offset;
    body.origin = joint_in_body * step.frame;
    joint_in_body = step.frame.inverse();
    bodies_.push_back(body);
    parents_.push_back(body.parent);
    ++count;
  }
  child.body = bodyCount() - 1;
  child.pose = joint_in_body;
  bodies_.back().inertia = rotorInertia(joint, joint.axis.normalized()).transformed(child.pose);
}

void Model::finishBodies() {
  for (Body& body : bodies_) {
    body.unturned = body.origin.linear() == Eigen::Matrix3d::Identity();
    body.massless = body.inertia.mass == 0 && body.inertia.rotational.isZero(0);
    body.centre_of_mass = body.inertia.centreOfMass();
    body.central_inertia = body.inertia.inertiaAboutCentreOfMass();
  }
  subtree_ends_.resize(bodies_.size());
  for (int i = 0; i < bodyCount(); ++i) {
    subtree_ends_[i] = i + 1;
    for (int ancestor = parents_[i]; ancestor >= 0; ancestor = parents_[ancestor]) subtree_ends_[ancestor] = i + 1;
  }
}

int Model::frameIndex(std::string_view link) const {
  const auto found = std::ranges::find(frames_, link, &Frame::name);
  return found == frames_.end() ? -1 : static_cast<int>(found - frames_.begin());
}

int Model::jointIndex(std::string_view coordinate) const {
  const auto found = std::ranges::find(coordinate_names_, coordinate);
  return found == coordinate_names_.end() ? -1 : static_cast<int>(found - coordinate_names_.begin());
}

Eigen::VectorXd Model::neutral() const {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(positionCount());
  for (const Body& body : bodies_)
    if (body.motion == Motion::ball_x) q[body.position] = 1;
  return q;
}

bool Model::supports(int coordinate, int frame) const {
  for (int body = frames_[frame].body; body >= 0; body = parents_[body])
    if (bodies_[body].coordinate == coordinate) return true;
  return false;
}

}  // namespace tactus::dynamics
