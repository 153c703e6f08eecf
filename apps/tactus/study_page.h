#pragma once

#include <string>

#include "apps/tactus/study_results.h"

namespace tactus::app {

/// "contact_force_mean_N.svg"; what a file name cannot hold becomes '-'.
std::string plotFile(const std::string& metric);

/// A box for each condition, with every trial as a point: an SVG document.
std::string boxPlotOf(const StudyResults& results, size_t metric);

/// The whole study as one HTML page.
std::string studyPage(const StudyResults& results);

}  // namespace tactus::app
