#include "bench/peers/report.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <map>

namespace tactus::bench {
namespace {

/// printf into a string of at most one line.
[[gnu::format(printf, 1, 2)]] std::string line(const char* format, ...) {
  char text[240];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

bool isMet(const Figure& figure) { return *figure.ratio <= *figure.target; }

std::string verdict(const Figure& figure) {
  if (!figure.target || !figure.ratio) return "";
  return line("<= %.2f %s", *figure.target, isMet(figure) ? "met" : "MISSED");
}

}  // namespace

std::string operationName(Operation operation) {
  switch (operation) {
    case Operation::rnea: return "rnea";
    case Operation::bias: return "bias";
    case Operation::mass_matrix: return "mass matrix";
    case Operation::forward_dynamics: return "forward dynamics";
    case Operation::point_jacobians: return "12 point Jacobians";
    case Operation::tick: return "tick";
    case Operation::cache_tick: return "tick by DynamicsCache";
  }
  return "";
}

std::optional<double> targetRatio(const std::string& model, Operation operation) {
  static const std::map<std::pair<std::string, Operation>, double> targets = {
      {{"lwr_allegro", Operation::rnea}, 0.38},
      {{"lwr_allegro", Operation::mass_matrix}, 0.42},
      {{"lwr_allegro", Operation::forward_dynamics}, 0.63},
      {{"lwr_allegro", Operation::point_jacobians}, 0.47},
      {{"lwr_allegro", Operation::tick}, 0.74},
      {{"humanoid", Operation::rnea}, 0.42},
      {{"humanoid", Operation::mass_matrix}, 0.38},
      {{"humanoid", Operation::forward_dynamics}, 0.65}};
  const auto found = targets.find({model, operation});
  return found == targets.end() ? std::nullopt : std::optional(found->second);
}

std::string disagreement(const Figure& f) {
  if (f.difference <= agreement) return "";
  return line("%s: %s of %s differs from Tactus's by %.1e, more than %.0e: its time means nothing", f.engine.c_str(),
              operationName(f.operation).c_str(), f.model.c_str(), f.difference, agreement);
}

std::string table(const std::vector<Figure>& figures) {
  std::string text, model, operation;
  for (const Figure& f : figures) {
    if (f.model != model) {
      model = f.model;
      operation.clear();
      text += line("\n%-22s %-14s %9s %9s %9s %11s  %s\n", model.c_str(), "engine", "median us", "p99 us", "/ MuJoCo",
                   "difference", "target");
    }
    const bool is_first = operationName(f.operation) != operation;
    operation = operationName(f.operation);
    text += line("%-22s %-14s %9.3f %9.3f %9s %11.1e", is_first ? operation.c_str() : "", f.engine.c_str(),
                 f.timing.median_us, f.timing.p99_us, f.ratio ? line("%.3f", *f.ratio).c_str() : "-", f.difference);
    const std::string target = verdict(f);
    text += target.empty() ? "\n" : "  " + target + "\n";
  }
  return text;
}

std::string growth(const std::vector<Figure>& figures) {
  std::string text;
  for (const Operation operation : {Operation::rnea, Operation::forward_dynamics}) {
    std::map<int, double> medians;                                 // by joints
    for (const Figure& f : figures)
      if (f.engine == "Tactus" && f.operation == operation && f.model.starts_with("chain_"))
        medians[std::stoi(f.model.substr(6))] = f.timing.median_us;
    if (medians.size() < 2) continue;
    text += line("\nGrowth of %s (Tactus), ns a joint:", operationName(operation).c_str());
    for (const auto& [joints, us] : medians) text += line("  %d: %.1f", joints, 1000 * us / joints);
    const auto& [few, short_us] = *medians.begin();
    const auto& [many, long_us] = *medians.rbegin();
    text += line("\n  time ~ joints^%.3f from %d to %d\n",
                 std::log(long_us / short_us) / std::log(static_cast<double>(many) / few), few, many);
  }
  return text;
}

nlohmann::ordered_json toJson(const std::vector<Figure>& figures) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Figure& f : figures) {
    nlohmann::ordered_json one = {{"model", f.model},
                                  {"operation", operationName(f.operation)},
                                  {"engine", f.engine},
                                  {"median_us", f.timing.median_us},
                                  {"p99_us", f.timing.p99_us},
                                  {"samples", f.timing.samples},
                                  {"calls", f.timing.calls},
                                  {"difference", f.difference}};
    if (f.ratio) one["ratio_to_mujoco"] = *f.ratio;
    if (f.target) one["target_ratio"] = *f.target;
    if (f.ratio && f.target) one["met"] = isMet(f);
    all.push_back(one);
  }
  return all;
}

}  // namespace tactus::bench
