#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tactus::dsl {

/// The candidate with the smallest edit distance (insertions, deletions, replacements and swaps of neighbours,
/// each 1; a different case costs nothing), or "" when none is near enough to be what was meant: at most a third
/// of the longer name, and at least 1.  Ties go to the first candidate.
std::string nearestName(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace tactus::dsl
