#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tactus::runtime {

/// A file of comma-separated values with one line of column names.  A last line without its line end is left out:
/// a killed run may have broken it off.
class CsvTable {
 public:
  /// Throws FileError when the file cannot be read, has no header, or a row has another number of cells.
  static CsvTable read(const std::string& path);

  const std::string& path() const { return path_; }
  bool endsWithinLine() const { return ends_within_line_; }        ///< a line was left out
  const std::vector<std::string>& columns() const { return columns_; }
  size_t rows() const { return cells_.size(); }
  int column(std::string_view name) const;                         ///< -1 when there is none
  const std::string& cell(size_t row, int column) const { return cells_[row][static_cast<size_t>(column)]; }
  /// Throws FileError, with row and column, for a cell that is not a number.
  std::vector<double> numbers(int column) const;
  /// Throws FileError when there is no such column, too.
  std::vector<double> numbers(std::string_view column) const;

 private:
  std::string path_;
  bool ends_within_line_ = false;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace tactus::runtime
