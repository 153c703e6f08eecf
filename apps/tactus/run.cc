#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "apps/tactus/capsule_keeper.h"
#include "apps/tactus/interrupt.h"
#include "apps/tactus/live_view.h"
#include "apps/tactus/progress.h"
#include "apps/tactus/report.h"
#include "apps/tactus/run_folder.h"
#include "apps/tactus/scene_file.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/state_keeper.h"
#include "apps/tactus/text.h"
#include "apps/tactus/xray_view.h"
#include "dsl/read_stack.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/part_error.h"
#include "framework/runtime/replay_recorder.h"

namespace tactus::app {
namespace {

struct RunArguments : StackArguments {
  std::string out;
  std::string from;                                                ///< state file; "" = the stack's start
  std::string save_at;                                             ///< s, separated by commas
  bool live = false;
};

/// Watches a run for what its folder tells beyond the log.
struct Keepers {
  Keepers(Session& session, const std::string& folder, const std::vector<double>& save_at)
      : capsules(session, folder), xrays(session), states(session, folder, save_at) {}
  CapsuleKeeper capsules;
  XrayKeeper xrays;
  StateKeeper states;
};

/// The stack's session, as a state of it left off where one is given.
dsl::Stack stackOf(Program& program, const RunArguments& arguments, const std::optional<dsl::SavedState>& from) {
  StackOptions options = arguments.stack;
  if (from) {
    if (options.seed && static_cast<std::uint64_t>(*options.seed) != from->seed)
      throw UsageError("--seed " + std::to_string(*options.seed) + ": the state is of seed " + std::to_string(from->seed) +
                       ", whose objects and draws it holds");
    options.seed = from->seed;
  }
  return readAloud(program, options);
}

std::optional<dsl::SavedState> stateOf(const std::string& file) {
  if (file.empty()) return std::nullopt;
  try {
    return dsl::readState(file);
  } catch (const dsl::JsonFileError& error) {
    throw runtime::FileError(file, error.what());
  }
}

void goOnFrom(const dsl::SavedState& state, const std::string& file, Session& session) {
  const double duration = session.stack().run.duration;
  if (state.time >= duration - 0.5 * session.controller().period())
    throw UsageError("the state is of t = " + timeText(state.time) + " s, and the run ends at " +
                     timeText(duration) + " s: give a longer --duration, counted from 0");
  try {
    for (const std::string& note : session.restore(state)) std::cerr << "tactus run: " << file << ": " << note << "\n";
  } catch (const control::StateError& error) {
    throw runtime::FileError(file, error.what());
  }
}

std::vector<double> saveTimes(const RunArguments& arguments, const Session& session) {
  if (arguments.save_at.empty()) return {};
  const std::vector<double> times = parseNumbers(arguments.save_at, "--save-at");
  const double from = session.time(), until = session.stack().run.duration;
  for (const double time : times)
    if (!(time >= from && time <= until))
      throw UsageError("--save-at " + timeText(time) + ": the run goes from " + timeText(from) +
                       " to " + timeText(until) + " s");
  return times;
}

/// A run that goes on leaves the folder that its state lies in as it is.
std::string folderOf(const RunArguments& arguments, const Session& session, const std::string& label) {
  if (arguments.from.empty())
    return arguments.out.empty() ? defaultRunFolder(session.stack(), label) : arguments.out;
  const std::string folder = arguments.out.empty() ? defaultRunFolder(session.stack(), label) + "-from" +
                                                         timeText(session.time())
                                                   : arguments.out;
  std::error_code error;
  const std::filesystem::path of_state = std::filesystem::absolute(arguments.from).parent_path();
  if (std::filesystem::equivalent(folder, of_state, error))
    throw UsageError("--out " + folder + ": the state to go on from lies there; give another folder");
  return folder;
}

int exitCodeOf(const Session& session, runtime::Ending ending) {
  switch (ending) {
    case runtime::Ending::done: return session.faultCode();
    case runtime::Ending::interrupted: return exit_interrupted;
    case runtime::Ending::plant_error: return exit_numerical;
    case runtime::Ending::tick_error: return exit_plugin;
    case runtime::Ending::part_error: return exit_plugin;
    case runtime::Ending::file_error: return exit_files;
  }
  return exit_numerical;
}

/// What tells on stderr how far the run is.
std::unique_ptr<control::Observer> progressOf(const Session& session, bool live) {
  const double from = session.time(), duration = session.stack().run.duration;
  if (live) return std::make_unique<LiveView>(session.stack().robot, session.contacts(), from, duration);
  return std::make_unique<Progress>(duration, "", from);
}

/// Runs the session into the folder.  A file that cannot be written ends the run; what was written stays.
runtime::LoopResult runInto(const std::string& folder, Session& session, Keepers& keepers, bool live,
                            const std::atomic<bool>& stop) {
  runtime::LoopResult result;
  try {
    runtime::writeWhole(folder + "/stack.resolved.xml", dsl::writeResolved(session.stack()));
    writeScene(folder + "/scene.json", session);
    const auto recorder = session.recordInto(folder);
    runtime::ReplayRecorder replay(folder, session.stack().robot, session.scene(), session.tick());
    const std::vector<control::Observer*> own = session.startRecorders(folder);
    {
      const std::unique_ptr<control::Observer> progress = progressOf(session, live);
      std::vector<control::Observer*> observers{&keepers.states,   recorder.get(), &replay,
                                                &keepers.capsules, &keepers.xrays, progress.get()};
      observers.insert(observers.end(), own.begin(), own.end());
      result = session.run(observers, stop);
    }
    if (result.ending == runtime::Ending::file_error) return result;
    if (result.ending == runtime::Ending::interrupted || keepers.states.isDue()) keepers.states.save();
    recorder->close();
    replay.close();
    for (control::Observer* one : own) one->close();
  } catch (const runtime::PartError& error) {
    result.ending = runtime::Ending::part_error;
    result.message = error.what();
  } catch (const runtime::FileError& error) {
    result.ending = runtime::Ending::file_error;
    result.message = error.what();
  }
  return result;
}

/// Does what writes a file; says what went wrong and returns whether all is well.
template <class Write>
bool wrote(Write write) {
  try {
    write();
    return true;
  } catch (const runtime::FileError& error) {
    std::cerr << "tactus run: " << error.what() << "\n";
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << "tactus run: " << error.path1().string() << ": " << error.code().message() << "\n";
  }
  return false;
}

int run(const RunArguments& arguments, bool json) {
  Program program(arguments.plugins);
  const std::optional<dsl::SavedState> from = stateOf(arguments.from);
  Session session(stackOf(program, arguments, from), program.registry());
  if (from) goOnFrom(*from, arguments.from, session);
  const std::vector<double> save_at = saveTimes(arguments, session);
  const std::string label = arguments.stack.back_end.empty() ? session.backEndName() : arguments.stack.back_end;
  const std::string folder = folderOf(arguments, session, label);
  const FolderClaim claim = claimRunFolder(folder, session);
  if (from) runtime::writeWhole(folder + "/" + from_file, dsl::stateToJson(*from));

  const Interrupt interrupt;
  Keepers keepers(session, folder, save_at);
  const CapsuleKeeper& capsules = keepers.capsules;
  const runtime::LoopResult result = runInto(folder, session, keepers, arguments.live, interrupt.stop());
  nlohmann::ordered_json description = describeRun(session, result);
  for (const std::string& warning : capsules.warnings()) description["warnings"].push_back(warning);
  description["capsules"] = capsules.files();
  if (from) description["from"] = {{"file", arguments.from}, {"time", from->time}, {"set", arguments.stack.set}};
  description["states"] = keepers.states.files();
  const bool described = wrote([&] { writeJson(folder + "/run.json", description); });
  // A log that could not be written is no ground for pictures; `tactus report` makes them of what there is.
  const bool drawable = session.statistics().ticks() > 0 && result.ending != runtime::Ending::file_error;
  const bool drawn = drawable && wrote([&] {
    writeJson(folder + "/" + xray_file, keepers.xrays.describe(result.ending == runtime::Ending::tick_error));
    writeReport(folder);
  });

  if (json) {
    std::cout << jsonText(description, 2) << "\n";
  } else {
    std::cout << summaryTable(description);
  }
  for (const std::string& note : faultNotes(description)) std::cerr << "tactus run: note: " << note << "\n";
  if (!result.message.empty()) std::cerr << "tactus run: " << result.message << "; the log is kept\n";
  for (const nlohmann::ordered_json& warning : description["warnings"])
    std::cerr << "tactus run: warning: " << warning.get<std::string>() << "\n";
  if (!capsules.files().empty())
    std::cerr << "failed ticks are kept: tactus solve " << folder << "/" << capsules.files().front() << "\n";
  if (result.ending == runtime::Ending::interrupted && !keepers.states.files().empty())
    std::cerr << "to go on: tactus run " << arguments.stack.file << " --from " << folder << "/"
              << keepers.states.files().back() << "\n";
  std::cerr << "run folder: " << folder << (drawn ? ", pictures in report.html\n" : "\n");
  const int code = exitCodeOf(session, result.ending);
  return code == exit_done && !(described && drawn == drawable) ? exit_files : code;
}

}  // namespace

void addRun(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("run", "Run a stack on the simulated robot and keep what happened");
  const auto arguments = std::make_shared<RunArguments>();
  command->add_option("STACK", arguments->stack.file, "The stack's XML file")->required()->type_name("");
  command
      ->add_option("--backend", arguments->stack.back_end, "Back end instead of the stack's: null-space, qp/nlopt, …")
      ->type_name("BACKEND");
  arguments->declare(*command);
  command->add_option("--out", arguments->out, "Run folder; runs/<stack>-<back end>-seed<N> without it")
      ->type_name("DIR");
  command->add_option("--save-at", arguments->save_at, "Save the whole state at these times, as state-<time>.json")
      ->type_name("SECONDS,…")
      ->check(notEmpty());
  command->add_option("--from", arguments->from, "Go on from a saved state, to the bit; with --set and --backend: branch")
      ->type_name("STATE")
      ->check(notEmpty());
  command->add_flag("--live", arguments->live, "Show contacts and forces on stderr as the run goes");
  command->add_flag("--json", context.json, "Print run.json on stdout instead of the summary");
  command->footer(
      R"(Leaves run.json, log.csv, timing.csv, touched_points.csv, stack.resolved.xml, xray.json, what a replay needs
(scene.json, replay.csv, replay_contacts.csv) and report.html in the run folder, and the first 5 ticks that failed or came late as capsule-<tick>.json, which `tactus solve`
solves again to the bit.  A run that is interrupted leaves its state too, and `--from` goes on with it.

Examples:
  tactus run examples/explore_table/stack.xml
  tactus run examples/explore_table/stack.xml --live
  tactus run examples/explore_table/stack.xml --backend qp/nlopt --seed 3 --duration 10
  tactus run examples/explore_table/stack.xml --set press=0.8 --out runs/harder
  tactus run examples/explore_table/stack.xml --save-at 5 --out runs/whole
  tactus run examples/explore_table/stack.xml --from runs/whole/state-5.json --set press=0.8 --out runs/branch)");
  command->callback([=, &context] { context.action = [=, &context] { return run(*arguments, context.json); }; });
}

}  // namespace tactus::app
