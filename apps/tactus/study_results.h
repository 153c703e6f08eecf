#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/tactus/paired_tests.h"
#include "apps/tactus/sample.h"
#include "apps/tactus/study_folder.h"

namespace tactus::app {

/// One figure of one condition.
struct ConditionFigures {
  std::string metric;
  long condition = 0;
  std::vector<double> values;                                      ///< of trials that have it, in the order of seeds
  std::vector<std::uint64_t> seeds;                                ///< of these
  long failed = 0, without = 0, missing = 0;                       ///< trials that failed; never met it; have not run
  SampleFigures figures;
};

/// One figure of a condition against that of its baseline, paired by seed; of all conditions that differ in the factors
/// of `asked.over` together.
struct PairedComparison {
  dsl::StudyComparison asked;
  std::string level;
  std::vector<size_t> levels;                                      ///< of the condition, 0 of factors of asked.over
  long left_out = 0;                                               ///< pairs without a figure on either side
  SampleFigures differences;                                       ///< level − baseline
  StudentTest student;
  WilcoxonTest wilcoxon;
  double student_holm = 0, wilcoxon_holm = 0;                      ///< p over all comparisons of the study
};

/// What a study has found, from its finished trials alone: the same bytes whatever the order in which they ended.
/// Trials that failed count nowhere but in their own column.
struct StudyResults {
  StudyPlan plan;
  std::vector<std::optional<TrialRecord>> trials;                  ///< in their order; nothing where not finished
  std::vector<std::string> metrics;                                ///< of the plan; none there: all that trials have
  std::vector<ConditionFigures> conditions;                        ///< metric by metric
  std::vector<PairedComparison> comparisons;

  long finished() const;
  long failed() const;
  /// Conditions of several trials in which every figure is the same for all seeds: their n counts one run again.
  long withoutScatter() const;
  const ConditionFigures& figures(size_t metric, long condition) const;
};

StudyResults resultsOf(const StudyFolder& folder);
StudyResults resultsOf(const StudyPlan& plan, std::vector<std::optional<TrialRecord>> trials);

/// Tables as arrays of flat objects with the same keys: what has no value is null, as are figures of trials that failed.
nlohmann::ordered_json trialTable(const StudyResults& results);
nlohmann::ordered_json conditionTable(const StudyResults& results);
nlohmann::ordered_json comparisonTable(const StudyResults& results);
/// Such a table as CSV (RFC 4180): a head, numbers that read back to the bit, nothing for null.
std::string csvOf(const nlohmann::ordered_json& table);

/// Figures and comparisons for people.
std::string resultsText(const StudyResults& results);
/// What must not be passed over: failed, missing and equal trials, a sentence each.
std::vector<std::string> remarksOf(const StudyResults& results);

/// Writes trials, summary and comparisons as .csv and .json, METRIC.svg and index.html into the folder.
void writeResults(const std::string& folder, const StudyResults& results);

}  // namespace tactus::app
