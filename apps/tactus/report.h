#pragma once

#include <string>

namespace tactus::app {

/// Makes report.html, contacts.svg and touched_points.svg in a run folder from its run.json, log.csv and
/// touched_points.csv.  The report is one file that needs nothing else: inline SVG, no script.  Of a run that was cut
/// off it shows what there is, and says so.
/// Throws FileError, with the place, for a file that is missing or malformed.
void writeReport(const std::string& folder);

}  // namespace tactus::app
