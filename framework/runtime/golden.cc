#include "framework/runtime/golden.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "framework/runtime/file_error.h"

namespace tactus::runtime {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string number(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

/// Three significant digits, for people.
std::string rounded(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 3).ptr};
}

/// Error over tolerance: ≤ 1 passes.
double errorRatio(double expected, double actual, const Tolerance& tolerance) {
  if (expected == actual || (std::isnan(expected) && std::isnan(actual))) return 0;
  const double error = std::abs(actual - expected);
  if (!std::isfinite(error)) return infinity;
  const double allowed = tolerance.atol + tolerance.rtol * std::abs(expected);
  return allowed > 0 ? error / allowed : infinity;
}

Tolerance toleranceOf(const std::string& column, const std::vector<Tolerance>& tolerances) {
  const auto last = std::find_if(tolerances.rbegin(), tolerances.rend(),
                                 [&](const Tolerance& rule) { return matchesGlob(rule.columns, column); });
  return last == tolerances.rend() ? Tolerance{} : *last;
}

std::optional<ColumnFailure> compareColumn(const std::string& column, const CsvTable& expected, const CsvTable& actual,
                                           const std::vector<double>& time, const Tolerance& tolerance) {
  const std::vector<double> wanted = expected.numbers(expected.column(column));
  const std::vector<double> given = actual.numbers(actual.column(column));
  std::optional<ColumnFailure> failure;
  for (size_t row = 0; row < std::min(wanted.size(), given.size()); ++row) {
    const double ratio = errorRatio(wanted[row], given[row], tolerance);
    if (ratio <= 1) continue;
    if (!failure) failure = ColumnFailure{column, ratio, row, time[row], wanted[row], given[row]};
    failure->worst_ratio = std::max(failure->worst_ratio, ratio);
  }
  return failure;
}

std::string describe(const ColumnFailure& failure) {
  const std::string task = taskOfColumn(failure.column);
  return failure.column + (task.empty() ? "" : " (task '" + task + "')") + " at time " + number(failure.time) +
         " s: expected " + number(failure.expected) + ", got " + number(failure.actual);
}

}  // namespace

bool matchesGlob(std::string_view pattern, std::string_view text) {
  // Greedy matching with one point to come back to: the last star.
  size_t p = 0, t = 0;
  size_t star = std::string_view::npos, star_text = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      star_text = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++star_text;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

std::string taskOfColumn(std::string_view column) {
  constexpr std::string_view prefix = "task/";
  if (!column.starts_with(prefix)) return "";
  column.remove_prefix(prefix.size());
  return std::string(column.substr(0, column.find('/')));
}

GoldenComparison compareGolden(const CsvTable& expected, const CsvTable& actual,
                               const std::vector<Tolerance>& tolerances) {
  for (const CsvTable* table : {&expected, &actual}) {
    if (table->column("time") < 0) throw FileError(table->path(), "has no column 'time'");
  }
  GoldenComparison result;
  result.expected_rows = expected.rows();
  result.actual_rows = actual.rows();
  const std::vector<double> time = expected.numbers(expected.column("time"));
  for (const std::string& column : actual.columns()) {
    if (expected.column(column) < 0) result.extra.push_back(column);
  }
  for (const std::string& column : expected.columns()) {
    if (actual.column(column) < 0) {
      result.missing.push_back(column);
      continue;
    }
    const auto failure = compareColumn(column, expected, actual, time, toleranceOf(column, tolerances));
    if (failure) result.failures.push_back(*failure);
  }
  std::stable_sort(result.failures.begin(), result.failures.end(),
                   [](const ColumnFailure& a, const ColumnFailure& b) { return a.row < b.row; });
  return result;
}

std::string GoldenComparison::text() const {
  std::string text;
  if (!failures.empty()) {
    text += "first divergence: " + describe(failures.front()) + "\n";
    const auto of_task = std::find_if(failures.begin(), failures.end(), [](const ColumnFailure& failure) {
      return !taskOfColumn(failure.column).empty();
    });
    if (of_task != failures.end() && of_task != failures.begin()) {
      text += "first task to diverge: " + describe(*of_task) + "\n";
    }
  }
  if (expected_rows != actual_rows) {
    text += "rows: expected " + std::to_string(expected_rows) + ", got " + std::to_string(actual_rows) + "\n";
  }
  for (const std::string& column : missing) text += "missing column: " + column + "\n";
  for (const std::string& column : extra) text += "extra column: " + column + "\n";
  for (const ColumnFailure& failure : failures) {
    text += "  " + failure.column + ": worst error is " + rounded(failure.worst_ratio) +
            " × its tolerance, first at time " + number(failure.time) + " s\n";
  }
  return text;
}

}  // namespace tactus::runtime
