#pragma once

#include <string>

namespace tactus::app {

/// Makes report.html, contacts.svg and touched_points.svg in a run folder from what the run wrote.  The report is one
/// file that needs nothing else, with a replay (replay_data.h) where one was recorded.  Of a run that was cut off it
/// shows what there is, and says so.
/// Throws FileError, with the place, for a file that is missing or malformed.
void writeReport(const std::string& folder);

/// Makes beside-<the other's name>.html in the first folder: both runs side by side, on one clock.  Returns its path.
/// Throws FileError.
std::string writeReportOfTwo(const std::string& folder, const std::string& other);

}  // namespace tactus::app
