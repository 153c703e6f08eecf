#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/tactus/session.h"

namespace tactus::app {

inline constexpr const char* run_format = "tactus-run/1";
inline constexpr const char* from_file = "from.json";             ///< the state that the run went on from
inline constexpr const char* status_running = "running";         ///< until the run ends; for ever when it is killed

/// runs/<stack>-<back end>-seed<N>
std::string defaultRunFolder(const dsl::Stack& stack, const std::string& back_end_label);

/// While it lives no other run can write into the folder.
class FolderClaim {
 public:
  /// Throws FileError where another run has it.
  explicit FolderClaim(const std::string& folder);
  ~FolderClaim();
  FolderClaim(FolderClaim&& other) : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FolderClaim& operator=(FolderClaim&&) = delete;

 private:
  int descriptor_;
};

/// Makes the folder ready for a run: a new or empty one, or that of an earlier run, whose tables, pictures, capsules
/// and states are taken away.  Leaves a run.json that says "running".  Throws FileError for a folder that holds anything else.
FolderClaim claimRunFolder(const std::string& folder, const Session& session);


/// What run.json holds after a run; a figure that was never met is null.
nlohmann::ordered_json describeRun(const Session& session, const runtime::LoopResult& result);

/// Back end, seed, file: what is known before the run.
nlohmann::ordered_json describeStart(const Session& session, const std::string& status);

/// A line for every fault of what describeRun holds: when it struck.
std::vector<std::string> faultNotes(const nlohmann::ordered_json& run);

/// What describeRun holds, as a table for people.
std::string summaryTable(const nlohmann::ordered_json& run);

/// Writes JSON with a final line end, all of it or nothing; throws FileError.
void writeJson(const std::string& path, const nlohmann::ordered_json& json);

}  // namespace tactus::app
