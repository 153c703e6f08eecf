#include "apps/tactus/explain_tick.h"

#include <cmath>
#include <filesystem>
#include <iostream>

#include "apps/tactus/conflict_json.h"
#include "apps/tactus/interrupt.h"
#include "apps/tactus/progress.h"
#include "apps/tactus/run_folder.h"
#include "framework/runtime/temporary_folder.h"
#include "apps/tactus/text.h"
#include "apps/tactus/xray_view.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// The stack that a run folder holds, as it ran: back end, seed and parameters are written in it.
StackOptions stackOf(const std::string& folder, const StackOptions& asked) {
  if (!asked.back_end.empty() || asked.seed || !asked.set.empty())
    throw UsageError(
        "a run folder says its back end, seed and parameters itself; leave out --backend, --seed and --set");
  const std::string file = folder + "/run.json";
  const ordered_json json = readJson(file);
  if (JsonPlace(file, json).at("format").text("") != run_format)
    throw runtime::FileError(file, std::string("is not of the format ") + run_format);
  StackOptions options;
  options.file = folder + "/stack.resolved.xml";
  return options;
}

/// Where a log that begins otherwise than the other first differs; "" when it begins with all of it.
std::string firstDifference(const std::string& logged, const std::string& again) {
  const std::vector<std::string> a = split(logged, '\n'), b = split(again, '\n');
  const std::vector<std::string> columns = split(a.front(), ',');
  if (a.front().empty()) return "the log is empty";
  for (size_t row = 0; row < b.size(); ++row) {
    if (b[row].empty()) continue;
    if (row >= a.size() || a[row].empty()) return "the log ends after " + std::to_string(row - 1) + " rows";
    if (a[row] == b[row]) continue;
    if (row == 0) return "the log has other columns";
    const std::vector<std::string> old_values = split(a[row], ','), new_values = split(b[row], ',');
    for (size_t i = 0; i < std::min(old_values.size(), new_values.size()); ++i)
      if (old_values[i] != new_values[i])
        return "at t = " + new_values.front() + " s " + (i < columns.size() ? columns[i] : "a column") + " was " +
               old_values[i] + " and is " + new_values[i];
    return "row " + std::to_string(row) + " has another length";
  }
  return "";
}

/// A run that went on from a state does so again.
void goOnFrom(const std::string& file, Session& session) {
  try {
    session.restore(dsl::readState(file));
  } catch (const dsl::JsonFileError& error) {
    throw runtime::FileError(file, error.what());
  } catch (const control::StateError& error) {
    throw runtime::FileError(file, error.what());
  }
}

/// The tick that is held from `at` on; the end of the run is its last tick.
long tickAt(double at, const dsl::Stack& stack, double period) {
  const long ticks = std::lround(stack.run.duration / period);
  const long tick = static_cast<long>(std::floor(at / period + 1e-6));
  if (tick > ticks)
    throw UsageError("--at " + rounded(at) + " is after the end of the run, " + rounded(stack.run.duration) + " s");
  return std::min(tick, ticks - 1);
}

}  // namespace

int explainTick(const ExplainTickArguments& arguments, bool json) {
  const bool of_run = fs::is_directory(arguments.stack.file);
  Program program(arguments.plugins);
  dsl::Stack stack = readAloud(program, of_run ? stackOf(arguments.stack.file, arguments.stack) : arguments.stack);
  const double period = 1 / stack.controller.values.real("rate");
  const long tick = tickAt(arguments.at, stack, period);
  stack.run.duration = static_cast<double>(tick + 1) * period;

  const Interrupt interrupt;
  Session session(std::move(stack), program.registry());
  const std::string from = arguments.stack.file + "/" + from_file;
  if (of_run && fs::exists(from)) goOnFrom(from, session);
  if (tick < session.tick())
    throw UsageError("--at " + rounded(arguments.at) + " is before the run, which goes on from " + timeText(session.time()) + " s");
  const runtime::TemporaryFolder again;
  const auto recorder = session.recordInto(again.path);
  runtime::LoopResult result;
  {
    Progress progress(session.stack().run.duration);
    result = session.run({recorder.get(), &progress}, interrupt.stop());
  }
  if (result.ending == runtime::Ending::interrupted) throw Interrupted();
  if (result.error) std::rethrow_exception(result.error);
  recorder->close();

  const control::Controller& controller = session.controller();
  const double time = static_cast<double>(tick) * period;
  ordered_json data = xrayToJson({time, "", controller.problem(), controller.solution()}, session);
  std::string conflict;
  if (controller.solution().status == control::Status::infeasible) {
    const control::ConflictNames names{controller.model().jointNames(), session.taskPlaces()};
    const control::Conflict found = control::findConflict(controller.problem());
    conflict = control::describe(found, controller.problem(), names);
    data["conflict"] = conflictToJson(found, controller.problem(), names);
  }
  int code = exit_done;
  if (of_run) {
    const std::string log = arguments.stack.file + "/log.csv";
    const std::string difference = firstDifference(runtime::readFile(log), runtime::readFile(again.path + "/log.csv"));
    data["log"] = {{"met", difference.empty()}};
    if (!difference.empty()) {
      data["log"]["difference"] = difference;
      code = exit_mismatch;
    }
    std::cerr << "tactus explain: " << (difference.empty() ? "the run repeats: its log is met to the byte"
                                                           : "the run does not repeat: " + difference) << "\n";
  }
  if (json) {
    std::cout << jsonText(data, 2) << "\n";
  } else {
    std::cout << session.stack().name << " with " << session.backEndName() << " at t = " << rounded(time, 6) << " s\n"
              << xrayText({"x-ray", data}) << (conflict.empty() ? "" : conflict + "\n");
  }
  return code;
}

}  // namespace tactus::app
