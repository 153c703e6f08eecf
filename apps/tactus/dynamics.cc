#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/tactus/command.h"
#include "apps/tactus/program.h"
#include "apps/tactus/text.h"
#include "dsl/model_search.h"
#include "dsl/read_robot.h"
#include "framework/dynamics/aba.h"
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

/// One number for each joint; throws UsageError that names the joints.
VectorXd jointVector(const std::string& option, const std::string& text, const dynamics::Model& model) {
  const std::vector<double> numbers = parseNumbers(text, option);
  if (static_cast<int>(numbers.size()) != model.dof()) {
    throw UsageError(option + " has " + std::to_string(numbers.size()) + " numbers, but the robot has " +
                     std::to_string(model.dof()) + " degrees of freedom: " + joined(model.jointNames()));
  }
  return Eigen::Map<const VectorXd>(numbers.data(), model.dof());
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
  const description::Robot robot = dsl::readRobot(findModel(arguments.model), warnings);
  for (const dsl::Diagnostic& warning : warnings) std::cerr << dsl::render(warning) << "\n";
  bool has_masses = false;
  const dynamics::Model model = makeModel(robot, has_masses);
  const auto vectorOrZero = [&](const std::string& option, const std::string& text) {
    return text.empty() ? VectorXd(VectorXd::Zero(model.dof())) : jointVector(option, text, model);
  };
  const VectorXd q = jointVector("--q", arguments.q, model);
  const VectorXd qd = vectorOrZero("--qd", arguments.qd);
  const VectorXd qdd = vectorOrZero("--qdd", arguments.qdd);
  const VectorXd tau = vectorOrZero("--tau", arguments.tau);
  const Vector3d gravity_W = gravityVector(arguments.gravity);

  dynamics::Workspace workspace(model);
  ordered_json json{{"joints", model.jointNames()}};
  if (has_masses) {
    MatrixXd mass_matrix = MatrixXd::Zero(model.dof(), model.dof());
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
    if (!arguments.tau.empty()) {
      dynamics::aba(model, q, qd, tau, gravity_W, workspace, result);
      json["forward_dynamics"] = listOf(result);
    }
  }
  dynamics::forwardKinematics(model, q, workspace);
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
  vector("--q", arguments->q, "Joint positions, rad or m")->required();
  vector("--qd", arguments->qd, "Joint velocities; 0 without it");
  vector("--qdd", arguments->qdd, "Joint accelerations: adds inverse_dynamics");
  vector("--tau", arguments->tau, "Joint torques: adds forward_dynamics");
  vector("--gravity", arguments->gravity, "Free-fall acceleration in the world; 0,0,-9.81 without it");
  command->add_flag("--json", context.json, "JSON on stdout, which is also what is printed without it");
  command->footer(
      R"(Prints {joints, mass_matrix, bias, gravity, inverse_dynamics, forward_dynamics, frames: {link:
{position, rotation, jacobian}}}: bias holds Coriolis, centrifugal and gravity torques; Jacobians have linear rows
first, in world axes, at the link's origin.  A robot without masses gets joints and frames alone.

Examples:
  tactus dynamics robot.urdf --q 0.1,-0.2,0.3 --json
  tactus dynamics lwr_4plus --q 0,0,0,1.57,0,0,0 --qdd 0,0,0,1,0,0,0 --gravity 0,0,0)");
  command->callback([=, &context] { context.action = [=] { return printDynamics(*arguments); }; });
}

}  // namespace tactus::app
