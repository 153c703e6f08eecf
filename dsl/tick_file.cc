#include "dsl/tick_file.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>
#include <vector>

#include "dsl/capsule.h"
#include "dsl/tick_json.h"
#include "framework/runtime/file_error.h"

namespace tactus::dsl {
namespace {

using control::TickLevel;
using control::TickProblem;
using control::TickTask;

constexpr const char* file_format = "tactus-tick/1";
constexpr double symmetry_tolerance = 1e-9;                        // relative to the largest entry
constexpr int friction_rows = 3;

Eigen::MatrixXd readMassMatrix(const JsonNode& node, int dof, bool checked) {
  if (node.size() != static_cast<std::size_t>(dof))
    node.fail("has " + countOf(node.size(), "row") + ", expected " + std::to_string(dof));
  const Eigen::MatrixXd M = node.rows(dof);
  if (!checked) return M;
  const double largest = M.cwiseAbs().maxCoeff();
  for (int i = 0; i < dof; ++i)
    for (int j = 0; j < i; ++j)
      if (std::abs(M(i, j) - M(j, i)) > symmetry_tolerance * largest)
        node.fail("is not symmetric: row " + std::to_string(i + 1) + ", column " + std::to_string(j + 1));
  if (M.llt().info() != Eigen::Success) node.fail("is not positive definite");
  return M;
}

control::TorqueLimits readLimits(const JsonNode& node, int dof) {
  node.expectObject({"lower", "upper"}, {"priority"});
  control::TorqueLimits limits;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  limits.lower = node.at("lower").limits(dof, -infinity);
  limits.upper = node.at("upper").limits(dof, infinity);
  for (int i = 0; i < dof; ++i)
    if (limits.lower[i] > limits.upper[i]) node.fail("lower exceeds upper at joint " + std::to_string(i + 1));
  if (node.has("priority")) limits.priority = node.at("priority").integer(1);
  return limits;
}

TickTask readTask(const JsonNode& node, int dof) {
  node.expectObject({"name", "relation", "jacobian", "force"}, {"acceleration", "contact", "force_max", "friction"});
  const Eigen::MatrixXd jacobian = node.at("jacobian").rows(dof);
  const int rows = static_cast<int>(jacobian.rows());
  TickTask task(node.at("name").text(), rows, dof);
  task.rows = rows;
  task.jacobian = jacobian;
  const std::string relation = node.at("relation").text();
  if (relation != "equality" && relation != "inequality")
    node.at("relation").fail("\"" + relation + "\" is neither \"equality\" nor \"inequality\"");
  task.relation = relation == "equality" ? control::Relation::equality : control::Relation::inequality;
  task.force = node.at("force").vector(rows);
  if (node.has("acceleration")) {
    task.has_acceleration = true;
    task.acceleration = node.at("acceleration").vector(rows);
  }
  if (node.has("contact")) task.contact = node.at("contact").flag();
  if (node.has("force_max")) {
    task.force_max = node.at("force_max").number();
    if (task.force_max < 0) node.at("force_max").fail("must not be negative");
  }
  if (node.has("friction")) {
    task.friction = node.at("friction").number();
    if (*task.friction < 0) node.at("friction").fail("must not be negative");
    if (rows % friction_rows != 0)
      node.at("friction").fail("needs rows in threes (normal and two tangents), the task has " + countOf(rows, "row"));
  }
  for (const char* key : {"force_max", "friction"})
    if (node.has(key) && !task.contact) node.at(key).fail("needs \"contact\": true");
  return task;
}

TickLevel readLevel(const JsonNode& node, int dof) {
  node.expectObject({"priority", "tasks"}, {"weight"});
  TickLevel level;
  level.priority = node.at("priority").integer(1);
  if (node.has("weight")) {
    level.weight = node.at("weight").number();
    if (*level.weight <= 0) node.at("weight").fail("must be above 0");
  }
  const JsonNode tasks = node.at("tasks");
  for (std::size_t t = 0; t < tasks.size(); ++t) level.tasks.push_back(readTask(tasks.at(t), dof));
  return level;
}

// JSON knows no infinity: null.
Json numbers(const Eigen::Ref<const Eigen::VectorXd>& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  return array;
}

Json exactMatrix(const Eigen::MatrixXd& values) {
  Json rows = Json::array();
  for (int r = 0; r < values.rows(); ++r) rows.push_back(exactNumbers(values.row(r).transpose()));
  return rows;
}

}  // namespace

const char* statusName(control::Status status) {
  switch (status) {
    case control::Status::ok: return "ok";
    case control::Status::infeasible: return "infeasible";
    case control::Status::failed: return "failed";
  }
  return "failed";
}

Json exactNumbers(const Eigen::Ref<const Eigen::VectorXd>& values) {
  Json array = Json::array();
  for (const double value : values) {
    if (std::isfinite(value))
      array.push_back(value);
    else
      array.push_back(std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
  }
  return array;
}

TickProblem readTickProblem(const std::string& file) { return parseTickProblem(runtime::readFile(file)); }

TickProblem parseTickProblem(const std::string& text) { return parseTickFile(text).problem; }

TickProblem problemFromJson(const JsonNode& root, bool checked) {
  root.expectObject({"format", "dof", "mass_matrix", "levels"}, {"torque_limits", "capsule"});
  if (root.at("format").text() != file_format)
    root.at("format").fail("\"" + root.at("format").text() + "\" is not \"" + file_format + "\"");
  TickProblem problem;
  problem.dof = root.at("dof").integer(1);
  problem.mass_matrix = readMassMatrix(root.at("mass_matrix"), problem.dof, checked);
  if (root.has("torque_limits")) problem.torque_limits = readLimits(root.at("torque_limits"), problem.dof);
  const JsonNode levels = root.at("levels");
  std::set<int> priorities;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    problem.levels.push_back(readLevel(levels.at(i), problem.dof));
    if (!priorities.insert(problem.levels.back().priority).second)
      levels.at(i).at("priority").fail("another level has priority " +
                                       std::to_string(problem.levels.back().priority) + " too");
  }
  std::sort(problem.levels.begin(), problem.levels.end(),
            [](const TickLevel& a, const TickLevel& b) { return a.priority < b.priority; });
  return problem;
}

Json problemToJson(const TickProblem& problem) {
  Json json;
  json["format"] = file_format;
  json["dof"] = problem.dof;
  json["mass_matrix"] = exactMatrix(problem.mass_matrix);
  if (problem.torque_limits) {
    Json& limits = json["torque_limits"];
    limits["lower"] = numbers(problem.torque_limits->lower);
    limits["upper"] = numbers(problem.torque_limits->upper);
    if (problem.torque_limits->priority) limits["priority"] = *problem.torque_limits->priority;
  }
  json["levels"] = Json::array();
  for (const TickLevel& level : problem.levels) {
    Json level_json;
    level_json["priority"] = level.priority;
    if (level.weight) level_json["weight"] = *level.weight;
    level_json["tasks"] = Json::array();
    for (const TickTask& task : level.tasks) {
      Json task_json;
      task_json["name"] = task.name;
      task_json["relation"] = task.relation == control::Relation::equality ? "equality" : "inequality";
      task_json["jacobian"] = exactMatrix(task.J());
      task_json["force"] = exactNumbers(task.F());
      if (task.has_acceleration) task_json["acceleration"] = exactNumbers(task.acceleration.head(task.rows));
      if (task.contact) task_json["contact"] = true;
      if (std::isfinite(task.force_max)) task_json["force_max"] = task.force_max;
      if (task.friction) task_json["friction"] = *task.friction;
      level_json["tasks"].push_back(std::move(task_json));
    }
    json["levels"].push_back(std::move(level_json));
  }
  return json;
}

std::string tickProblemToJson(const TickProblem& problem) { return problemToJson(problem).dump() + "\n"; }

std::string solutionToJson(const TickProblem& problem, const control::TickSolution& solution,
                           const std::string& back_end, double solve_us) {
  Json json;
  json["backend"] = back_end;
  json["status"] = statusName(solution.status);
  if (!solution.message.empty()) json["message"] = solution.message;
  json["torque"] = numbers(solution.torque);
  if (solution.n_contact_forces > 0)
    json["contact_forces"] = numbers(solution.contact_forces.head(solution.n_contact_forces));
  json["scale"] = solution.scale;
  json["levels"] = Json::array();
  for (const control::LevelReport& level : solution.levels) {
    Json active = Json::array();
    for (const control::ActiveRow& row : level.active) {
      Json entry;
      entry["task"] = problem.levels[row.level].tasks[row.task].name;
      entry["row"] = row.row;
      active.push_back(std::move(entry));
    }
    Json report;
    report["priority"] = level.priority;
    report["rank"] = level.rank;
    report["nullity"] = level.nullity;
    report["residual"] = level.residual;
    report["active"] = std::move(active);
    json["levels"].push_back(std::move(report));
  }
  if (solution.has_kkt)
    json["kkt"] = {{"stationarity", solution.kkt.stationarity},
                   {"primal", solution.kkt.primal},
                   {"complementarity", solution.kkt.complementarity}};
  json["iterations"] = solution.iterations;
  json["solve_us"] = solve_us;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tactus::dsl
