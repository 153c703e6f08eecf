#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// A comparison of back ends, as `tactus compare --json` prints it, for people: as text, and as a page with curves.
namespace tactus::app {

/// The table, and below it where each back end is furthest from the reference, and why.
std::string comparisonText(const nlohmann::ordered_json& comparison);

/// The same in one self-contained page, with differences, bounds, times and contacts over the run.
std::string comparisonPage(const nlohmann::ordered_json& comparison);

/// What stands in the page's file while the comparison goes on.
std::string unfinishedPage();

}  // namespace tactus::app
