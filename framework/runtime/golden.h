#pragma once

#include <string>
#include <vector>

#include "framework/runtime/csv_table.h"

namespace tactus::runtime {

/// How far a column may be from the golden one: |actual − expected| ≤ atol + rtol·|expected|.
struct Tolerance {
  std::string columns;                                             ///< glob with '*' and '?'; '*' crosses '/'
  double atol = 0;
  double rtol = 0;
};

/// Does `text` match the glob `pattern`?
bool matchesGlob(std::string_view pattern, std::string_view text);

struct ColumnFailure {
  std::string column;
  double worst_ratio = 0;                                          ///< error over tolerance; NaN against a number: ∞
  // Where the column first left its tolerance:
  size_t row = 0;
  double time = 0;                                                 ///< s
  double expected = 0;
  double actual = 0;
};

struct GoldenComparison {
  std::vector<std::string> missing;                                ///< columns of the golden log alone
  std::vector<std::string> extra;                                  ///< columns of the new log alone
  size_t expected_rows = 0;
  size_t actual_rows = 0;
  std::vector<ColumnFailure> failures;                             ///< earliest first, then in column order

  bool passed() const {
    return missing.empty() && extra.empty() && expected_rows == actual_rows && failures.empty();
  }
  /// What failed, for people: every failing column and, first of all, what diverged first: time, column, task.
  std::string text() const;
};

/// The task that a column belongs to: NAME of task/NAME/…, else "".
std::string taskOfColumn(std::string_view column);

/// Compares two logs column by column.  The last tolerance that matches a column counts; without any, exact
/// equality.  NaN equals NaN alone.  Both need a `time` column; throws FileError for cells that are not numbers.
GoldenComparison compareGolden(const CsvTable& expected, const CsvTable& actual,
                               const std::vector<Tolerance>& tolerances);

}  // namespace tactus::runtime
