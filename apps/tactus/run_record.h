#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/tactus/json_place.h"
#include "framework/runtime/csv_table.h"

namespace tactus::app {

/// What a run wrote as it went.  A table that is not there is empty: of one that was cut off any, and of every run
/// those of the replay.
struct RunRecord {
  std::string folder;
  std::string file;                                                ///< run.json
  nlohmann::ordered_json json;
  bool cut_off = false;                                            ///< killed, or still going
  runtime::CsvTable log, touched, frames, contacts;                ///< frames and contacts of the replay
  std::vector<std::string> warnings;                               ///< of tables that end within a line

  JsonPlace run() const { return {file, json}; }
};

/// Throws FileError, with the place, for a file that is missing or malformed.
RunRecord readRunRecord(const std::string& folder);

/// An empty table where there is no such file.
runtime::CsvTable readIfThere(const std::string& path);

}  // namespace tactus::app
