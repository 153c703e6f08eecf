// The tick problem file: what is written reads back bit for bit, and each thing that can be wrong is named by its path.
#include "dsl/tick_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "framework/runtime/file_error.h"
#include "tests/plugins/random_problem.h"

namespace tactus::dsl {
namespace {

using control::TickProblem;
using control::TickTask;
using Json = nlohmann::json;

Json small() {
  return Json::parse(R"({
    "format": "tactus-tick/1", "dof": 2, "mass_matrix": [[2, 0.5], [0.5, 1]],
    "torque_limits": {"lower": [-1, null], "upper": [1, 3], "priority": 1},
    "levels": [
      {"priority": 4, "weight": 0.5, "tasks": [
        {"name": "reach", "relation": "equality", "jacobian": [[1, 0], [0, 1]], "force": [1, 2],
         "acceleration": [3, 4]}]},
      {"priority": 1, "tasks": [
        {"name": "touch", "relation": "inequality", "jacobian": [[1, 1]], "force": [0.5],
         "contact": true, "force_max": 2},
        {"name": "grip", "relation": "equality", "jacobian": [[1, 1], [1, 0], [0, 1]], "force": [1, 0, 0],
         "contact": true, "friction": 0.4}]}]})");
}

std::string errorOf(const Json& json) {
  try {
    parseTickProblem(json.dump());
  } catch (const JsonFileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(TickFile, ReadsEveryKeyAndSortsTheLevels) {
  const TickProblem problem = parseTickProblem(small().dump());
  EXPECT_EQ(problem.dof, 2);
  EXPECT_EQ(problem.mass_matrix(0, 1), 0.5);
  ASSERT_TRUE(problem.torque_limits);
  EXPECT_EQ(problem.torque_limits->lower[1], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(problem.torque_limits->upper[1], 3);
  EXPECT_EQ(problem.torque_limits->priority, 1);
  ASSERT_EQ(problem.levels.size(), 2u);
  EXPECT_EQ(problem.levels[0].priority, 1);
  EXPECT_EQ(problem.levels[1].priority, 4);
  EXPECT_EQ(problem.levels[1].weight, 0.5);
  const TickTask& touch = problem.levels[0].tasks[0];
  EXPECT_EQ(touch.name, "touch");
  EXPECT_EQ(touch.relation, control::Relation::inequality);
  EXPECT_TRUE(touch.contact);
  EXPECT_EQ(touch.force_max, 2);
  EXPECT_FALSE(touch.has_acceleration);
  EXPECT_EQ(problem.levels[0].tasks[1].friction, 0.4);
  const TickTask& reach = problem.levels[1].tasks[0];
  EXPECT_EQ(reach.rows, 2);
  EXPECT_TRUE(reach.has_acceleration);
  EXPECT_EQ(reach.acceleration[1], 4);
}

TEST(TickFile, KeepsEveryBit) {
  test::ProblemSource source(21);
  for (int k = 0; k < 30; ++k) {
    TickProblem problem = source.contactProblem({}, 0.3, 0.5);
    problem.levels[0].tasks[0].force_max = source.uniform(1, 2);
    problem.levels[1].weight = source.uniform(0.1, 1);
    if (source.chance(0.5)) problem.torque_limits = source.limits(problem.dof, 1);
    if (problem.torque_limits) problem.torque_limits->upper[0] = std::numeric_limits<double>::infinity();
    const std::string text = tickProblemToJson(problem);
    const TickProblem read = parseTickProblem(text);
    EXPECT_EQ(read.mass_matrix, problem.mass_matrix);
    for (std::size_t i = 0; i < problem.levels.size(); ++i)
      for (std::size_t t = 0; t < problem.levels[i].tasks.size(); ++t) {
        EXPECT_EQ(read.levels[i].tasks[t].jacobian, problem.levels[i].tasks[t].J());
        EXPECT_EQ(read.levels[i].tasks[t].force, problem.levels[i].tasks[t].F());
      }
    EXPECT_EQ(tickProblemToJson(read), text);
  }
}

TEST(TickFile, NamesWhatIsWrongByItsPath) {
  struct Case {
    const char* pointer;                                           // what is replaced
    const char* value;
    const char* message;
  };
  const Case cases[] = {
      {"/format", R"("tactus-tick/2")", R"(format: "tactus-tick/2" is not "tactus-tick/1")"},
      {"/dof", "0", "dof: expected an integer from 1"},
      {"/dof", "2.5", "dof: expected an integer from 1"},
      {"/dof", "\"2\"", "dof: expected a number"},
      {"/dof", "3", "mass_matrix: has 2 rows, expected 3"},
      {"/mass_matrix", "[[1, 0], [0]]", "mass_matrix: row 2 has 1 number, expected 2"},
      {"/mass_matrix", "[[1, 0.2], [0.1, 1]]", "mass_matrix: is not symmetric: row 2, column 1"},
      {"/mass_matrix", "[[1, 2], [2, 1]]", "mass_matrix: is not positive definite"},
      {"/mass_matrix/0/0", "null", "mass_matrix[0][0]: expected a number"},
      {"/torque_limits/lower", "[2, 0]", "torque_limits: lower exceeds upper at joint 1"},
      {"/torque_limits/upper", "[2]", "torque_limits.upper: has 1 number, expected 2"},
      {"/torque_limits/uper", "[2, 3]", "torque_limits: unknown key \"uper\", did you mean \"upper\"?"},
      {"/levels", "{}", "levels: expected an array"},
      {"/levels/0/priority", "1", "levels[1].priority: another level has priority 1 too"},
      {"/levels/0/weight", "0", "levels[0].weight: must be above 0"},
      {"/levels/0/strict", "true", "levels[0]: unknown key \"strict\""},
      {"/levels/0/tasks/0/jacobian/1", "[1, 2, 3]", "levels[0].tasks[0].jacobian: row 2 has 3 numbers, expected 2"},
      {"/levels/0/tasks/0/jacobian", "[[1, 2]]", "levels[0].tasks[0].force: has 2 numbers, expected 1"},
      {"/levels/0/tasks/0/acceleration", "[1]", "levels[0].tasks[0].acceleration: has 1 number, expected 2"},
      {"/levels/0/tasks/0/force/1", "\"x\"", "levels[0].tasks[0].force[1]: expected a number"},
      {"/levels/0/tasks/0/name", "7", "levels[0].tasks[0].name: expected a text"},
      {"/levels/0/tasks/0/relation", "\"equal\"",
       R"(levels[0].tasks[0].relation: "equal" is neither "equality" nor "inequality")"},
      {"/levels/0/tasks/0/force_max", "3", "levels[0].tasks[0].force_max: needs \"contact\": true"},
      {"/levels/1/tasks/0/contact", "1", "levels[1].tasks[0].contact: expected true or false"},
      {"/levels/1/tasks/0/force_max", "-1", "levels[1].tasks[0].force_max: must not be negative"},
      {"/levels/1/tasks/0/friction", "0.3",
       "levels[1].tasks[0].friction: needs rows in threes (normal and two tangents), the task has 1 row"},
  };
  for (const Case& broken : cases) {
    Json json = small();
    json[Json::json_pointer(broken.pointer)] = Json::parse(broken.value);
    EXPECT_EQ(errorOf(json), broken.message);
  }
  for (const char* key : {"format", "dof", "mass_matrix", "levels"}) {
    Json json = small();
    json.erase(key);
    EXPECT_EQ(errorOf(json), "\"" + std::string(key) + "\" is missing");
  }
}

TEST(TickFile, RefusesWhatIsNotItsKindOfJson) {
  const auto error = [](const std::string& text) -> std::string {
    try {
      parseTickProblem(text);
    } catch (const JsonFileError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(error("[]"), "expected an object");
  EXPECT_EQ(error("").find("not JSON: parse error"), 0u);
  EXPECT_EQ(error("{\"format\": \"tactus-tick/1\",}").find("not JSON: parse error at line 1, column"), 0u);
  EXPECT_EQ(error("{\"dof\": 1e999}").find("not JSON: number overflow"), 0u);
  EXPECT_EQ(error("{\"dof\": 2, \"dof\": 3}"), "key \"dof\" is repeated in one object");
  EXPECT_THROW(readTickProblem("/no/such/tick.json"), runtime::FileError);
}

TEST(TickFile, WritesTheSolution) {
  const TickProblem problem = parseTickProblem(small().dump());
  control::TickSolution solution;
  solution.status = control::Status::infeasible;
  solution.message = "no way";
  solution.torque = Eigen::Vector2d(0.1, -2);
  solution.contact_forces = Eigen::Vector4d(1, 2, 3, 4);
  solution.n_contact_forces = 3;
  solution.levels = {{1, 1, 1, 0.25, {{0, 0, 0}}}, {4, 1, 0, 0, {}}};
  solution.has_kkt = true;
  const Json json = Json::parse(solutionToJson(problem, solution, "qp", 12.5));
  EXPECT_EQ(json["backend"], "qp");
  EXPECT_EQ(json["status"], "infeasible");
  EXPECT_EQ(json["message"], "no way");
  EXPECT_EQ(json["torque"], Json::parse("[0.1, -2.0]"));
  EXPECT_EQ(json["contact_forces"], Json::parse("[1.0, 2.0, 3.0]"));
  EXPECT_EQ(json["levels"], Json::parse(R"([
    {"priority": 1, "rank": 1, "nullity": 1, "residual": 0.25, "active": [{"task": "touch", "row": 0}]},
    {"priority": 4, "rank": 1, "nullity": 0, "residual": 0.0, "active": []}])"));
  EXPECT_EQ(json["kkt"]["primal"], 0);
  EXPECT_EQ(json["solve_us"], 12.5);
}

}  // namespace
}  // namespace tactus::dsl
