#pragma once

#include <string>
#include <vector>

#include "framework/runtime/golden.h"

namespace tactus::app {

/// Reads tolerances.xml: <tolerances> with any number of <tolerance columns="GLOB" atol="…" rtol="…"/>, the last
/// match of a column counts.  Throws FileError with the line of what is wrong.
std::vector<runtime::Tolerance> readTolerances(const std::string& path);

/// What a new golden case starts with.
std::string defaultTolerances();

}  // namespace tactus::app
