#include "apps/tactus/differences.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "apps/tactus/text.h"
#include "framework/control/xray.h"

namespace tactus::app {
namespace {

using control::ActiveRow;
using nlohmann::ordered_json;

constexpr double worth_telling = 1e-6;                             // relative
constexpr double same_error = 1e-3;                                // of two errors, as a share of what is asked
constexpr size_t most_tasks = 3;

BoundsOf boundsOf(const control::TickProblem& problem, const control::TickSolution& solution) {
  BoundsOf bounds;
  for (const control::LevelReport& level : solution.levels)
    bounds.rows.insert(bounds.rows.end(), level.active.begin(), level.active.end());
  for (const control::LimitHit& hit : control::limitsHit(problem, solution.torque)) bounds.joints.push_back(hit.joint);
  return bounds;
}

bool same(const ActiveRow& a, const ActiveRow& b) { return a.level == b.level && a.task == b.task && a.row == b.row; }

/// What `a` has and `b` has not.
BoundsOf without(const BoundsOf& a, const BoundsOf& b) {
  BoundsOf left;
  for (const ActiveRow& row : a.rows)
    if (std::none_of(b.rows.begin(), b.rows.end(), [&](const ActiveRow& other) { return same(row, other); }))
      left.rows.push_back(row);
  for (const int joint : a.joints)
    if (std::find(b.joints.begin(), b.joints.end(), joint) == b.joints.end()) left.joints.push_back(joint);
  return left;
}

const std::string& nameOf(const ActiveRow& row, const control::TickProblem& problem) {
  return problem.levels[static_cast<size_t>(row.level)].tasks[static_cast<size_t>(row.task)].name;
}

/// Tasks of which the two answers miss clearly different shares.
std::vector<TaskDifference> tasksApart(const control::TickProblem& problem, const control::TickSolution& reference,
                                       const control::TickSolution& other) {
  const std::vector<control::TaskError> here = control::taskErrors(problem, other.torque);
  const std::vector<control::TaskError> there = control::taskErrors(problem, reference.torque);
  std::vector<TaskDifference> tasks;
  for (size_t i = 0; i < here.size(); ++i) {
    if (std::abs(here[i].residual - there[i].residual) > same_error * here[i].asked)
      tasks.push_back({here[i].level, here[i].task, here[i].asked, here[i].residual, there[i].residual});
  }
  const auto share = [](const TaskDifference& task) {
    return std::abs(task.here - task.there) / (task.asked + task.here + task.there);
  };
  std::stable_sort(tasks.begin(), tasks.end(),
                   [&](const TaskDifference& a, const TaskDifference& b) { return share(a) > share(b); });
  if (tasks.size() > most_tasks) tasks.resize(most_tasks);
  return tasks;
}

const std::string& nameOf(const TaskDifference& task, const control::TickProblem& problem) {
  return problem.levels[static_cast<size_t>(task.level)].tasks[static_cast<size_t>(task.task)].name;
}

ordered_json tasksToJson(const std::vector<TaskDifference>& tasks, const control::TickProblem& problem) {
  ordered_json json = ordered_json::array();
  for (const TaskDifference& task : tasks)
    json.push_back({{"task", nameOf(task, problem)},
                    {"asked", task.asked},
                    {"missed_here", task.here},
                    {"missed_there", task.there}});
  return json;
}

/// "'sweep' is missed by 2.1 (there 0.3) of 4 asked"
std::string tasksText(const std::vector<TaskDifference>& tasks, const control::TickProblem& problem) {
  std::vector<std::string> parts;
  for (const TaskDifference& task : tasks)
    parts.push_back("'" + nameOf(task, problem) + "' is missed by " + rounded(task.here, 3) + " (there " +
                    rounded(task.there, 3) + ") of " + rounded(task.asked, 3) + " asked");
  return joined(parts);
}

ordered_json rowsToJson(const std::vector<ActiveRow>& rows, const control::TickProblem& problem) {
  ordered_json json = ordered_json::array();
  for (const ActiveRow& row : rows) json.push_back({{"task", nameOf(row, problem)}, {"row", row.row}});
  return json;
}

std::vector<std::string> namesOf(const std::vector<int>& indices, const std::vector<std::string>& joints) {
  std::vector<std::string> names;
  for (const int i : indices) names.push_back(joints[static_cast<size_t>(i)]);
  return names;
}

/// "'limits' row 0, 2" of each task.
std::string rowsText(const std::vector<ActiveRow>& rows, const control::TickProblem& problem) {
  std::string text;
  for (size_t i = 0; i < rows.size(); ++i) {
    const bool same_task = i > 0 && rows[i].level == rows[i - 1].level && rows[i].task == rows[i - 1].task;
    text += same_task ? ", " + std::to_string(rows[i].row)
                      : (i > 0 ? ", '" : "'") + nameOf(rows[i], problem) + "' row " + std::to_string(rows[i].row);
  }
  return text;
}

void addReasons(const BoundsOf& bounds, const control::TickProblem& problem, const std::vector<std::string>& joints,
                const std::string& where, std::vector<std::string>& reasons) {
  if (!bounds.rows.empty()) reasons.push_back("at their bounds " + where + ": " + rowsText(bounds.rows, problem));
  if (!bounds.joints.empty())
    reasons.push_back("at their torque limits " + where + ": " + joined(namesOf(bounds.joints, joints)));
}

}  // namespace

TickDifference differenceOf(const control::TickProblem& problem, const control::TickSolution& reference,
                            const control::TickSolution& other) {
  TickDifference difference;
  difference.both_solved = reference.status == control::Status::ok && other.status == control::Status::ok;
  const BoundsOf here = boundsOf(problem, other), there = boundsOf(problem, reference);
  difference.here = without(here, there);
  difference.there = without(there, here);
  difference.tasks = tasksApart(problem, reference, other);
  const Eigen::LLT<Eigen::MatrixXd> mass(problem.mass_matrix);
  const Eigen::VectorXd apart = mass.matrixL().solve(other.torque - reference.torque);
  const Eigen::VectorXd length = mass.matrixL().solve(reference.torque);
  difference.distance = apart.norm();
  difference.relative = difference.distance == 0 ? 0 : difference.distance / std::max(length.norm(), leastTorque(problem));
  return difference;
}

std::vector<TickDifference> differences(const ProblemSampler& sampler, const Answers& reference, const Answers& other) {
  std::vector<TickDifference> all;
  for (size_t i = 0; i < sampler.problems().size(); ++i) {
    all.push_back(differenceOf(sampler.problems()[i], reference.solutions[i], other.solutions[i]));
    all.back().time = sampler.times()[i];
  }
  return all;
}

ordered_json toJson(const std::vector<TickDifference>& differences, const ProblemSampler& sampler, const Answers& other,
                    const std::vector<std::string>& joints) {
  ordered_json json = ordered_json::array();
  for (size_t i = 0; i < differences.size(); ++i) {
    const TickDifference& difference = differences[i];
    const control::TickProblem& problem = sampler.problems()[i];
    json.push_back({{"time", difference.time},
                    {"both_solved", difference.both_solved},
                    {"distance", difference.distance},
                    {"relative", difference.relative},
                    {"active_here", rowsToJson(difference.here.rows, problem)},
                    {"active_there", rowsToJson(difference.there.rows, problem)},
                    {"limits_here", namesOf(difference.here.joints, joints)},
                    {"limits_there", namesOf(difference.there.joints, joints)},
                    {"tasks", tasksToJson(difference.tasks, problem)},
                    {"solve_us", other.solve_us[i]}});
  }
  return json;
}

std::vector<std::string> largestDifferences(const std::vector<TickDifference>& differences,
                                            const ProblemSampler& sampler, const std::vector<std::string>& joints,
                                            const std::string& reference, size_t most) {
  std::vector<size_t> order;
  for (size_t i = 0; i < differences.size(); ++i)
    if (!(differences[i].relative < worth_telling)) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return differences[a].relative > differences[b].relative; });
  if (order.size() > most) order.resize(most);
  std::vector<std::string> lines;
  for (const size_t i : order) {
    const TickDifference& difference = differences[i];
    std::vector<std::string> reasons;
    if (!difference.both_solved) reasons.push_back("one of them did not solve it");
    addReasons(difference.here, sampler.problems()[i], joints, "here alone", reasons);
    addReasons(difference.there, sampler.problems()[i], joints, "with " + reference + " alone", reasons);
    if (reasons.empty()) reasons.push_back("the same rows and limits hold");
    if (!difference.tasks.empty()) reasons.push_back(tasksText(difference.tasks, sampler.problems()[i]));
    lines.push_back("t = " + rounded(difference.time) + " s, " + rounded(100 * difference.relative, 3) +
                    " % apart: " + joined(reasons, "; "));
  }
  return lines;
}

}  // namespace tactus::app
