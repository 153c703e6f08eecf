#include "dsl/capsule.h"

#include <cmath>
#include <limits>

#include "dsl/tick_file.h"
#include "dsl/tick_json.h"
#include "framework/runtime/file_error.h"

namespace tactus::dsl {
namespace {

using control::Status;
using control::TickLevel;
using control::TickProblem;
using control::TickTask;

constexpr int most_rows = 10'000;                                  // of one task; a file must not ask for all memory

Status readStatus(const JsonNode& node) {
  const std::string text = node.text();
  for (const Status status : {Status::ok, Status::infeasible, Status::failed})
    if (text == statusName(status)) return status;
  node.fail("\"" + text + "\" is none of \"ok\", \"infeasible\", \"failed\"");
}

std::map<std::string, std::string> readTexts(const JsonNode& node) {
  std::map<std::string, std::string> texts;
  for (const std::string& key : node.keys()) texts[key] = node.at(key.c_str()).text();
  return texts;
}

control::Deadline readDeadline(const JsonNode& node) {
  node.expectObject({}, {"iterations", "seconds"});
  control::Deadline deadline;
  if (node.has("iterations")) deadline.iterations = node.at("iterations").integer(0, std::numeric_limits<int>::max());
  if (node.has("seconds")) deadline.seconds = node.at("seconds").number();
  return deadline;
}

/// Gives each task the memory that it had in the run: how numbers lie in memory decides how sums are rounded.
void reserveRows(const JsonNode& node, TickProblem& problem) {
  if (node.size() != problem.levels.size())
    node.fail("has " + countOf(node.size(), "level") + ", expected " + std::to_string(problem.levels.size()));
  for (std::size_t i = 0; i < problem.levels.size(); ++i) {
    const JsonNode level = node.at(i);
    std::vector<TickTask>& tasks = problem.levels[i].tasks;
    if (level.size() != tasks.size())
      level.fail("has " + countOf(level.size(), "number") + ", expected " + std::to_string(tasks.size()));
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      TickTask& task = tasks[t];
      const int capacity = level.at(t).integer(task.rows, most_rows);
      const bool asks = task.has_acceleration;
      task.jacobian.conservativeResizeLike(Eigen::MatrixXd::Zero(capacity, problem.dof));
      task.force.conservativeResizeLike(Eigen::VectorXd::Zero(capacity));
      if (!asks) task.acceleration.setZero(task.rows);
      task.acceleration.conservativeResizeLike(Eigen::VectorXd::Zero(capacity));
    }
  }
}

Capsule readCapsule(const JsonNode& node, TickProblem& problem) {
  node.expectObject({"backend", "options", "warm_start", "capacities", "status", "torque", "tick", "time", "q", "qd",
                     "joints", "places", "stack"},
                    {"deadline", "message", "threw", "late", "iterations"});
  const int dof = problem.dof;
  Capsule capsule;
  capsule.back_end = node.at("backend").text();
  capsule.options = readTexts(node.at("options"));
  capsule.warm_start = node.at("warm_start").integers();
  if (node.has("deadline")) capsule.deadline = readDeadline(node.at("deadline"));
  reserveRows(node.at("capacities"), problem);
  capsule.status = readStatus(node.at("status"));
  if (node.has("message")) capsule.message = node.at("message").text();
  if (node.has("threw")) capsule.threw = node.at("threw").flag();
  if (node.has("late")) capsule.late = node.at("late").flag();
  if (node.has("iterations")) capsule.iterations = node.at("iterations").integer(0, std::numeric_limits<int>::max());
  capsule.torque = node.at("torque").vector(dof);
  capsule.tick = node.at("tick").integer(0, std::numeric_limits<int>::max());
  capsule.time = node.at("time").number();
  capsule.q = node.at("q").vector(dof);
  capsule.qd = node.at("qd").vector(dof);
  const JsonNode joints = node.at("joints");
  if (joints.size() != static_cast<std::size_t>(dof))
    joints.fail("has " + countOf(joints.size(), "name") + ", expected " + std::to_string(dof));
  for (std::size_t i = 0; i < joints.size(); ++i) capsule.joints.push_back(joints.at(i).text());
  capsule.places = readTexts(node.at("places"));
  capsule.stack = node.at("stack").text();
  return capsule;
}

Json deadlineToJson(const control::Deadline& deadline) {
  Json json = Json::object();
  if (deadline.iterations < std::numeric_limits<int>::max()) json["iterations"] = deadline.iterations;
  if (std::isfinite(deadline.seconds)) json["seconds"] = deadline.seconds;
  return json;
}

}  // namespace

TickFile readTickFile(const std::string& file) { return parseTickFile(runtime::readFile(file)); }

TickFile parseTickFile(const std::string& text) {
  const Json json = parseJson(text);
  const bool is_capsule = json.is_object() && json.contains("capsule");
  const JsonNode root(json, "", is_capsule);
  TickFile file{problemFromJson(root, !is_capsule), {}};
  if (is_capsule) file.capsule = readCapsule(root.at("capsule"), file.problem);
  return file;
}

std::string capsuleToJson(const TickProblem& problem, const Capsule& capsule) {
  Json capacities = Json::array();
  for (const TickLevel& level : problem.levels) {
    Json& of_level = capacities.emplace_back(Json::array());
    for (const TickTask& task : level.tasks) of_level.push_back(task.capacity());
  }
  Json json{{"backend", capsule.back_end}, {"options", capsule.options}};
  if (Json deadline = deadlineToJson(capsule.deadline); !deadline.empty()) json["deadline"] = std::move(deadline);
  json["warm_start"] = capsule.warm_start;
  json["capacities"] = std::move(capacities);
  json["status"] = statusName(capsule.status);
  if (!capsule.message.empty()) json["message"] = capsule.message;
  if (capsule.threw) json["threw"] = true;
  json["late"] = capsule.late;
  json["iterations"] = capsule.iterations;
  json["torque"] = exactNumbers(capsule.torque);
  json["tick"] = capsule.tick;
  json["time"] = capsule.time;
  json["q"] = exactNumbers(capsule.q);
  json["qd"] = exactNumbers(capsule.qd);
  json["joints"] = capsule.joints;
  json["places"] = capsule.places;
  json["stack"] = capsule.stack;
  Json file = problemToJson(problem);
  file["capsule"] = std::move(json);
  return file.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tactus::dsl
