#include "apps/tactus/study_results.h"

#include <algorithm>
#include <cmath>

#include "apps/tactus/run_folder.h"
#include "apps/tactus/study_page.h"
#include "apps/tactus/text.h"
#include "framework/control/element_values.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

double figureOf(const TrialRecord& record, const std::string& metric) {
  for (const auto& [name, value] : record.metrics)
    if (name == metric) return value;
  return NAN;
}

/// In the order in which trials bring them.
std::vector<std::string> metricsOf(const std::vector<std::optional<TrialRecord>>& trials) {
  std::vector<std::string> names;
  for (const auto& record : trials)
    if (record)
      for (const auto& [name, value] : record->metrics)
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

ConditionFigures figuresOfCondition(const StudyResults& results, const std::string& metric, long condition) {
  ConditionFigures found{metric, condition, {}, {}, 0, 0, 0, {}};
  for (long i = condition * results.plan.seeds; i < (condition + 1) * results.plan.seeds; ++i) {
    const auto& record = results.trials[static_cast<size_t>(i)];
    const double value = record && !record->failed() ? figureOf(*record, metric) : NAN;
    if (!record) ++found.missing;
    else if (record->failed()) ++found.failed;
    else if (!std::isfinite(value)) ++found.without;
    if (!std::isfinite(value)) continue;
    found.values.push_back(value);
    found.seeds.push_back(record->trial.seed);
  }
  found.figures = figuresOf(found.values);
  return found;
}

/// Whether pairs of that factor's levels count together.
bool isPooled(const StudyPlan& plan, const dsl::StudyComparison& asked, size_t factor) {
  return std::find(asked.over.begin(), asked.over.end(), plan.factors[factor].name) != asked.over.end();
}

void addDifferences(const ConditionFigures& here, const ConditionFigures& there, std::vector<double>& differences) {
  for (size_t i = 0; i < here.seeds.size(); ++i) {
    const auto same = std::find(there.seeds.begin(), there.seeds.end(), here.seeds[i]);
    if (same != there.seeds.end())
      differences.push_back(here.values[i] - there.values[static_cast<size_t>(same - there.seeds.begin())]);
  }
}

PairedComparison compare(const StudyResults& results, const dsl::StudyComparison& asked, size_t metric, size_t factor,
                         const std::vector<size_t>& levels, size_t baseline) {
  const StudyPlan& plan = results.plan;
  PairedComparison found{asked, plan.level(levels, factor), levels, 0, {}, {}, {}, 0, 0};
  std::vector<double> differences;
  for (long condition = 0; condition < plan.conditions(); ++condition) {
    std::vector<size_t> here = plan.levelsOf(condition);
    bool counts = true;
    for (size_t f = 0; f < here.size(); ++f) counts = counts && (here[f] == levels[f] || isPooled(plan, asked, f));
    if (!counts) continue;
    here[factor] = baseline;
    addDifferences(results.figures(metric, condition), results.figures(metric, plan.conditionOf(here)), differences);
    found.left_out += plan.seeds;
  }
  found.left_out -= static_cast<long>(differences.size());
  found.differences = figuresOf(differences);
  found.student = studentTest(differences);
  found.wilcoxon = wilcoxonTest(differences);
  return found;
}

template <class Container, class Value>
size_t indexOf(const Container& container, const Value& value) {
  return static_cast<size_t>(std::find(container.begin(), container.end(), value) - container.begin());
}

void addComparisons(const dsl::StudyComparison& asked, StudyResults& results) {
  const StudyPlan& plan = results.plan;
  const size_t metric = indexOf(results.metrics, asked.metric);
  const auto by = std::find_if(plan.factors.begin(), plan.factors.end(),
                               [&](const Factor& factor) { return factor.name == asked.by; });
  if (metric == results.metrics.size() || by == plan.factors.end()) return;
  const auto factor = static_cast<size_t>(by - plan.factors.begin());
  const size_t baseline = indexOf(by->levels, asked.baseline);
  for (long condition = 0; condition < plan.conditions(); ++condition) {
    const std::vector<size_t> levels = plan.levelsOf(condition);
    bool first = true;
    for (size_t f = 0; f < levels.size(); ++f) first = first && (levels[f] == 0 || !isPooled(plan, asked, f));
    if (first && levels[factor] != baseline)
      results.comparisons.push_back(compare(results, asked, metric, factor, levels, baseline));
  }
}

void correct(std::vector<PairedComparison>& comparisons) {
  std::vector<double> student, wilcoxon;
  for (const PairedComparison& one : comparisons) {
    student.push_back(one.student.p);
    wilcoxon.push_back(one.wilcoxon.p);
  }
  student = holm(student);
  wilcoxon = holm(wilcoxon);
  for (size_t i = 0; i < comparisons.size(); ++i) {
    comparisons[i].student_holm = student[i];
    comparisons[i].wilcoxon_holm = wilcoxon[i];
  }
}

/// JSON has no number for what is none.
ordered_json number(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(); }

/// The condition that a comparison is within: the factors that both sides share.
std::string placeOf(const StudyPlan& plan, const PairedComparison& one) {
  std::string text;
  for (size_t i = 0; i < plan.factors.size(); ++i)
    if (plan.factors[i].name != one.asked.by && plan.factors[i].levels.size() > 1 && !isPooled(plan, one.asked, i))
      text += (text.empty() ? "" : ", ") + (plan.factors[i].name == "backend" ? "" : plan.factors[i].name + "=") +
              plan.level(one.levels, i);
  return text;
}

std::string cell(const ordered_json& value) {
  if (value.is_null()) return "";
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_integer()) return value.dump();
  if (value.is_number()) return control::formatNumber(value.get<double>());
  const std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

long StudyResults::finished() const {
  return std::count_if(trials.begin(), trials.end(), [](const auto& record) { return record.has_value(); });
}

long StudyResults::failed() const {
  return std::count_if(trials.begin(), trials.end(), [](const auto& record) { return record && record->failed(); });
}

long StudyResults::withoutScatter() const {
  long count = 0;
  for (long condition = 0; condition < plan.conditions(); ++condition) {
    bool several = false, same = true;
    for (size_t metric = 0; metric < metrics.size(); ++metric) {
      const SampleFigures& sample = figures(metric, condition).figures;
      several = several || sample.n > 1;
      same = same && (sample.n == 0 || sample.minimum == sample.maximum);
    }
    count += several && same;
  }
  return count;
}

const ConditionFigures& StudyResults::figures(size_t metric, long condition) const {
  return conditions[metric * static_cast<size_t>(plan.conditions()) + static_cast<size_t>(condition)];
}

StudyResults resultsOf(const StudyFolder& folder) {
  std::vector<std::optional<TrialRecord>> trials;
  for (long number = 1; number <= folder.plan().trials(); ++number) trials.push_back(folder.record(number));
  return resultsOf(folder.plan(), std::move(trials));
}

StudyResults resultsOf(const StudyPlan& plan, std::vector<std::optional<TrialRecord>> trials) {
  StudyResults results{plan, std::move(trials), {}, {}, {}};
  results.metrics = plan.metrics.empty() ? metricsOf(results.trials) : plan.metrics;
  for (const std::string& metric : results.metrics)
    for (long condition = 0; condition < plan.conditions(); ++condition)
      results.conditions.push_back(figuresOfCondition(results, metric, condition));
  for (const dsl::StudyComparison& asked : plan.comparisons) addComparisons(asked, results);
  correct(results.comparisons);
  return results;
}

ordered_json trialTable(const StudyResults& results) {
  ordered_json table = ordered_json::array();
  for (size_t i = 0; i < results.trials.size(); ++i) {
    const Trial trial = results.plan.trial(static_cast<long>(i) + 1);
    const auto& record = results.trials[i];
    ordered_json row{{"trial", trial.number}};
    for (size_t f = 0; f < results.plan.factors.size(); ++f)
      row[results.plan.factors[f].name] = results.plan.level(trial.levels, f);
    row["seed"] = trial.seed;
    row["status"] = record ? record->status : "missing";
    row["exit_code"] = record && record->end.signal == 0 ? ordered_json(record->end.exit_code) : ordered_json();
    row["fallback_ticks"] = record ? ordered_json(record->fallback_ticks) : ordered_json();
    for (const std::string& metric : results.metrics)
      row[metric] = record && !record->failed() ? number(figureOf(*record, metric)) : ordered_json();
    table.push_back(std::move(row));
  }
  return table;
}

ordered_json conditionTable(const StudyResults& results) {
  ordered_json table = ordered_json::array();
  for (const ConditionFigures& one : results.conditions) {
    ordered_json row{{"metric", one.metric}};
    const std::vector<size_t> levels = results.plan.levelsOf(one.condition);
    for (size_t f = 0; f < results.plan.factors.size(); ++f)
      row[results.plan.factors[f].name] = results.plan.level(levels, f);
    row["n"] = one.figures.n;
    row["failed"] = one.failed;
    row["without"] = one.without;
    row["missing"] = one.missing;
    row["mean"] = number(one.figures.mean);
    row["sd"] = number(one.figures.sd);
    row["min"] = number(one.figures.minimum);
    row["lower_quartile"] = number(one.figures.lower_quartile);
    row["median"] = number(one.figures.median);
    row["upper_quartile"] = number(one.figures.upper_quartile);
    row["max"] = number(one.figures.maximum);
    table.push_back(std::move(row));
  }
  return table;
}

ordered_json comparisonTable(const StudyResults& results) {
  ordered_json table = ordered_json::array();
  for (const PairedComparison& one : results.comparisons) {
    ordered_json row{{"metric", one.asked.metric},
                     {"by", one.asked.by},
                     {"level", one.level},
                     {"baseline", one.asked.baseline}};
    for (size_t f = 0; f < results.plan.factors.size(); ++f) {
      const std::string& name = results.plan.factors[f].name;
      row["at_" + name] = name == one.asked.by || isPooled(results.plan, one.asked, f) ? ordered_json() : ordered_json(results.plan.level(one.levels, f));
    }
    row["pairs"] = one.differences.n;
    row["left_out"] = one.left_out;
    row["mean_difference"] = number(one.differences.mean);
    row["sd_difference"] = number(one.differences.sd);
    row["ci95_lower"] = number(one.student.lower);
    row["ci95_upper"] = number(one.student.upper);
    row["t"] = number(one.student.t);
    row["degrees"] = number(one.student.degrees);
    row["t_p"] = number(one.student.p);
    row["t_p_holm"] = number(one.student_holm);
    row["d_z"] = number(one.student.effect);
    row["wilcoxon_n"] = one.wilcoxon.n;
    row["wilcoxon_w"] = one.wilcoxon.n > 0 ? ordered_json(one.wilcoxon.positive) : ordered_json();
    row["wilcoxon_exact"] = one.wilcoxon.exact;
    row["wilcoxon_p"] = number(one.wilcoxon.p);
    row["wilcoxon_p_holm"] = number(one.wilcoxon_holm);
    table.push_back(std::move(row));
  }
  return table;
}

std::string csvOf(const ordered_json& table) {
  std::string text;
  const auto line = [&](const ordered_json& row, bool head) {
    bool first = true;
    for (const auto& [key, value] : row.items()) {
      text += (first ? "" : ",") + cell(head ? ordered_json(key) : value);
      first = false;
    }
    text += "\n";
  };
  if (!table.empty()) line(table.front(), true);
  for (const ordered_json& row : table) line(row, false);
  return text;
}

std::vector<std::string> remarksOf(const StudyResults& results) {
  std::vector<std::string> remarks;
  const long all = results.plan.trials(), finished = results.finished(), failed = results.failed();
  const std::string of_all = " of " + std::to_string(all) + " trials ";
  if (finished < all) remarks.push_back(std::to_string(all - finished) + of_all + "have not run");
  if (failed > 0) remarks.push_back(std::to_string(failed) + of_all + "failed; no figure counts them");
  for (const auto& record : results.trials)
    if (record && record->failed())
      remarks.push_back("trial " + std::to_string(record->trial.number) + " (" +
                        results.plan.label(record->trial.levels) + ", seed " + std::to_string(record->trial.seed) + "): " + record->status +
                        (record->message.empty() ? "" : ": " + record->message));
  long fallen = 0;
  for (const auto& record : results.trials) fallen += record && !record->failed() && record->fallback_ticks > 0;
  if (fallen > 0)
    remarks.push_back("in " + std::to_string(fallen) + " trials ticks fell back: their figures are not the stack's alone");
  if (const long equal = results.withoutScatter(); equal > 0)
    remarks.push_back("the seed changes nothing in " + std::to_string(equal) + " of " +
                      std::to_string(results.plan.conditions()) +
                      " conditions: their trials are one run again and again");
  return remarks;
}

std::string resultsText(const StudyResults& results) {
  std::string text = results.plan.name + ": " + std::to_string(results.finished()) + " of " +
                     std::to_string(results.plan.trials()) + " trials, " + std::to_string(results.failed()) +
                     " failed\n";
  for (const std::string& metric : results.metrics) {
    std::vector<std::vector<std::string>> rows{{metric, "n", "mean", "sd", "median", "min", "max"}};
    for (const ConditionFigures& one : results.conditions) {
      if (one.metric != metric) continue;
      std::vector<std::string> row{"  " + results.plan.label(results.plan.levelsOf(one.condition)),
                                   std::to_string(one.figures.n)};
      const SampleFigures& sample = one.figures;
      for (const double value : {sample.mean, sample.sd, sample.median, sample.minimum, sample.maximum})
        row.push_back(rounded(value));
      rows.push_back(std::move(row));
    }
    text += "\n" + textTable(rows);
  }
  if (results.comparisons.empty()) return text;
  std::vector<std::vector<std::string>> rows{{"paired by seed", "pairs", "difference", "95 % interval", "t", "p",
                                              "p Holm", "d_z", "Wilcoxon p", "p Holm"}};
  for (const PairedComparison& one : results.comparisons) {
    const std::string within = placeOf(results.plan, one);
    const StudentTest& student = one.student;
    rows.push_back({one.asked.metric + ": " + one.level + " − " + one.asked.baseline +
                        (within.empty() ? "" : ", " + within),
                    std::to_string(one.differences.n), rounded(one.differences.mean, 3),
                    std::isnan(student.p) ? "–" : rounded(student.lower, 3) + " … " + rounded(student.upper, 3),
                    rounded(one.student.t, 3), rounded(one.student.p, 3), rounded(one.student_holm, 3),
                    rounded(one.student.effect, 3), rounded(one.wilcoxon.p, 3), rounded(one.wilcoxon_holm, 3)});
  }
  return text + "\n" + textTable(rows);
}

void writeResults(const std::string& folder, const StudyResults& results) {
  const std::pair<const char*, ordered_json> tables[] = {{"trials", trialTable(results)},
                                                         {"summary", conditionTable(results)},
                                                         {"comparisons", comparisonTable(results)}};
  for (const auto& [name, table] : tables) {
    runtime::writeWhole(folder + "/" + name + ".csv", csvOf(table));
    writeJson(folder + "/" + name + ".json", table);
  }
  for (size_t i = 0; i < results.metrics.size(); ++i)
    runtime::writeWhole(folder + "/" + plotFile(results.metrics[i]), boxPlotOf(results, i));
  runtime::writeWhole(folder + "/index.html", studyPage(results));
}

}  // namespace tactus::app
