#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

namespace tactus::dsl {

/// Rows of numbers, each as long as the first, separated by `row_end`; numbers by blanks or commas.  Empty rows are
/// passed over.  Throws std::runtime_error, with a sentence that names the row, counted from 1, for what is no number,
/// rows of unequal length, and more than a million numbers.
Eigen::MatrixXd parseRows(std::string_view text, char row_end);

}  // namespace tactus::dsl
