#include <Eigen/Cholesky>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/tactus/command.h"
#include "apps/tactus/program.h"
#include "apps/tactus/text.h"
#include "dsl/model_search.h"
#include "dsl/read_robot.h"
#include "framework/description/combine.h"
#include "framework/dynamics/aba.h"
#include "framework/dynamics/configuration.h"
#include "framework/dynamics/crba.h"
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

/// A file as it is, or the name of a robot in the folders of models.
std::string findModel(const std::string& model) {
  if (std::filesystem::is_regular_file(model)) return model;
  std::vector<std::string> folders = runtime::foldersFromEnvironment("TACTUS_MODEL_PATH");
  folders.push_back(runtime::shippedModelFolder());
  const dsl::ModelSearch search = dsl::findModel(model, ".", folders);
  if (!search.file.empty()) return search.file;
  throw runtime::FileError(model, "is neither a file nor the name of a robot; tried " + joined(search.tried) +
                                      "; robots there are: " + joined(search.names));
}

/// One number for each name; throws UsageError that lists them.
VectorXd namedVector(const std::string& option, const std::string& text, const std::vector<std::string>& names,
                     const std::string& what) {
  const std::vector<double> numbers = parseNumbers(text, option);
  if (numbers.size() != names.size()) {
    throw UsageError(option + " has " + std::to_string(numbers.size()) + " numbers, but the robot has " +
                     std::to_string(names.size()) + " " + what + ": " + joined(names));
  }
  return Eigen::Map<const VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

/// Rates, accelerations or torques.
VectorXd jointVector(const std::string& option, const std::string& text, const dynamics::Model& model) {
  return namedVector(option, text, model.jointNames(), "degrees of freedom");
}

/// Quaternions come out with unit length: as they are written they have a few digits only.
VectorXd positionVector(const std::string& option, const std::string& text, const dynamics::Model& model) {
  constexpr double length_tolerance = 1e-3;
  VectorXd q = namedVector(option, text, model.positionNames(),
                           model.hasQuaternions() ? "positions" : "degrees of freedom");
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
  if (numbers.size() != 3) throw UsageError("--gravity has " + std::to_string(numbers.size()) + " numbers, expected 3");
  return {numbers[0], numbers[1], numbers[2]};
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
    frames[model.frames()[static_cast<size_t>(i)].name] = {{"position", listOf(pose.translation())},
                                                          {"rotation", rowsOf(pose.linear())},
                                                          {"jacobian", rowsOf(jacobian)}};
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

/// q̈.  The articulated-body algorithm knows no coupled joints: for those M q̈ = τ − bias is solved.
VectorXd forwardDynamics(const dynamics::Model& model, const VectorXd& q, const VectorXd& qd, const VectorXd& tau,
                         const Vector3d& gravity_W, const MatrixXd& mass_matrix, dynamics::Workspace& workspace) {
  VectorXd result(model.dof());
  if (model.coupled()) {
    dynamics::nonlinearEffects(model, q, qd, gravity_W, workspace, result);
    return mass_matrix.ldlt().solve(tau - result);
  }
  dynamics::aba(model, q, qd, tau, gravity_W, workspace, result);
  return result;
}

description::Robot floating(description::Robot robot) {
  const std::string joint = "floating_base";
  if (robot.linkIndex("world") >= 0 || robot.jointIndex(joint) >= 0)
    throw UsageError("--floating-base adds a link 'world' and a joint '" + joint +
                     "', but the robot has one of that name already: give it another one");
  return description::withFloatingBase(std::move(robot), joint);
}

/// A model without masses still has kinematics; says on stderr what is missing.
dynamics::Model makeModel(const description::Robot& robot, bool& has_masses) {
  try {
    has_masses = true;
    return dynamics::Model(robot, dynamics::MassPolicy::required);
  } catch (const dynamics::ModelError& error) {
    has_masses = false;
    std::cerr << "tactus dynamics: " << error.what() << "; kinematics only\n";
    return dynamics::Model(robot, dynamics::MassPolicy::kinematics_only);
  }
}

int printDynamics(const DynamicsArguments& arguments) {
  std::vector<dsl::Diagnostic> warnings;
  description::Robot robot = dsl::readRobot(findModel(arguments.model), warnings);
  if (arguments.floating_base) robot = floating(std::move(robot));
  for (const dsl::Diagnostic& warning : warnings) std::cerr << dsl::render(warning) << "\n";
  bool has_masses = false;
  const dynamics::Model model = makeModel(robot, has_masses);
  const auto vectorOrZero = [&](const std::string& option, const std::string& text) {
    return text.empty() ? VectorXd(VectorXd::Zero(model.dof())) : jointVector(option, text, model);
  };
  const VectorXd q = positionVector("--q", arguments.q, model);
  const VectorXd qd = vectorOrZero("--qd", arguments.qd);
  const VectorXd qdd = vectorOrZero("--qdd", arguments.qdd);
  const VectorXd tau = vectorOrZero("--tau", arguments.tau);
  const Vector3d gravity_W = gravityVector(arguments.gravity);

  dynamics::Workspace workspace(model);
  ordered_json json{{"joints", model.jointNames()}, {"positions", model.positionNames()}, {"dof", model.dof()}};
  MatrixXd mass_matrix = MatrixXd::Zero(model.dof(), model.dof());
  if (has_masses) {
    VectorXd result(model.dof());
    dynamics::crba(model, q, workspace, mass_matrix);
    json["mass_matrix"] = rowsOf(mass_matrix);
    dynamics::nonlinearEffects(model, q, qd, gravity_W, workspace, result);
    json["bias"] = listOf(result);
    dynamics::gravityTorque(model, q, gravity_W, workspace, result);
    json["gravity"] = listOf(result);
    if (!arguments.qdd.empty()) {
      dynamics::rnea(model, q, qd, qdd, gravity_W, workspace, result);
      json["inverse_dynamics"] = listOf(result);
    }
    if (!arguments.tau.empty())
      json["forward_dynamics"] = listOf(forwardDynamics(model, q, qd, tau, gravity_W, mass_matrix, workspace));
  }
  dynamics::forwardKinematics(model, q, workspace);
  if (has_masses) {
    const WholeRobot whole = wholeRobot(robot, model, workspace);
    json["mass"] = whole.mass;
    json["centre_of_mass"] = listOf(whole.centre_of_mass);
    json["kinetic_energy"] = 0.5 * qd.dot(mass_matrix * qd);
    json["potential_energy"] = -whole.mass * gravity_W.dot(whole.centre_of_mass);
  }
  json["frames"] = frames(model, workspace);
  std::cout << json.dump(2) << "\n";
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
  vector("--q", arguments->q, "Joint positions, rad or m; quaternions as w,x,y,z")->required();
  vector("--qd", arguments->qd, "Joint velocities; 0 without it");
  vector("--qdd", arguments->qdd, "Joint accelerations: adds inverse_dynamics");
  vector("--tau", arguments->tau, "Joint torques: adds forward_dynamics");
  vector("--gravity", arguments->gravity, "Free-fall acceleration in the world; 0,0,-9.81 without it");
  command->add_flag("--floating-base", arguments->floating_base, "Let the root link fly: six degrees of freedom more");
  command->add_flag("--json", context.json, "JSON on stdout, which is also what is printed without it");
  command->footer(
      R"(Prints {joints, positions, dof, mass_matrix, bias, gravity, inverse_dynamics, forward_dynamics, mass,
centre_of_mass, kinetic_energy, potential_energy, frames: {link: {position, rotation, jacobian}}}: positions names the
numbers of --q and joints those of --qd, --qdd and --tau, which are fewer when the robot has ball joints or floats;
joints that follow others have none.  bias holds Coriolis, centrifugal and gravity torques; Jacobians have linear rows
first, in world axes, at the link's origin; mass and centre_of_mass are of all links, those fixed to the base too; the
potential energy is 0 at the world's origin.  A robot without masses gets joints, positions, dof and frames alone.
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
