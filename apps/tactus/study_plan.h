#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dsl/study.h"

namespace tactus::app {

inline constexpr const char* study_format = "tactus-study/1";

/// What is varied: a parameter of the stack, or "backend".
struct Factor {
  std::string name;
  std::vector<std::string> levels;                                 ///< one at least
};

/// One run: a level of each factor, by its index, and a seed.
struct Trial {
  long number = 0;                                                 ///< counts from 1
  std::vector<size_t> levels;
  std::uint64_t seed = 0;
};

/// The trials of a study in their order, and what is to be made of them: all that its results depend on besides the
/// trials themselves.  Seeds run fastest, then the levels of the last factor, which is always "backend".
struct StudyPlan {
  std::string name;
  bool keeps_runs = true;
  std::vector<Factor> factors;
  std::uint64_t first_seed = 1;
  long seeds = 1;
  std::vector<std::string> metrics;                                ///< none: all
  std::vector<dsl::StudyComparison> comparisons;
  std::map<std::string, std::string> inputs;                       ///< what the trials depend on → hash of its content

  long conditions() const;
  long trials() const { return conditions() * seeds; }
  /// The levels of a condition; conditions count from 0.
  std::vector<size_t> levelsOf(long condition) const;
  long conditionOf(const std::vector<size_t>& levels) const;
  Trial trial(long number) const;
  long conditionOfTrial(long number) const { return (number - 1) / seeds; }
  const std::string& level(const std::vector<size_t>& levels, size_t factor) const {
    return factors[factor].levels[levels[factor]];
  }
  /// "press=0.5, qp": the factors that vary; "all trials" where none does.
  std::string label(const std::vector<size_t>& levels) const;
};

nlohmann::ordered_json toJson(const StudyPlan& plan);
/// Throws FileError for what is no plan.
StudyPlan planFromJson(const std::string& file, const nlohmann::ordered_json& json);

/// What one plan has otherwise than the other, a line each; none: they are the same study.
std::vector<std::string> differencesOf(const StudyPlan& before, const StudyPlan& now);

}  // namespace tactus::app
