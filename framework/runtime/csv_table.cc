#include "framework/runtime/csv_table.h"

#include <algorithm>
#include <charconv>

#include "framework/runtime/file_error.h"

namespace tactus::runtime {
namespace {

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const size_t comma = line.find(',');
    cells.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

CsvTable CsvTable::read(const std::string& path) {
  CsvTable table;
  table.path_ = path;
  const std::string content = readFile(path);
  std::string_view rest = content;
  for (size_t end; (end = rest.find('\n')) != std::string_view::npos; rest.remove_prefix(end + 1)) {
    std::vector<std::string> cells = split(rest.substr(0, end));
    if (table.columns_.empty()) {
      table.columns_ = std::move(cells);
    } else if (cells.size() == table.columns_.size()) {
      table.cells_.push_back(std::move(cells));
    } else {
      throw FileError(path, "row " + std::to_string(table.rows() + 1) + " has " + std::to_string(cells.size()) +
                                " cells, but there are " + std::to_string(table.columns_.size()) + " columns");
    }
  }
  table.ends_within_line_ = !rest.empty();
  if (table.columns_.empty()) throw FileError(path, "is empty; expected a line of column names");
  return table;
}

int CsvTable::column(std::string_view name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  return found == columns_.end() ? -1 : static_cast<int>(found - columns_.begin());
}

std::vector<double> CsvTable::numbers(int column) const {
  std::vector<double> values(rows());
  for (size_t row = 0; row < rows(); ++row) {
    const std::string& text = cell(row, column);
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, values[row]);
    if (error != std::errc() || end != last) {
      throw FileError(path_, "row " + std::to_string(row + 1) + ", column " + columns_[static_cast<size_t>(column)] +
                                 ": '" + text + "' is not a number");
    }
  }
  return values;
}

std::vector<double> CsvTable::numbers(std::string_view name) const {
  const int found = column(name);
  if (found < 0) throw FileError(path_, "has no column '" + std::string(name) + "'");
  return numbers(found);
}

}  // namespace tactus::runtime
