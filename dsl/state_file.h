#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dsl/json_file_error.h"
#include "framework/control/archive.h"

/// The state file, JSON with "format": "tactus-state/1": all that a run carries from one tick to the next.
///
///   {format, stack, backend, seed, time, robot, joints: [names], links: [names], objects: [names],
///    values: {path: [numbers] | "text", …}}
///
/// A value stands in a line of its own, in the order of the paths, so that two files can be compared by `diff`.  Numbers
/// keep every bit; what is not finite is written "nan", "-nan", "inf" or "-inf".
namespace tactus::dsl {

struct SavedState {
  std::string stack, back_end;
  std::uint64_t seed = 0;
  double time = 0;                                                 ///< s, of the tick that comes next
  std::string robot;
  std::vector<std::string> joints, links, objects;                 ///< whose indices the values hold
  control::State values;
};

std::string stateToJson(const SavedState& saved);
/// Throws runtime::FileError or JsonFileError.
SavedState readState(const std::string& file);
/// Throws JsonFileError.
SavedState parseState(const std::string& text);

}  // namespace tactus::dsl
