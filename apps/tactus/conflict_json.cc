#include "apps/tactus/conflict_json.h"

namespace tactus::app {
namespace {

using control::ConflictGroup;
using nlohmann::ordered_json;
using Kind = ConflictGroup::Kind;

ordered_json jointOf(int joint, const control::ConflictNames& names) {
  const auto i = static_cast<size_t>(joint);
  return i < names.joints.size() ? ordered_json(names.joints[i]) : ordered_json(joint + 1);
}

ordered_json groupToJson(const ConflictGroup& group, const control::TickProblem& problem,
                         const control::ConflictNames& names) {
  if (group.kind == Kind::torque_limit) return {{"what", "torque-limit"}, {"joint", jointOf(group.joint, names)}};
  const control::TickLevel& level = problem.levels[static_cast<size_t>(group.level)];
  const std::string& task = level.tasks[static_cast<size_t>(group.task)].name;
  ordered_json json{{"what", group.kind == Kind::rows ? "rows" : "forces"}, {"task", task}};
  if (const auto place = names.places.find(task); place != names.places.end()) json["place"] = place->second;
  return json;
}

}  // namespace

ordered_json conflictToJson(const control::Conflict& conflict, const control::TickProblem& problem,
                            const control::ConflictNames& names) {
  ordered_json json{{"sentence", control::describe(conflict, problem, names)}};
  json["groups"] = json["relaxations"] = json["beyond"] = ordered_json::array();
  for (const ConflictGroup& group : conflict.groups) json["groups"].push_back(groupToJson(group, problem, names));
  for (const control::Relaxation& relaxation : conflict.relaxations) {
    const Kind kind = relaxation.group.kind;
    ordered_json entry = groupToJson(relaxation.group, problem, names);
    entry["amount"] = relaxation.amount;
    entry["unit"] = kind == Kind::torque_limit ? "N m" : kind == Kind::forces ? "N" : "m/s² or rad/s²";
    if (kind == Kind::torque_limit) entry["upper"] = relaxation.upper;
    entry["enough"] = relaxation.enough;
    json["relaxations"].push_back(std::move(entry));
  }
  for (const control::LimitBeyond& beyond : conflict.beyond)
    json["beyond"].push_back({{"joint", jointOf(beyond.joint, names)}, {"beyond_Nm", beyond.beyond}});
  return json;
}

}  // namespace tactus::app
