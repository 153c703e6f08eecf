#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "apps/tactus/run_record.h"

namespace tactus::app {

/// Of a page, so that it stays below 25 MB whatever the run: numbers in base64, characters.
inline constexpr size_t most_replay_characters = 16'000'000;

/// What the page of a run replays and plots.  Numbers are little-endian float32 in base64, rows one after another.
///
///     title
///     scene: scene.json, or null
///     frames: {columns, data}            of replay.csv
///     contacts: {links, on, data}        rows: frame, index into links, index into on, x, y, z, force_x, force_y, force_z
///     touched: {data}                    rows: time, x, y, z (2 mm out of the surface), height from 0 to 1 of its scale
///     features: [{name, position?, truth?}]
///     plots: [{title, scale?: "log", stepped?, wanted?, series: [{label: "time", data}, {label, data}, …]}]
///     notes: what was left out, a sentence each
///
/// In at most that many characters: where there are more numbers, every k-th frame and touched point, and of every k
/// rows of a plot the largest value.  Throws FileError for a file that is malformed.
nlohmann::ordered_json replayData(const RunRecord& run, const std::string& title, size_t most_characters);

/// scene.json, of which everything is there and of its kind; throws FileError, with the place, where it is not.
nlohmann::ordered_json readScene(const std::string& path);

/// A script element that holds it; nothing in it ends the element.
std::string replayScript(const nlohmann::ordered_json& data);

}  // namespace tactus::app
