#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::app {

/// "a, b, c"
std::string joined(const std::vector<std::string>& words, const std::string& separator = ", ");

/// The parts of `text` between separators, empty ones kept.
std::vector<std::string> split(std::string_view text, char separator);

/// Finite numbers separated by commas or blanks; `what` names them in the UsageError.
std::vector<double> parseNumbers(const std::string& text, const std::string& what);

/// "1 number", "2 numbers".
std::string counted(size_t count, const std::string& one, const std::string& many);

/// `value` with `digits` significant digits, never in another locale; "–" for NaN.
std::string rounded(double value, int digits = 4);

/// A simulated time to the nanosecond, without the rounding of sums: "0.35".
std::string timeText(double seconds);

/// Of a duration: "0:07", "2:05", "1:02:05".
std::string clockText(double seconds);

/// Characters of UTF-8 text.
size_t width(std::string_view text);

/// A table with aligned columns: the first to the left, all others to the right; the first row is the head.
std::string textTable(const std::vector<std::vector<std::string>>& rows);

/// RFC 4648, with its padding.
std::string base64(std::string_view bytes);

/// The document, whatever bytes its texts hold: what is not UTF-8 becomes U+FFFD.  Without indent in one line.
std::string jsonText(const nlohmann::ordered_json& json, int indent = -1);

}  // namespace tactus::app
