#include "apps/tactus/study_plan.h"

#include <cmath>

#include "apps/tactus/json_place.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

/// A whole number from `least` on.
long wholeNumber(const JsonPlace& place, const std::string& file, const char* what, double least) {
  const double number = place.number().value_or(NAN);
  if (!(number >= least && number <= 2147483647 && number == std::floor(number)))
    throw runtime::FileError(file, std::string("'") + what + "' is not a whole number that a study can have");
  return static_cast<long>(number);
}

}  // namespace

long StudyPlan::conditions() const {
  long count = 1;
  for (const Factor& factor : factors) count *= static_cast<long>(factor.levels.size());
  return count;
}

std::vector<size_t> StudyPlan::levelsOf(long condition) const {
  std::vector<size_t> levels(factors.size());
  for (size_t i = factors.size(); i-- > 0;) {
    const auto count = static_cast<long>(factors[i].levels.size());
    levels[i] = static_cast<size_t>(condition % count);
    condition /= count;
  }
  return levels;
}

long StudyPlan::conditionOf(const std::vector<size_t>& levels) const {
  long condition = 0;
  for (size_t i = 0; i < factors.size(); ++i)
    condition = condition * static_cast<long>(factors[i].levels.size()) + static_cast<long>(levels[i]);
  return condition;
}

Trial StudyPlan::trial(long number) const {
  return {number, levelsOf(conditionOfTrial(number)), first_seed + static_cast<std::uint64_t>((number - 1) % seeds)};
}

std::string StudyPlan::label(const std::vector<size_t>& levels) const {
  std::string text;
  for (size_t i = 0; i < factors.size(); ++i) {
    if (factors[i].levels.size() < 2) continue;
    text += text.empty() ? "" : ", ";
    if (factors[i].name != "backend") text += factors[i].name + "=";
    text += level(levels, i);
  }
  return text.empty() ? "all trials" : text;
}

ordered_json toJson(const StudyPlan& plan) {
  ordered_json factors = ordered_json::array(), comparisons = ordered_json::array();
  for (const Factor& factor : plan.factors) factors.push_back({{"name", factor.name}, {"levels", factor.levels}});
  for (const dsl::StudyComparison& one : plan.comparisons)
    comparisons.push_back({{"metric", one.metric}, {"by", one.by}, {"baseline", one.baseline}, {"over", one.over}});
  return {{"format", study_format},
          {"study", plan.name},
          {"keep", plan.keeps_runs ? "runs" : "metrics"},
          {"factors", factors},
          {"seeds", {{"from", plan.first_seed}, {"count", plan.seeds}}},
          {"metrics", plan.metrics},
          {"compare", comparisons},
          {"inputs", plan.inputs}};
}

StudyPlan planFromJson(const std::string& file, const ordered_json& json) {
  const JsonPlace root(file, json);
  if (root.at("format").text() != study_format)
    throw runtime::FileError(file, "is not of format " + std::string(study_format));
  StudyPlan plan;
  plan.name = root.at("study").text();
  plan.keeps_runs = root.at("keep").text() == "runs";
  for (const JsonPlace& factor : root.at("factors").items()) {
    plan.factors.push_back({factor.at("name").text(), {}});
    for (const JsonPlace& level : factor.at("levels").items()) plan.factors.back().levels.push_back(level.text());
    if (plan.factors.back().levels.empty()) throw runtime::FileError(file, "a factor has no level");
  }
  plan.first_seed = static_cast<std::uint64_t>(wholeNumber(root.at("seeds").at("from"), file, "from", 0));
  plan.seeds = wholeNumber(root.at("seeds").at("count"), file, "count", 1);
  for (const JsonPlace& metric : root.at("metrics").items()) plan.metrics.push_back(metric.text());
  for (const JsonPlace& one : root.at("compare").items()) {
    dsl::StudyComparison comparison{one.at("metric").text(), one.at("by").text(), one.at("baseline").text(), {}};
    for (const JsonPlace& factor : one.at("over").items()) comparison.over.push_back(factor.text());
    plan.comparisons.push_back(std::move(comparison));
  }
  for (const auto& [what, hash] : root.at("inputs").members()) plan.inputs[what] = hash.text();
  return plan;
}

std::vector<std::string> differencesOf(const StudyPlan& before, const StudyPlan& now) {
  std::vector<std::string> differences;
  for (const auto& [what, hash] : now.inputs) {
    const auto old = before.inputs.find(what);
    if (old == before.inputs.end()) differences.push_back(what + " is new");
    else if (old->second != hash) differences.push_back(what + " has changed");
  }
  for (const auto& [what, hash] : before.inputs)
    if (!now.inputs.count(what)) differences.push_back(what + " is gone");
  ordered_json was = toJson(before), is = toJson(now);
  for (const auto& [key, value] : is.items())
    if (key != "inputs" && was[key] != value) differences.push_back("its " + key + " is another");
  return differences;
}

}  // namespace tactus::app
