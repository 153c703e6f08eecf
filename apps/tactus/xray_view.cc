#include "apps/tactus/xray_view.h"

#include <algorithm>
#include <cmath>

#include "apps/tactus/text.h"
#include "dsl/tick_file.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

constexpr double least_part = 0.1;                                 // of a direction, that a joint is named for
constexpr size_t most_joints = 4;                                  // named in a sentence
constexpr size_t most_directions = 3;                              // told of one task

control::XrayOptions optionsOf(const Session& session) {
  control::XrayOptions options;
  const control::ElementValues& values = session.stack().back_end;
  const auto read = [&](const char* name, double& into) {
    if (values.row().attribute(name) && values.has(name)) into = values.real(name);
  };
  read("rank-tolerance", options.rank.rank_tolerance);
  read("fade", options.rank.fade);
  return options;
}

ordered_json numbers(const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); }

/// The joints with the largest parts of a direction, largest first.
ordered_json partsOf(const Eigen::VectorXd& direction, const std::vector<std::string>& names) {
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < direction.size(); ++i)
    if (std::abs(direction[i]) >= least_part) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  ordered_json parts = ordered_json::object();
  for (const Eigen::Index i : order) parts[names[static_cast<size_t>(i)]] = direction[i];
  return parts;
}

ordered_json lostToJson(const control::LostDirection& lost, const control::TickProblem& problem,
                        const std::vector<std::string>& joints) {
  ordered_json takers = ordered_json::array();
  for (const control::Taker& taker : lost.takers) {
    const control::TickLevel& level = problem.levels[static_cast<size_t>(taker.level)];
    takers.push_back({{"task", level.tasks[static_cast<size_t>(taker.task)].name}, {"share", taker.share}});
  }
  return {{"share", lost.share},
          {"rows", numbers(lost.rows)},
          {"joints", partsOf(lost.joints, joints)},
          {"takers", takers}};
}

ordered_json taskToJson(const control::TaskXray& task, const control::TickProblem& problem, const Session& session) {
  const control::TickLevel& level = problem.levels[static_cast<size_t>(task.level)];
  const std::string& name = level.tasks[static_cast<size_t>(task.task)].name;
  ordered_json lost = ordered_json::array(), faded = ordered_json::array();
  for (const control::LostDirection& direction : task.lost)
    lost.push_back(lostToJson(direction, problem, session.controller().model().jointNames()));
  for (const control::FadedDirection& direction : task.faded)
    faded.push_back({{"sigma", direction.sigma}, {"weight", direction.weight}});
  ordered_json json{{"level", level.priority},
                    {"name", name},
                    {"place", session.taskPlaces()[name]},
                    {"rows", task.rows},
                    {"wanted", task.wanted},
                    {"granted", task.granted},
                    {"lost", lost},
                    {"faded", faded},
                    {"active", task.active},
                    {"asked", task.asked},
                    {"residual", task.residual},
                    {"torque", numbers(task.torque)}};
  if (task.torque_left) json["torque_left"] = numbers(*task.torque_left);
  return json;
}

double number(const JsonPlace& place) { return place.number().value_or(NAN); }
std::string whole(const JsonPlace& place) { return rounded(number(place), 10); }

double norm(const JsonPlace& vector) {
  double sum = 0;
  for (const JsonPlace& value : vector.items()) sum += number(value) * number(value);
  return std::sqrt(sum);
}

std::string percent(double share) { return rounded(100 * share, 3) + " %"; }

/// "hold 2, limits 0.75": how many directions each higher task takes.
std::string takersText(const JsonPlace& task) {
  std::vector<std::pair<std::string, double>> sums;
  for (const JsonPlace& lost : task.at("lost").items()) {
    for (const JsonPlace& taker : lost.at("takers").items()) {
      const std::string name = taker.at("task").text();
      auto known = std::find_if(sums.begin(), sums.end(), [&](const auto& sum) { return sum.first == name; });
      if (known == sums.end()) known = sums.insert(sums.end(), {name, 0});
      known->second += number(taker.at("share"));
    }
  }
  std::stable_sort(sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> parts;
  for (const auto& [name, sum] : sums) parts.push_back(name + " " + rounded(sum, 2));
  return joined(parts);
}

/// "+a1 −a3", or for three rows of a task "(0.71, 0, -0.71)" too.
std::string directionText(const JsonPlace& lost) {
  std::vector<std::string> joints;
  for (const auto& [joint, part] : lost.at("joints").members()) {
    if (joints.size() == most_joints) break;
    joints.push_back((number(part) < 0 ? "−" : "+") + joint);
  }
  std::string text = joined(joints, " ");
  if (const std::vector<JsonPlace> rows = lost.at("rows").items(); rows.size() == 3) {
    std::vector<std::string> parts;
    for (const JsonPlace& row : rows) parts.push_back(rounded(std::abs(number(row)) < 5e-3 ? 0 : number(row), 2));
    text = "(" + joined(parts) + "), joints " + text;
  }
  return text;
}

void addLost(const JsonPlace& task, std::vector<std::string>& sentences) {
  const std::vector<JsonPlace> directions = task.at("lost").items();
  const std::string name = "'" + task.at("name").text() + "'";
  for (size_t i = 0; i < directions.size(); ++i) {
    if (i == most_directions) {
      const std::string more = std::to_string(directions.size() - i);
      sentences.push_back(name + " loses " + more + " more directions in part or whole");
      return;
    }
    std::vector<std::string> takers;
    for (const JsonPlace& taker : directions[i].at("takers").items())
      takers.push_back("'" + taker.at("task").text() + "' (" + percent(number(taker.at("share"))) + ")");
    sentences.push_back(name + " loses " + percent(number(directions[i].at("share"))) + " of " +
                        directionText(directions[i]) + (takers.empty() ? "" : " to " + joined(takers)));
  }
}

}  // namespace

ordered_json xrayToJson(const XrayedTick& tick, const Session& session) {
  const control::XrayOptions options = optionsOf(session);
  const control::Xray xray = control::xray(tick.problem, tick.solution, options);
  const std::vector<std::string>& joints = session.controller().model().jointNames();
  ordered_json json{{"time", tick.time}};
  if (!tick.why.empty()) json["why"] = tick.why;
  json["backend"] = session.backEndName();
  json["options"] = ordered_json::object();
  for (const auto& [name, value] : session.stack().back_end.all()) json["options"][name] = value.text;
  json["status"] = dsl::statusName(tick.solution.status);
  if (!tick.solution.message.empty()) json["message"] = tick.solution.message;
  json["rank_tolerance"] = options.rank.rank_tolerance;
  json["fade"] = options.rank.fade;
  json["scale"] = xray.scale;
  json["joints"] = joints;
  json["levels"] = json["tasks"] = json["limits"] = ordered_json::array();
  for (const control::LevelXray& level : xray.levels)
    json["levels"].push_back({{"priority", level.priority},
                              {"wanted", level.wanted},
                              {"granted", level.granted},
                              {"freedom_left", level.freedom_left}});
  for (const control::TaskXray& task : xray.tasks) json["tasks"].push_back(taskToJson(task, tick.problem, session));
  for (const control::LimitHit& limit : xray.limits)
    json["limits"].push_back({{"joint", joints[static_cast<size_t>(limit.joint)]},
                              {"side", limit.upper ? "upper" : "lower"},
                              {"limit_Nm", limit.limit}});
  return json;
}

std::vector<std::vector<std::string>> xrayRows(const JsonPlace& xray) {
  std::vector<std::vector<std::string>> table{{"level, task", "rows", "wanted", "granted", "freedom left", "taken by",
                                               "active", "asked", "missed by", "torque (N m)", "left of it (N m)"}};
  for (const JsonPlace& level : xray.at("levels").items()) {
    table.push_back({"level " + whole(level.at("priority")), "", whole(level.at("wanted")), whole(level.at("granted")),
                     whole(level.at("freedom_left"))});
    for (const JsonPlace& task : xray.at("tasks").items()) {
      if (number(task.at("level")) != number(level.at("priority"))) continue;
      const size_t active = task.at("active").items().size();
      table.push_back({"  " + task.at("name").text(), whole(task.at("rows")), whole(task.at("wanted")),
                       whole(task.at("granted")), "", takersText(task), active > 0 ? std::to_string(active) : "",
                       rounded(number(task.at("asked")), 3), rounded(number(task.at("residual")), 3),
                       rounded(norm(task.at("torque")), 3),
                       task.at("torque_left").exists() ? rounded(norm(task.at("torque_left")), 3) : "–"});
    }
  }
  return table;
}

std::vector<std::string> xraySentences(const JsonPlace& xray) {
  std::vector<std::string> sentences;
  if (xray.at("message").exists()) sentences.push_back(xray.at("status").text() + ": " + xray.at("message").text());
  if (xray.at("levels").items().empty()) sentences.push_back("the tick holds numbers that cannot be worked with");
  for (const JsonPlace& task : xray.at("tasks").items()) {
    addLost(task, sentences);
    for (const JsonPlace& faded : task.at("faded").items())
      sentences.push_back("'" + task.at("name").text() + "' has a faded direction: σ = " +
                          rounded(number(faded.at("sigma")), 3) + " is held by " + percent(number(faded.at("weight"))) +
                          " (rank-tolerance " + rounded(number(xray.at("rank_tolerance"))) + ", fade " +
                          rounded(number(xray.at("fade"))) + ")");
    if (const auto rows = task.at("active").items(); !rows.empty()) {
      std::vector<std::string> numbers;
      for (const JsonPlace& row : rows) numbers.push_back(whole(row));
      sentences.push_back("'" + task.at("name").text() + "' is at its bound in row " + joined(numbers) +
                          " (counted from 0)");
    }
  }
  for (const JsonPlace& limit : xray.at("limits").items())
    sentences.push_back("joint " + limit.at("joint").text() + " is at its " + limit.at("side").text() +
                        " torque limit, " + rounded(number(limit.at("limit_Nm"))) + " N m after gravity and motion");
  if (number(xray.at("scale")) < 1)
    sentences.push_back("the torque was scaled by " + rounded(number(xray.at("scale"))) + " into its limits");
  std::vector<std::string> options;
  for (const auto& [name, value] : xray.at("options").members()) options.push_back(name + " " + value.text());
  sentences.push_back("options of " + xray.at("backend").text() + ": " + joined(options));
  return sentences;
}

std::string xrayText(const JsonPlace& xray) {
  std::string text = textTable(xrayRows(xray));
  for (const std::string& sentence : xraySentences(xray)) text += sentence + "\n";
  return text;
}

void XrayKeeper::observe(const control::ObservedTick& tick) {
  if (tick.controller.record().sensing.blind) return;              // there was no problem
  const control::TickProblem& problem = tick.controller.problem();
  const control::TickSolution& solution = tick.controller.solution();
  last_time_ = tick.sensed.time;
  int loss = 0;
  for (const control::TickLevel& level : problem.levels)
    for (const control::TickTask& task : level.tasks)
      if (task.relation == control::Relation::equality) loss += task.rows;
  for (const control::LevelReport& level : solution.levels) loss -= level.rank;
  worst_is_last_ = loss > largest_loss_;
  if (!worst_is_last_) return;
  largest_loss_ = loss;
  worst_ = {tick.sensed.time, "largest loss of rank", problem, solution};
}

ordered_json XrayKeeper::describe(bool threw) const {
  ordered_json json{{"format", xray_format}, {"xrays", ordered_json::array()}};
  if (largest_loss_ < 0) return json;
  if (!worst_is_last_ || threw) json["xrays"].push_back(xrayToJson(worst_, session_));
  if (threw) return json;
  json["xrays"].push_back(xrayToJson(
      {last_time_, "last tick", session_.controller().problem(), session_.controller().solution()}, session_));
  return json;
}

}  // namespace tactus::app
