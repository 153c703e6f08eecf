#include "apps/tactus/run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <filesystem>

#include "apps/tactus/capsule_keeper.h"
#include "apps/tactus/json_place.h"
#include "apps/tactus/state_keeper.h"
#include "apps/tactus/targets.h"
#include "apps/tactus/text.h"
#include "apps/tactus/versions.h"
#include "apps/tactus/xray_view.h"
#include "framework/control/element_values.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/percentile.h"

namespace tactus::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

const char* statusText(runtime::Ending ending) {
  switch (ending) {
    case runtime::Ending::done: return "done";
    case runtime::Ending::interrupted: return "interrupted";
    case runtime::Ending::plant_error: return "plant-error";
    case runtime::Ending::tick_error: return "tick-error";
    case runtime::Ending::part_error: return "part-error";
    case runtime::Ending::file_error: return "file-error";
  }
  return "";
}

bool isRunFolder(const fs::path& folder) {
  const fs::path file = folder / "run.json";
  if (!fs::exists(file)) return false;
  const ordered_json json = ordered_json::parse(runtime::readFile(file.string()), nullptr, false);
  return json.is_object() && json.contains("format") && json["format"] == run_format;
}

ordered_json vectorToJson(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

ordered_json describeFeatures(const Session& session) {
  ordered_json features = ordered_json::array();
  for (const SoughtFeature& feature : session.features()) {
    ordered_json json{{"name", feature.name}, {"found", feature.estimate->found}, {"points", feature.estimate->points}};
    if (feature.estimate->found) {
      json["position_W"] = vectorToJson(feature.estimate->position_W);
      json["height_m"] = feature.estimate->height;
    }
    if (feature.truth_W) json["truth_W"] = vectorToJson(*feature.truth_W);
    features.push_back(std::move(json));
  }
  return features;
}

/// A fault that begins where the run ends in its time never struck.
ordered_json describeFaults(const Session& session, const runtime::LoopResult& result) {
  ordered_json faults = ordered_json::array();
  const bool in_time = result.ending == runtime::Ending::done || result.ending == runtime::Ending::interrupted;
  const double end = in_time ? session.time() - 1e-6 * session.controller().period() : INFINITY;
  const auto timeOf = [&](double time) {
    return time < end ? ordered_json(std::round(time * 1e9) / 1e9) : ordered_json();
  };
  for (const control::FaultRecord* fault : session.faults())
    faults.push_back({{"name", fault->name},
                      {"kind", fault->kind},
                      {"began_s", timeOf(fault->began)},
                      {"ended_s", timeOf(fault->ended)}});
  return faults;
}

ordered_json describeTargets(const dsl::Stack& stack) {
  ordered_json json = ordered_json::object();
  for (const dsl::TargetDescription& target : stack.run.targets) {
    json[target.metric] = toJson(Target{target.lower, target.upper});
  }
  return json;
}

/// A line of those counts that are not 0; "" when all are.
std::string unusualTicks(const ordered_json& ticks) {
  constexpr std::pair<const char*, const char*> kinds[] = {{"rate_limited", "kept at the torque rate"},
                                                           {"late", "past the deadline"},
                                                           {"partial", "with the upper levels alone"},
                                                           {"held", "with the last solved torque"},
                                                           {"gravity", "that bore the weight alone"},
                                                           {"blind", "without a joint's position"}};
  std::string text;
  for (const auto& [key, said] : kinds) {
    const long count = ticks.value(key, 0L);
    if (count > 0) text += (text.empty() ? "ticks " : ", ") + std::string(said) + ": " + std::to_string(count);
  }
  return text.empty() ? text : text + "\n";
}

}  // namespace

void writeJson(const std::string& path, const ordered_json& json) { runtime::writeWhole(path, jsonText(json, 2) + "\n"); }

std::string defaultRunFolder(const dsl::Stack& stack, const std::string& back_end_label) {
  std::string label = back_end_label;
  for (char& c : label) {
    if (c == '/' || c == '=') c = '-';
  }
  return "runs/" + stack.name + "-" + label + "-seed" + std::to_string(stack.run.seed);
}

FolderClaim::FolderClaim(const std::string& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  // A file system without locks lets every run pass.
  if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(descriptor_);
    throw runtime::FileError(folder, "another run is writing into it; wait for its end, or give another folder with --out");
  }
}

FolderClaim::~FolderClaim() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

FolderClaim claimRunFolder(const std::string& folder, const Session& session) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw runtime::FileError(folder, "cannot be made a folder: " + error.message());
  if (!fs::is_directory(folder)) throw runtime::FileError(folder, "is not a folder");
  if (!fs::is_empty(folder) && !isRunFolder(folder)) {
    throw runtime::FileError(folder, "holds files that are not of a run; give an empty or a new folder with --out");
  }
  FolderClaim claim(folder);
  for (const char* made : {"report.html", "contacts.svg", "touched_points.svg", "scene.json", "log.csv", "timing.csv",
                           "touched_points.csv", "replay.csv", "replay_contacts.csv", xray_file, from_file})
    fs::remove(fs::path(folder) / made);
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (CapsuleKeeper::isCapsule(name) || StateKeeper::isState(name) || name.ends_with(runtime::unfinished_suffix))
      old.push_back(entry.path());
  }
  for (const fs::path& file : old) fs::remove(file);
  writeJson(folder + "/run.json", describeStart(session, status_running));
  return claim;
}

ordered_json describeStart(const Session& session, const std::string& status) {
  ordered_json options = ordered_json::object();
  for (const auto& [name, value] : session.stack().back_end.all()) options[name] = value.text;
  return {{"format", run_format},
          {"stack", session.stack().name},
          {"file", session.stack().file},
          {"backend", session.backEndName()},
          {"backend_options", options},
          {"seed", session.stack().run.seed},
          {"status", status}};
}

ordered_json describeRun(const Session& session, const runtime::LoopResult& result) {
  const runtime::RunStatistics& statistics = session.statistics();
  const std::vector<double>& times = statistics.tickTimes();
  const std::vector<control::Metric> metrics = session.metrics();

  ordered_json json = describeStart(session, statusText(result.ending));
  if (!result.message.empty()) json["message"] = result.message;
  json["warnings"] = session.warnings();
  json["duration_s"] = result.simulated;
  json["wall_clock_s"] = result.wall_clock;
  json["realtime_factor"] = result.realtimeFactor();
  json["tick_us"] = {{"median", runtime::percentile(times, 0.5)},
                     {"p99", runtime::percentile(times, 0.99)},
                     {"p999", runtime::percentile(times, 0.999)}};
  json["ticks"] = {{"total", result.ticks},
                   {"fallback", statistics.fallbacks},
                   {"infeasible", statistics.infeasible},
                   {"limited", statistics.limited},
                   {"rate_limited", statistics.rate_limited},
                   {"late", statistics.late},
                   {"partial", statistics.partial},
                   {"held", statistics.held},
                   {"gravity", statistics.gravity},
                   {"blind", statistics.blind},
                   {"lost_rank", statistics.lost_rank}};
  if (statistics.has_kkt) {
    json["kkt_max"] = {{"stationarity", statistics.kkt_max.stationarity},
                       {"primal", statistics.kkt_max.primal},
                       {"complementarity", statistics.kkt_max.complementarity}};
  }
  json["faults"] = describeFaults(session, result);
  json["metrics"] = ordered_json::object();
  for (const control::Metric& metric : metrics) json["metrics"][metric.name] = metric.value;
  json["wanted"] = describeTargets(session.stack());
  if (session.wantedForce()) json["wanted_force_N"] = *session.wantedForce();
  json["features"] = describeFeatures(session);
  json["versions"] = versions();
  return json;
}

std::vector<std::string> faultNotes(const ordered_json& run) {
  const auto at = [](const ordered_json& time) { return "t = " + control::formatNumber(time.get<double>()) + " s"; };
  std::vector<std::string> notes;
  for (const ordered_json& fault : run["faults"]) {
    const ordered_json &began = fault["began_s"], &ended = fault["ended_s"];
    notes.push_back("fault '" + fault["name"].get<std::string>() + "' (" + fault["kind"].get<std::string>() + ") " +
                    (began.is_null()   ? "never struck: its time is not that of a tick of this run"
                     : ended.is_null() ? "struck from " + at(began) + " to the end"
                                       : "struck from " + at(began) + " until " + at(ended)));
  }
  return notes;
}

std::string summaryTable(const ordered_json& run) {
  const auto number = [](const ordered_json& value) { return value.is_null() ? "–" : rounded(value.get<double>()); };
  std::string text = run["stack"].get<std::string>() + " with " + run["backend"].get<std::string>() + ", seed " +
                     std::to_string(run["seed"].get<std::uint64_t>()) + ": " + run["status"].get<std::string>() + "\n";
  text += number(run["duration_s"]) + " s simulated in " + number(run["wall_clock_s"]) + " s, " +
          rounded(run["realtime_factor"].get<double>(), 3) + " × real time; tick " + number(run["tick_us"]["median"]) +
          " µs median, " + number(run["tick_us"]["p99"]) + " µs p99, " + number(run["tick_us"]["p999"]) + " µs p99.9\n";
  text += "ticks: " + std::to_string(run["ticks"]["total"].get<long>());
  for (const char* kind : {"fallback", "infeasible", "limited"}) {
    text += std::string(", ") + kind + " " + std::to_string(run["ticks"][kind].get<long>());
  }
  text += "\n";
  text += unusualTicks(run["ticks"]);
  if (run.contains("kkt_max")) {
    text += "largest KKT residual: stationarity " + rounded(run["kkt_max"]["stationarity"].get<double>(), 3) +
            ", primal " + rounded(run["kkt_max"]["primal"].get<double>(), 3) + "\n";
  }
  if (const long fallbacks = run["ticks"]["fallback"].get<long>(); fallbacks > 0) {
    text += "warning: " + std::to_string(fallbacks) + " ticks fell back, so these figures are not the stack's\n";
  }
  const JsonPlace place("run.json", run);
  const JsonPlace wanted = place.at("wanted");
  std::vector<std::vector<std::string>> rows{{"metric", "value"}};
  if (!wanted.members().empty()) rows.front().insert(rows.front().end(), {"wanted", ""});
  for (const auto& [name, value] : place.at("metrics").members()) {
    std::vector<std::string> row{name, rounded(value.number().value_or(NAN))};
    if (wanted.at(name).exists()) {
      const Target target = targetFromJson(wanted.at(name));
      row.push_back(target.text());
      row.push_back(target.metBy(value.number().value_or(NAN)) ? "met" : "missed");
    }
    rows.push_back(std::move(row));
  }
  return text + textTable(rows);
}

}  // namespace tactus::app
