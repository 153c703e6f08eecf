#include "framework/dynamics/check_robot.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace tactus::dynamics {
namespace {

using description::Joint;
using description::JointType;
using description::Link;
using description::Robot;
using Severity = RobotFinding::Severity;

/// Principal moments may miss the triangle inequality by this share: they are often written with six digits.
constexpr double triangle_tolerance = 1e-6;
/// A smallest moment below this share of the greatest is rounding, not inertia.
constexpr double definite_tolerance = 1e-12;
constexpr double unit_tolerance = 1e-6;
/// What lies nearer to an axis than this lies on it (m).
constexpr double beside_axis = 1e-3;

std::string quoted(const std::string& name) { return "'" + name + "'"; }

std::string text(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

/// Three digits, for numbers that were computed and not written.
std::string rounded(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 3);
  return std::string(buffer, result.ptr);
}

std::string where(const description::Place& place) {
  return place.line > 0 ? " (line " + std::to_string(place.line) + ")" : "";
}

/// Gathers what is found, in the order in which Model looks.
class Report {
 public:
  void error(Fault fault, std::string message, const description::Place& place) {
    findings_.push_back({Severity::error, fault, std::move(message), place});
  }
  void warning(Fault fault, std::string message, const description::Place& place) {
    findings_.push_back({Severity::warning, fault, std::move(message), place});
  }
  bool hasErrors() const {
    return std::ranges::any_of(findings_, [](const RobotFinding& one) { return one.severity == Severity::error; });
  }
  void throwFirst() const {
    for (const RobotFinding& one : findings_)
      if (one.severity == Severity::error) throw ModelError(one.message, one.place);
  }
  std::vector<RobotFinding> take() { return std::move(findings_); }

 private:
  std::vector<RobotFinding> findings_;
};

template <class Named>
void findDoubles(const std::vector<Named>& all, const std::string& kind, Report& report) {
  std::map<std::string, const Named*> seen;
  for (const Named& one : all) {
    const auto [first, fresh] = seen.emplace(one.name, &one);
    if (fresh) continue;
    report.error(Fault::structure,
                 "two " + kind + "s are named " + quoted(one.name) + where(first->second->place) +
                     ": give one of them another name",
                 one.place);
  }
}

std::vector<std::string> coordinateSuffixes(JointType type) {
  switch (type) {
    case JointType::fixed: return {};
    case JointType::planar: return {".x", ".y", ".angle"};
    case JointType::spherical: return {".wx", ".wy", ".wz"};
    case JointType::floating: return {".x", ".y", ".z", ".wx", ".wy", ".wz"};
    default: return {""};
  }
}

std::vector<std::string> positionSuffixes(JointType type) {
  switch (type) {
    case JointType::spherical: return {".qw", ".qx", ".qy", ".qz"};
    case JointType::floating: return {".x", ".y", ".z", ".qw", ".qx", ".qy", ".qz"};
    default: return coordinateSuffixes(type);
  }
}

std::vector<std::string> withSuffixes(const std::string& name, std::vector<std::string> suffixes) {
  for (std::string& suffix : suffixes) suffix = name + suffix;
  return suffixes;
}

/// A joint of several degrees of freedom adds suffixes to its name, and another joint may be called so.
void findSharedCoordinates(const Robot& robot, Report& report) {
  std::map<std::string, const Joint*> owners;
  for (const Joint& joint : robot.joints) {
    if (joint.mimic) continue;
    std::vector<std::string> names = coordinateNames(joint);
    for (std::string& name : positionNames(joint)) names.push_back(std::move(name));
    for (const std::string& name : names) {
      const Joint& owner = *owners.emplace(name, &joint).first->second;
      if (owner.name == joint.name) continue;                      // its own, or told as a double
      report.error(Fault::structure,
                   "joints " + quoted(owner.name) + where(owner.place) + " and " + quoted(joint.name) +
                       " both have a coordinate " + quoted(name) + ": give one of them another name",
                   joint.place);
      break;
    }
  }
}

bool isRotation(const Eigen::Matrix3d& R) {
  return (R.transpose() * R).isIdentity(unit_tolerance) && R.determinant() > 0;
}

void examineLink(const Link& link, Report& report) {
  if (!link.has_inertial) return;
  const auto error = [&](const std::string& what) {
    report.error(Fault::number, "link " + quoted(link.name) + ": its " + what, link.place);
  };
  if (!std::isfinite(link.mass)) {
    error("mass is not a finite number");
  } else if (link.mass < 0) {
    error("mass is " + text(link.mass) + " kg; a mass cannot be negative");
  }
  if (!link.centre_of_mass.allFinite()) error("centre of mass is not made of finite numbers");
  if (!link.inertia.allFinite()) {
    error("inertia is not made of finite numbers");
  } else if (!link.inertia.isApprox(link.inertia.transpose(), unit_tolerance)) {
    error("inertia matrix is not symmetric");
  }
}

void examineJoint(const Joint& joint, Report& report) {
  const auto error = [&](const std::string& what) {
    report.error(Fault::number, "joint " + quoted(joint.name) + what, joint.place);
  };
  if (!joint.origin.matrix().allFinite()) {
    error(": its origin is not made of finite numbers");
  } else if (!isRotation(joint.origin.linear())) {
    error(": the orientation of its origin is not a rotation");
  }
  if (joint.type == JointType::fixed) return;
  const bool has_axis = joint.type != JointType::spherical && joint.type != JointType::floating;
  if (has_axis && (!joint.axis.allFinite() || std::abs(joint.axis.norm() - 1) > unit_tolerance))
    error(": its axis must have length 1, not " + text(joint.axis.norm()));
  if (std::isnan(joint.lower) || std::isnan(joint.upper)) {
    error(": its limits are not numbers");
  } else if (joint.lower > joint.upper) {
    error(": its lower limit " + text(joint.lower) + " lies above its upper limit " + text(joint.upper));
  }
  const auto notNegative = [&](double value, const char* what, bool may_be_infinite) {
    if (std::isnan(value) || value < 0 || (!may_be_infinite && std::isinf(value)))
      error(": its " + std::string(what) + " is " + text(value) + "; it must be a number of at least 0");
  };
  notNegative(joint.effort, "effort limit", true);
  notNegative(joint.velocity, "velocity limit", true);
  notNegative(joint.damping, "damping", false);
  notNegative(joint.friction, "friction", false);
  notNegative(joint.rotor_inertia, "rotor inertia", false);
  if (!std::isfinite(joint.gear_ratio) || joint.gear_ratio == 0)
    error(": its gear ratio is " + text(joint.gear_ratio) + "; it must be a number other than 0");
  if (joint.rotor_inertia > 0 && description::velocityCount(joint.type) > 1)
    error(" has several degrees of freedom: which one its rotor turns with is not said, leave it out");
}

void examineNumbers(const Robot& robot, Report& report) {
  for (const Link& link : robot.links) examineLink(link, report);
  for (const Joint& joint : robot.joints) examineJoint(joint, report);
}

/// The joint that carries each link, -1 for roots; none at all when a joint's ends leave no tree.
std::optional<std::vector<int>> findCarriers(const Robot& robot, Report& report) {
  const int link_count = static_cast<int>(robot.links.size());
  std::vector<int> carriers(robot.links.size(), -1);
  const auto isLink = [&](int link) { return link >= 0 && link < link_count; };
  bool sound = true;
  for (int j = 0; j < static_cast<int>(robot.joints.size()); ++j) {
    const Joint& joint = robot.joints[j];
    const std::string subject = "joint " + quoted(joint.name);
    const auto error = [&](const std::string& message) {
      report.error(Fault::structure, message, joint.place);
      sound = false;
    };
    if (!isLink(joint.parent)) error(subject + " has no parent link: name one of the robot's links");
    if (!isLink(joint.child)) error(subject + " has no child link: name one of the robot's links");
    if (!isLink(joint.parent) || !isLink(joint.child)) continue;
    const std::string child = quoted(robot.links[joint.child].name);
    int& carrier = carriers[joint.child];
    if (joint.child == joint.parent) {
      error(subject + " joins link " + child + " to itself: its parent and child must differ");
    } else if (carrier >= 0) {
      error("link " + child + " is the child of two joints, " + quoted(robot.joints[carrier].name) + " and " +
            quoted(joint.name) + ": a robot is a tree, remove one of them");
    } else {
      carrier = j;
    }
  }
  return sound ? std::optional(carriers) : std::nullopt;
}

int findRoot(const Robot& robot, const std::vector<int>& carriers, Report& report) {
  int root = -1;
  for (int i = 0; i < static_cast<int>(carriers.size()); ++i) {
    if (carriers[i] >= 0) continue;
    if (root < 0) {
      root = i;
    } else {
      report.error(Fault::structure,
                   "the robot has two roots, " + quoted(robot.links[root].name) + " and " +
                       quoted(robot.links[i].name) + ": join the second one to the tree",
                   robot.links[i].place);
    }
  }
  if (root < 0) {
    report.error(Fault::structure,
                 "every link is the child of a joint, so the joints form a loop: one link must be the base",
                 robot.joints.front().place);
  } else if (robot.root != root && !report.hasErrors()) {
    report.error(Fault::structure,
                 "the root of the robot is link " + quoted(robot.links[root].name) + ", which no joint carries",
                 robot.links[root].place);
  }
  return root;
}

/// Does the way up from a link run in a circle?
bool hangsInLoop(const Robot& robot, const std::vector<int>& carriers, int link) {
  for (std::size_t steps = 0; carriers[link] >= 0; ++steps) {
    if (steps == carriers.size()) return true;
    link = robot.joints[carriers[link]].parent;
  }
  return false;
}

/// Joints depth-first from the root, children in file order.
std::vector<int> depthFirst(const Robot& robot, const std::vector<int>& carriers, int root) {
  std::vector<std::vector<int>> joints_below(robot.links.size());
  for (int j = 0; j < static_cast<int>(robot.joints.size()); ++j)
    if (carriers[robot.joints[j].child] == j) joints_below[robot.joints[j].parent].push_back(j);
  std::vector<int> order;
  std::vector<int> pending(joints_below[root].rbegin(), joints_below[root].rend());
  while (!pending.empty()) {
    const int j = pending.back();
    pending.pop_back();
    order.push_back(j);
    const std::vector<int>& below = joints_below[robot.joints[j].child];
    pending.insert(pending.end(), below.rbegin(), below.rend());
  }
  return order;
}

/// Empty with errors.
std::vector<int> examineStructure(const Robot& robot, Report& report) {
  if (robot.links.empty()) {
    report.error(Fault::structure, "the robot " + quoted(robot.name) + " has no links", robot.place);
    return {};
  }
  findDoubles(robot.links, "link", report);
  findDoubles(robot.joints, "joint", report);
  findSharedCoordinates(robot, report);
  const std::optional<std::vector<int>> found = findCarriers(robot, report);
  if (!found) return {};
  const std::vector<int>& carriers = *found;
  const int root = findRoot(robot, carriers, report);
  if (root < 0) return {};
  for (int i = 0; i < static_cast<int>(robot.links.size()); ++i) {
    if (!hangsInLoop(robot, carriers, i)) continue;
    report.error(Fault::structure,
                 "link " + quoted(robot.links[i].name) + " hangs in a loop of joints that never reaches the base " +
                     quoted(robot.links[root].name) + ": open the loop",
                 robot.links[i].place);
  }
  return report.hasErrors() ? std::vector<int>{} : depthFirst(robot, carriers, root);
}

/// No drive, and why in `report`, when the way from a joint through its mimics does not end at a free joint.
std::optional<Drive> driveOf(const Robot& robot, int j, Report& report) {
  const int joint_count = static_cast<int>(robot.joints.size());
  const auto hasOneCoordinate = [](const Joint& joint) { return description::velocityCount(joint.type) == 1; };
  const Joint& driven = robot.joints[j];
  const auto refuse = [&](const std::string& what) {
    report.error(Fault::mimic, "joint " + quoted(driven.name) + what, driven.place);
    return std::nullopt;
  };
  Drive drive{.driver = j};
  for (int links = 0; robot.joints[drive.driver].mimic;) {
    const description::Mimic& mimic = *robot.joints[drive.driver].mimic;
    if (mimic.driver < 0 || mimic.driver >= joint_count)
      return refuse(" mimics a joint that the robot does not have: name one of its joints");
    if (!std::isfinite(mimic.multiplier) || !std::isfinite(mimic.offset))
      return refuse(": the multiplier and offset of its mimic must be finite numbers");
    if (++links > joint_count)
      return refuse(" mimics itself, directly or through others: one of them must move freely");
    drive.offset += drive.ratio * mimic.offset;
    drive.ratio *= mimic.multiplier;
    drive.driver = mimic.driver;
  }
  const Joint& driver = robot.joints[drive.driver];
  if (drive.driver != j && (!hasOneCoordinate(driven) || !hasOneCoordinate(driver)))
    return refuse(" mimics joint " + quoted(driver.name) + ": both must be revolute, continuous or prismatic");
  return drive;
}

struct Range {
  double lower, upper;
  bool empty() const { return lower > upper; }
};

std::string text(const Range& range) { return rounded(range.lower) + " to " + rounded(range.upper); }

/// Where a driver may stand so that what follows it keeps its own limits.
Range driverRange(const Joint& driven, const Drive& drive) {
  if (drive.ratio == 0) {                                          // it stands still: always, or never
    const bool kept = driven.lower <= drive.offset && drive.offset <= driven.upper;
    return kept ? Range{-description::infinity, description::infinity}
                : Range{description::infinity, -description::infinity};
  }
  const double a = (driven.lower - drive.offset) / drive.ratio, b = (driven.upper - drive.offset) / drive.ratio;
  return {std::min(a, b), std::max(a, b)};
}

/// The limits of all that follows a driver leave it some range.
void examineSharedLimits(const Robot& robot, const std::vector<Drive>& drives, Report& report) {
  std::vector<Range> left;                                         // of every driver
  for (const Joint& joint : robot.joints) left.push_back({joint.lower, joint.upper});
  for (std::size_t j = 0; j < drives.size(); ++j) {
    const Joint& driven = robot.joints[j];
    const std::size_t driver = static_cast<std::size_t>(drives[j].driver);
    if (driver == j || left[driver].empty() || driven.lower > driven.upper) continue;  // told elsewhere
    const Range wanted = driverRange(driven, drives[j]);
    const Range both{std::max(left[driver].lower, wanted.lower), std::min(left[driver].upper, wanted.upper)};
    if (!both.empty()) {
      left[driver] = both;
    } else if (wanted.empty()) {
      report.error(Fault::mimic,
                   "joint " + quoted(driven.name) + " always stands at " + rounded(drives[j].offset) +
                       ", outside its limits " + text(Range{driven.lower, driven.upper}) +
                       ": change the limits or the mimic",
                   driven.place);
    } else {
      report.error(Fault::mimic,
                   "joint " + quoted(driven.name) + " keeps its limits only while " +
                       quoted(robot.joints[driver].name) + ", which it follows, is in " + text(wanted) +
                       ", but that may only be in " + text(left[driver]) + ": change the limits or the mimic",
                   driven.place);
    }
  }
}

std::vector<Drive> examineMimics(const Robot& robot, Report& report) {
  std::vector<Drive> drives(robot.joints.size());
  for (int j = 0; j < static_cast<int>(robot.joints.size()); ++j)
    drives[j] = driveOf(robot, j, report).value_or(Drive{.driver = j});
  examineSharedLimits(robot, drives, report);
  return drives;
}

bool weighs(const Link& link) { return link.has_inertial && link.mass > 0; }

enum class Moments { possible, not_positive, too_unequal };

/// Ascending.
Eigen::Vector3d principalMoments(const Eigen::Matrix3d& inertia) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
}

Moments judge(const Eigen::Vector3d& moments) {
  if (moments[0] <= definite_tolerance * moments[2]) return Moments::not_positive;
  if (moments[2] > (moments[0] + moments[1]) * (1 + triangle_tolerance)) return Moments::too_unequal;
  return Moments::possible;
}

/// False, and why in `report`, when dynamics cannot use the body.
bool examineBody(const RigidBodyInertia& inertia, const Link& carrier, Report& report) {
  const std::string subject = "link " + quoted(carrier.name);
  if (!(inertia.mass > 0)) {
    report.error(carrier.has_inertial ? Fault::no_mass : Fault::no_inertial,
                 subject + " moves but has no mass: give it an <inertial> with mass and inertia, or join it by a fixed "
                           "joint to a link that has them",
                 carrier.place);
    return false;
  }
  const Eigen::Vector3d moments = principalMoments(inertia.inertiaAboutCentreOfMass());
  const std::string listed = "(principal moments about its centre of mass, with all that is fixed to it and its "
                             "rotor: " +
                             rounded(moments[0]) + ", " + rounded(moments[1]) + ", " + rounded(moments[2]) + " kg m²)";
  const Moments judgement = judge(moments);
  if (judgement == Moments::not_positive) {
    report.error(Fault::inertia,
                 subject + ": its inertia is not positive definite " + listed +
                     ": all three principal moments must be greater than 0",
                 carrier.place);
  } else if (judgement == Moments::too_unequal) {
    report.error(Fault::inertia,
                 subject + ": no body can have its inertia " + listed +
                     ": the greatest moment must not exceed the sum of the two others",
                 carrier.place);
  }
  return judgement == Moments::possible;
}

/// That a body has no mass hinders dynamics alone.
void warnOfNoMass(const RigidBodyInertia& inertia, const Link& carrier, Report& report) {
  if (inertia.mass > 0) return;
  const std::string subject = "link " + quoted(carrier.name);
  if (carrier.has_inertial) {
    report.warning(Fault::no_mass, subject + " has a mass that is not positive: the robot cannot be simulated",
                   carrier.place);
  } else {
    report.warning(Fault::no_inertial,
                   subject + " moves but has no <inertial>: the robot serves for kinematics only", carrier.place);
  }
}

bool isSound(const Link& link) {
  Report report;
  examineLink(link, report);
  return !report.hasErrors();
}

bool isSound(const Joint& joint) {
  Report report;
  examineJoint(joint, report);
  return !report.hasErrors();
}

/// A robot whose bodies can be looked at: what has no part in inertia is left out, what is wrong is made harmless.
/// `doubtful` are links that are then not what was written.
Robot forInertias(const Robot& robot, std::vector<bool>& doubtful) {
  Robot result = robot;
  doubtful.assign(robot.links.size(), false);
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (isSound(robot.links[i])) continue;
    result.links[i].has_inertial = false;
    doubtful[i] = true;
  }
  for (Joint& joint : result.joints) {
    Joint plain;
    plain.name = joint.name;
    plain.type = joint.type;
    plain.parent = joint.parent;
    plain.child = joint.child;
    Joint kept = plain;
    kept.origin = joint.origin;
    kept.axis = joint.axis;
    kept.rotor_inertia = joint.rotor_inertia;
    kept.gear_ratio = joint.gear_ratio;
    if (!isSound(kept)) doubtful[static_cast<std::size_t>(joint.child)] = true;
    joint = isSound(kept) ? kept : plain;
  }
  return result;
}

/// Bodies that move, each with the link that its joint carries.  Returns links that dynamics cannot use.
std::set<const Link*> examineBodies(const Robot& robot, MassPolicy policy, Report& report) {
  std::vector<bool> doubtful;
  const Model model(forInertias(robot, doubtful), MassPolicy::kinematics_only);
  std::set<int> doubtful_bodies;
  for (std::size_t i = 0; i < doubtful.size(); ++i)
    if (doubtful[i]) doubtful_bodies.insert(model.frames()[i].body);
  std::set<const Link*> refused;
  for (const Model::Joint& joint : model.joints()) {
    const int body = joint.first_body + joint.body_count - 1;
    if (doubtful_bodies.contains(body)) continue;
    const RigidBodyInertia& inertia = model.bodies()[body].inertia;
    const Link& carrier = robot.links[robot.joints[robot.jointIndex(joint.name)].child];
    if (policy == MassPolicy::kinematics_only) {
      warnOfNoMass(inertia, carrier, report);
    } else if (!examineBody(inertia, carrier, report)) {
      refused.insert(&carrier);
    }
  }
  return refused;
}

/// Tensors of links on their own.  A link of no mass may have no tensor either.
void warnOfTensors(const Robot& robot, const std::set<const Link*>& refused, Report& report) {
  for (const Link& link : robot.links) {
    if (!link.has_inertial || !isSound(link) || refused.contains(&link)) continue;
    if (link.mass == 0 && link.inertia.isZero(0)) continue;
    if (judge(principalMoments(link.inertia)) == Moments::possible) continue;
    report.warning(Fault::inertia,
                   "link " + quoted(link.name) +
                       " has an inertia tensor that no rigid body has: its principal moments must be positive, and "
                       "each at most the sum of the two others",
                   link.place);
  }
}

Eigen::Vector3d middle(const description::LinkShape& shape) {
  if (const auto* capsule = std::get_if<description::CapsuleShape>(&shape)) return (capsule->from + capsule->to) / 2;
  return std::get<description::BoxShape>(shape).pose.translation();
}

/// See validate().
void warnOfForgottenCentres(const Robot& robot, Report& report) {
  for (const Joint& joint : robot.joints) {
    if (joint.type != JointType::revolute && joint.type != JointType::spherical) continue;
    const Link& link = robot.links[joint.child];
    if (!weighs(link) || !link.centre_of_mass.isZero(0)) continue;
    const auto isBeside = [&](const Eigen::Vector3d& point) {
      const double along = joint.type == JointType::revolute ? point.dot(joint.axis) : 0;
      return (point - along * joint.axis).norm() > beside_axis;
    };
    const bool reaches_out =
        std::ranges::any_of(link.shapes, [&](const auto& shape) { return isBeside(middle(shape)); }) ||
        std::ranges::any_of(robot.joints, [&](const Joint& next) {
          return next.parent == joint.child && next.type != JointType::fixed && isBeside(next.origin.translation());
        });
    if (!reaches_out) continue;
    report.warning(Fault::centre_of_mass,
                   "link " + quoted(link.name) +
                       " has its centre of mass exactly at its joint, though it reaches out beside it: its weight "
                       "gives no torque there; public models of hands often forget the <origin> of the <inertial>",
                   link.place);
  }
}

}  // namespace

std::vector<std::string> coordinateNames(const Joint& joint) {
  return withSuffixes(joint.name, coordinateSuffixes(joint.type));
}

std::vector<std::string> positionNames(const Joint& joint) {
  return withSuffixes(joint.name, positionSuffixes(joint.type));
}

std::vector<RobotFinding> validate(const Robot& robot, MassPolicy policy) {
  Report report;
  examineStructure(robot, report);
  const bool is_tree = !report.hasErrors();
  examineNumbers(robot, report);
  examineMimics(robot, report);
  std::set<const Link*> refused;
  if (is_tree) refused = examineBodies(robot, policy, report);
  warnOfTensors(robot, refused, report);
  if (is_tree) warnOfForgottenCentres(robot, report);
  return report.take();
}

std::vector<int> checkStructure(const Robot& robot) {
  Report report;
  std::vector<int> order = examineStructure(robot, report);
  report.throwFirst();
  return order;
}

std::vector<Drive> resolveMimics(const Robot& robot) {
  Report report;
  std::vector<Drive> drives = examineMimics(robot, report);
  report.throwFirst();
  return drives;
}

void checkNumbers(const Robot& robot) {
  Report report;
  examineNumbers(robot, report);
  report.throwFirst();
}

void checkBodyInertia(const RigidBodyInertia& inertia, const Link& carrier) {
  Report report;
  examineBody(inertia, carrier, report);
  report.throwFirst();
}

}  // namespace tactus::dynamics
