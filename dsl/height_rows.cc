#include "dsl/height_rows.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace tactus::dsl {
namespace {

constexpr std::size_t most_numbers = 1'000'000;
constexpr std::string_view gaps = " \t\r\n,";

/// Appends the numbers of a row and returns how many there are.
std::size_t parseRow(std::string_view row, std::size_t line, std::vector<double>& numbers) {
  std::size_t count = 0;
  for (std::size_t at = row.find_first_not_of(gaps); at != std::string_view::npos; ++count) {
    const std::size_t end = std::min(row.find_first_of(gaps, at), row.size());
    double number = 0;
    const auto result = std::from_chars(row.data() + at, row.data() + end, number);
    if (result.ec != std::errc() || result.ptr != row.data() + end || !std::isfinite(number))
      throw std::runtime_error("row " + std::to_string(line) + ": what stands at place " + std::to_string(count + 1) +
                               " is not a finite number");
    numbers.push_back(number);
    at = row.find_first_not_of(gaps, end);
  }
  return count;
}

}  // namespace

Eigen::MatrixXd parseRows(std::string_view text, char row_end) {
  std::vector<double> numbers;
  std::size_t columns = 0, rows = 0, line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(row_end, begin), text.size());
    const std::size_t count = parseRow(text.substr(begin, end - begin), ++line, numbers);
    begin = end + 1;
    if (count == 0) continue;
    if (columns == 0) columns = count;
    if (count != columns)
      throw std::runtime_error("row " + std::to_string(line) + " has " + std::to_string(count) +
                               (count == 1 ? " number" : " numbers") + ", those before it " + std::to_string(columns));
    if (numbers.size() > most_numbers) throw std::runtime_error("there are more than a million numbers");
    ++rows;
  }
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(numbers.data(), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
}

}  // namespace tactus::dsl
