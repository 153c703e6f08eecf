#pragma once

#include <string>

#include "apps/tactus/run_record.h"

namespace tactus::app {

/// Writes a run as one MCAP file, for Foxglove and whatever else reads MCAP.  JSON messages, with JSON schemas;
/// times are the run's own, from 0.
///
///     /scene       foxglove.SceneUpdate      once: links in their frames, objects in theirs, or in world where they
///                                            stand still
///     /tf          foxglove.FrameTransforms  every frame of the replay: links and objects that move, by their names,
///                                            in world
///     /contacts    foxglove.SceneUpdate      every frame: an arrow for each force of a link, its tip where it touches
///     /references  foxglove.SceneUpdate      every frame: a ball for each thing that a task steers for
///     /touched     foxglove.PointCloud       all points touched so far (m), where they were touched, with height (mm)
///                                            and force (N), whenever they are a fiftieth more: a jump finds all
///     /level/1, /task/hold, /contact, …      every row of log.csv: its columns, those of a path in one message;
///                                            numbers that are not finite are left out
///
/// The same run gives the same bytes, and nothing of the wall clock is in them.  Of a run that was cut off it holds
/// what there is.  Throws FileError, with the place, for what is malformed or cannot be written; then there is no file.
void exportMcap(const RunRecord& run, const std::string& file);

}  // namespace tactus::app
