#pragma once

#include <string>

namespace tactus::app {

/// Makes report.html, contacts.svg and touched_points.svg in a run folder from its run.json, log.csv and
/// touched_points.csv.  The report is one file that needs nothing else: inline SVG, no script.
/// Throws FileError.
void writeReport(const std::string& folder);

}  // namespace tactus::app
