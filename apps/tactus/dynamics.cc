#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/tactus/command.h"
#include "apps/tactus/errors.h"
#include "apps/tactus/program.h"
#include "apps/tactus/text.h"
#include "dsl/codes.h"
#include "dsl/model_search.h"
#include "dsl/nearest_name.h"
#include "dsl/read_robot.h"
#include "framework/description/combine.h"
#include "framework/dynamics/cholesky.h"
#include "framework/dynamics/configuration.h"
#include "framework/dynamics/crba.h"
#include "framework/dynamics/forward_dynamics.h"
#include "framework/dynamics/model.h"
#include "framework/dynamics/rnea.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/program_path.h"

namespace tactus::app {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using nlohmann::ordered_json;

struct DynamicsArguments {
  std::string model;
  std::string q, qd, qdd, tau, gravity;
  bool floating_base = false;
};

/// A file as it is, a pipe too, or the name of a robot in the folders of models.
std::string findModel(const std::string& model) {
  namespace fs = std::filesystem;
  if (model.empty()) throw UsageError("MODEL is empty: name a URDF file or a robot");
  std::error_code error;
  const fs::file_status status = fs::status(model, error);
  if (fs::exists(status) && !fs::is_directory(status)) return model;
  std::vector<std::string> folders = runtime::foldersFromEnvironment("TACTUS_MODEL_PATH");
  folders.push_back(runtime::shippedModelFolder());
  const dsl::ModelSearch search = dsl::findModel(model, ".", folders);
  if (!search.file.empty()) return search.file;
  if (fs::is_directory(status))
    throw runtime::FileError(model, "is a folder; expected a URDF file or the name of a robot");
  const std::string nearest = dsl::nearestName(model, search.names);
  throw runtime::FileError(model, "is neither a file nor the name of a robot" +
                                      (nearest.empty() ? "" : "; did you mean '" + nearest + "'?") + "; tried " +
                                      joined(search.tried) + "; robots there are: " + joined(search.names));
}

/// What the numbers of an option stand for, e.g. "1 degree of freedom".
struct Kind {
  std::string one, many;
};
const Kind freedoms{"degree of freedom", "degrees of freedom"};
const Kind positions{"position", "positions"};

/// One number for each name; throws UsageError that lists them.
VectorXd namedVector(const std::string& option, const std::string& text, const std::vector<std::string>& names,
                     const Kind& kind) {
  const std::vector<double> numbers = parseNumbers(text, option);
  if (numbers.size() != names.size()) {
    throw UsageError(option + " has " + counted(numbers.size(), "number", "numbers") + ", but the robot has " +
                     counted(names.size(), kind.one, kind.many) + ": " + joined(names));
  }
  return Eigen::Map<const VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

/// Rates, accelerations or torques.
VectorXd jointVector(const std::string& option, const std::string& text, const dynamics::Model& model) {
  return namedVector(option, text, model.jointNames(), freedoms);
}

/// The neutral pose without text.  Quaternions come out with unit length: as they are written they have a few digits
/// only.
VectorXd positionVector(const std::string& option, const std::string& text, const dynamics::Model& model) {
  constexpr double length_tolerance = 1e-3;
  if (text.empty()) return model.neutral();
  VectorXd q = namedVector(option, text, model.positionNames(), model.hasQuaternions() ? positions : freedoms);
  for (const dynamics::Model::Joint& joint : model.joints()) {
    if (joint.position_count == joint.coordinate_count) continue;
    const double length = q.segment<4>(joint.position + joint.position_count - 4).norm();
    if (std::abs(length - 1) > length_tolerance)
      throw UsageError(option + ": the quaternion w,x,y,z of joint '" + joint.name + "' has length " + rounded(length) +
                       ", expected 1");
  }
  dynamics::normalise(model, q);
  return q;
}

Vector3d gravityVector(const std::string& text) {
  if (text.empty()) return {0, 0, -9.81};
  const std::vector<double> numbers = parseNumbers(text, "--gravity");
  if (numbers.size() != 3)
    throw UsageError("--gravity has " + counted(numbers.size(), "number", "numbers") + ", expected 3");
  return {numbers[0], numbers[1], numbers[2]};
}

/// Throws NumericalError with the name of the quantity: JSON has no word for what is no number.
void requireFinite(bool finite, const std::string& quantity) {
  if (!finite)
    throw NumericalError(quantity + " is not finite: numbers of the robot or of the command line are too large");
}

template <class Numbers>
const Numbers& finite(const Numbers& numbers, const std::string& quantity) {
  requireFinite(numbers.allFinite(), quantity);
  return numbers;
}

double finite(double number, const std::string& quantity) {
  requireFinite(std::isfinite(number), quantity);
  return number;
}

ordered_json listOf(const VectorXd& vector) { return std::vector<double>(vector.begin(), vector.end()); }

ordered_json rowsOf(const MatrixXd& matrix) {
  ordered_json rows = ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows.push_back(listOf(matrix.row(i).transpose()));
  return rows;
}

ordered_json frames(const dynamics::Model& model, const dynamics::Workspace& workspace) {
  ordered_json frames = ordered_json::object();
  MatrixXd jacobian(6, model.dof());
  for (int i = 0; i < static_cast<int>(model.frames().size()); ++i) {
    const Eigen::Isometry3d pose = dynamics::framePose(model, workspace, i);
    dynamics::frameJacobian(model, workspace, i, jacobian);
    const std::string& name = model.frames()[static_cast<size_t>(i)].name;
    requireFinite(pose.matrix().allFinite(), "the pose of link '" + name + "'");
    frames[name] = {{"position", listOf(pose.translation())},
                    {"rotation", rowsOf(pose.linear())},
                    {"jacobian", rowsOf(finite(jacobian, "the Jacobian of link '" + name + "'"))}};
  }
  return frames;
}

/// Of all links, those that are fixed to the base too.  After forwardKinematics.
struct WholeRobot {
  double mass = 0;
  Vector3d centre_of_mass = Vector3d::Zero();                      // m, in the world; zero without mass
};

WholeRobot wholeRobot(const description::Robot& robot, const dynamics::Model& model,
                      const dynamics::Workspace& workspace) {
  WholeRobot whole;
  for (size_t i = 0; i < robot.links.size(); ++i) {                // frame i of the model is link i of the robot
    const description::Link& link = robot.links[i];
    if (!link.has_inertial) continue;
    whole.mass += link.mass;
    whole.centre_of_mass += link.mass * (framePose(model, workspace, static_cast<int>(i)) * link.centre_of_mass);
  }
  if (whole.mass > 0) whole.centre_of_mass /= whole.mass;
  return whole;
}

/// Of every coordinate; null where there is no limit.
ordered_json limits(const dynamics::Model& model) {
  const auto listed = [](const VectorXd& values) {
    ordered_json list = ordered_json::array();
    for (const double value : values) list.push_back(std::isfinite(value) ? ordered_json(value) : ordered_json());
    return list;
  };
  return {{"lower", listed(model.lower())},
          {"upper", listed(model.upper())},
          {"velocity", listed(model.velocityLimit())},
          {"effort", listed(model.effort())}};
}

/// Joints that follow another one: q = ratio · q of the driver + offset, chains of them followed to their end.
ordered_json drivenJoints(const dynamics::Model& model) {
  ordered_json driven = ordered_json::object();
  for (const dynamics::Model::Joint& joint : model.joints()) {
    if (joint.driver < 0) continue;
    const dynamics::Model::Body& body = model.bodies()[static_cast<size_t>(joint.first_body)];
    driven[joint.name] = {{"driver", model.joints()[static_cast<size_t>(joint.driver)].name},
                          {"ratio", finite(body.ratio, "the ratio of joint '" + joint.name + "'")},
                          {"offset", finite(body.offset, "the offset of joint '" + joint.name + "'")}};
  }
  return driven;
}

void warnOfLimits(const dynamics::Model& model, const VectorXd& q) {
  constexpr int digits = 6;
  for (const dynamics::Model::Joint& joint : model.joints()) {
    if (joint.driver >= 0 || joint.position_count != 1) continue;
    const double at = q[joint.position], lower = model.lower()[joint.coordinate],
                 upper = model.upper()[joint.coordinate];
    if (at >= lower && at <= upper) continue;
    std::cerr << "tactus dynamics: warning: joint '" << joint.name << "' is at " << rounded(at, digits)
              << ", outside its limits " << rounded(lower, digits) << " and " << rounded(upper, digits) << "\n";
  }
}

/// Moments of inertia are summed about the world's origin, which costs digits far from it (docs/dynamics.md): warns
/// at the joint that loses most.  After crba.
void warnOfLostDigits(const description::Robot& robot, const dynamics::Model& model,
                      const dynamics::Workspace& workspace, const MatrixXd& mass_matrix) {
  constexpr double tolerable = 1e-7;                               // relative error of a joint's inertia
  double worst = tolerable, distance = 0;
  const description::Joint* loser = nullptr;
  for (const dynamics::Model::Joint& joint : model.joints()) {
    for (int i = joint.first_body; i < joint.first_body + joint.body_count; ++i) {
      const dynamics::Model::Body& body = model.bodies()[static_cast<size_t>(i)];
      if (body.motion == dynamics::Motion::translation) continue;
      const dynamics::RigidBodyInertia& carried = workspace.bodies[static_cast<size_t>(i)].composite;
      const double rounding = body.ratio * body.ratio * Eigen::NumTraits<double>::epsilon() * carried.rotational.norm();
      const double own = mass_matrix(body.coordinate, body.coordinate);
      const double share = own > rounding ? rounding / own : 1;
      if (share <= worst) continue;
      worst = share;
      distance = carried.centreOfMass().norm();
      loser = &robot.joints[static_cast<size_t>(robot.jointIndex(joint.name))];
    }
  }
  if (!loser) return;
  dsl::Diagnostic warning;
  warning.severity = dsl::Severity::warning;
  warning.code = dsl::code::lost_digits.id;
  warning.place = loser->place;
  warning.message = "the inertia at joint '" + loser->name + "' keeps about " +
                    counted(static_cast<size_t>(-std::log10(worst)), "digit", "digits") +
                    " of 16: what it carries lies " + rounded(distance, 3) +
                    " m from the world's origin, bring it nearer";
  std::cerr << dsl::render(warning) << "\n";
}

/// The mass matrix of any robot is positive definite: else rounding has eaten it.
void requirePositiveDefinite(const description::Robot& robot, const MatrixXd& mass_matrix) {
  MatrixXd factor(mass_matrix.rows(), mass_matrix.cols());
  if (dynamics::choleskyFactor(mass_matrix, factor)) return;
  throw NumericalError(located(robot.place,
                               "the mass matrix is not positive definite: rounding has eaten it, since masses, lengths "
                               "or distances from the world's origin lie too many orders of magnitude apart"));
}

description::Robot floating(description::Robot robot) {
  const std::string joint = "floating_base";
  if (robot.linkIndex("world") >= 0 || robot.jointIndex(joint) >= 0)
    throw UsageError("--floating-base adds a link 'world' and a joint '" + joint +
                     "', but the robot has one of that name already: give it another one");
  return description::withFloatingBase(std::move(robot), joint);
}

/// A model without masses still has kinematics; says on stderr what is missing, or throws when dynamics are asked for.
dynamics::Model makeModel(const description::Robot& robot, bool needs_masses, bool& has_masses) {
  try {
    has_masses = true;
    return dynamics::Model(robot, dynamics::MassPolicy::required);
  } catch (const dynamics::ModelError& error) {
    if (needs_masses) throw;
    has_masses = false;
    std::cerr << located(error.place, error.what()) << "; kinematics only\n";
    return dynamics::Model(robot, dynamics::MassPolicy::kinematics_only);
  }
}

/// With what can be warned of on stderr, even when there are errors too.
description::Robot readRobot(const std::string& file) {
  std::vector<dsl::Diagnostic> warnings;
  const auto print = [&] {
    for (const dsl::Diagnostic& warning : warnings) std::cerr << dsl::render(warning) << "\n";
  };
  try {
    description::Robot robot = dsl::readRobot(file, warnings);
    print();
    return robot;
  } catch (const dsl::InvalidStack&) {
    print();
    throw;
  }
}

int printDynamics(const DynamicsArguments& arguments) {
  description::Robot robot = readRobot(findModel(arguments.model));
  if (arguments.floating_base) robot = floating(std::move(robot));
  bool has_masses = false;
  const bool needs_masses = !arguments.qdd.empty() || !arguments.tau.empty();
  const dynamics::Model model = makeModel(robot, needs_masses, has_masses);
  const auto vectorOrZero = [&](const std::string& option, const std::string& text) {
    return text.empty() ? VectorXd(VectorXd::Zero(model.dof())) : jointVector(option, text, model);
  };
  const VectorXd q = positionVector("--q", arguments.q, model);
  const VectorXd qd = vectorOrZero("--qd", arguments.qd);
  const VectorXd qdd = vectorOrZero("--qdd", arguments.qdd);
  const VectorXd tau = vectorOrZero("--tau", arguments.tau);
  const Vector3d gravity_W = gravityVector(arguments.gravity);
  warnOfLimits(model, q);

  dynamics::Workspace workspace(model);
  ordered_json json{{"joints", model.jointNames()}, {"positions", model.positionNames()}, {"dof", model.dof()},
                    {"limits", limits(model)},      {"driven", drivenJoints(model)},      {"q", listOf(q)},
                    {"kinematics_only", !has_masses}};
  MatrixXd mass_matrix = MatrixXd::Zero(model.dof(), model.dof());
  if (has_masses) {
    VectorXd result(model.dof());
    dynamics::crba(model, q, workspace, mass_matrix);
    json["mass_matrix"] = rowsOf(finite(mass_matrix, "the mass matrix"));
    warnOfLostDigits(robot, model, workspace, mass_matrix);
    requirePositiveDefinite(robot, mass_matrix);
    dynamics::nonlinearEffects(model, q, qd, gravity_W, workspace, result);
    json["bias"] = listOf(finite(result, "bias"));
    dynamics::gravityTorque(model, q, gravity_W, workspace, result);
    json["gravity"] = listOf(finite(result, "gravity"));
    if (!arguments.qdd.empty()) {
      dynamics::rnea(model, q, qd, qdd, gravity_W, workspace, result);
      json["inverse_dynamics"] = listOf(finite(result, "inverse_dynamics"));
    }
    if (!arguments.tau.empty()) {
      dynamics::ForwardDynamics(model).compute(q, qd, tau, gravity_W, workspace, result);
      json["forward_dynamics"] = listOf(finite(result, "forward_dynamics"));
    }
  }
  dynamics::forwardKinematics(model, q, workspace);
  if (has_masses) {
    const WholeRobot whole = wholeRobot(robot, model, workspace);
    json["mass"] = finite(whole.mass, "mass");
    json["centre_of_mass"] = listOf(finite(whole.centre_of_mass, "centre_of_mass"));
    json["kinetic_energy"] = finite(0.5 * qd.dot(mass_matrix * qd), "kinetic_energy");
    json["potential_energy"] = finite(-whole.mass * gravity_W.dot(whole.centre_of_mass), "potential_energy");
  }
  json["frames"] = frames(model, workspace);
  std::cout << jsonText(json, 2) << "\n";
  return exit_done;
}

}  // namespace

void addDynamics(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("dynamics", "Rigid-body dynamics of a robot at one state");
  const auto arguments = std::make_shared<DynamicsArguments>();
  command->add_option("MODEL", arguments->model, "A URDF file, or the name of a shipped robot")
      ->required()
      ->type_name("");
  const auto vector = [&](const std::string& name, std::string& value, const std::string& description) {
    return command->add_option(name, value, description)->type_name("A,B,…");
  };
  vector("--q", arguments->q, "Joint positions, rad or m; quaternions as w,x,y,z; the neutral pose without it");
  vector("--qd", arguments->qd, "Joint velocities; 0 without it");
  vector("--qdd", arguments->qdd, "Joint accelerations: adds inverse_dynamics");
  vector("--tau", arguments->tau, "Joint torques: adds forward_dynamics");
  vector("--gravity", arguments->gravity, "Free-fall acceleration in the world; 0,0,-9.81 without it");
  command->add_flag("--floating-base", arguments->floating_base, "Let the root link fly: six degrees of freedom more");
  command->add_flag("--json", context.json, "JSON on stdout, which is also what is printed without it");
  command->footer(
      R"(Prints {joints, positions, dof, limits: {lower, upper, velocity, effort}, driven: {joint: {driver, ratio,
offset}}, q, kinematics_only, mass_matrix, bias, gravity, inverse_dynamics, forward_dynamics, mass,
centre_of_mass, kinetic_energy, potential_energy, frames: {link: {position, rotation, jacobian}}}: positions names the
numbers of --q and joints those of --qd, --qdd and --tau, which are fewer when the robot has ball joints or floats;
joints that follow others have none and are listed as driven; a limit of null is none.  Without --q every joint is at
0.  bias holds Coriolis, centrifugal and gravity torques; Jacobians have linear rows first, in world axes, at the link's
origin; mass and centre_of_mass are of all links, those fixed to the base too; the potential energy is 0 at the world's
origin.  A robot without masses is kinematics_only: it has no key after that but
frames, and --qdd and --tau are refused.  A result that is not finite, or a mass matrix that rounding has eaten, ends
with exit code 5.
A floating joint has x,y,z and a quaternion w,x,y,z among the positions, and among the rates the velocity of its child's
origin in the axes that the joint starts from (of a base: the world's) and the angular velocity in the axes of the child;
a spherical joint has the quaternion and the angular velocity alone, a planar one x,y and an angle.

Examples:
  tactus dynamics robot.urdf --q 0.1,-0.2,0.3 --json
  tactus dynamics lwr_4plus --q 0,0,0,1.57,0,0,0 --qdd 0,0,0,1,0,0,0 --gravity 0,0,0
  tactus dynamics robot.urdf --floating-base --q 0,0,1,1,0,0,0,0.1,-0.2,0.3 --json)");
  command->callback([=, &context] { context.action = [=] { return printDynamics(*arguments); }; });
}

}  // namespace tactus::app
