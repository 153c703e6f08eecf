#include <filesystem>
#include <iostream>

#include "apps/tactus/capsule_keeper.h"
#include "apps/tactus/interrupt.h"
#include "apps/tactus/progress.h"
#include "apps/tactus/report.h"
#include "apps/tactus/run_folder.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/text.h"
#include "apps/tactus/xray_view.h"
#include "dsl/read_stack.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/part_error.h"

namespace tactus::app {
namespace {

struct RunArguments : StackArguments {
  std::string out;
};

/// Watches a run for what its folder tells beyond the log.
struct Keepers {
  Keepers(const Session& session, const std::string& folder) : capsules(session, folder), xrays(session) {}
  CapsuleKeeper capsules;
  XrayKeeper xrays;
};

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

/// Runs the session into the folder.  A file that cannot be written ends the run; what was written stays.
runtime::LoopResult runInto(const std::string& folder, Session& session, Keepers& keepers,
                            const std::atomic<bool>& stop) {
  runtime::LoopResult result;
  try {
    runtime::writeFile(folder + "/stack.resolved.xml", dsl::writeResolved(session.stack()));
    const auto recorder = session.recordInto(folder);
    const std::vector<control::Observer*> own = session.startRecorders(folder);
    {
      Progress progress(session.stack().run.duration);
      std::vector<control::Observer*> observers{recorder.get(), &keepers.capsules, &keepers.xrays, &progress};
      observers.insert(observers.end(), own.begin(), own.end());
      result = session.run(observers, stop);
    }
    if (result.ending == runtime::Ending::file_error) return result;
    recorder->close();
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
  Session session(readAloud(program, arguments.stack), program.registry());
  const std::string label = arguments.stack.back_end.empty() ? session.backEndName() : arguments.stack.back_end;
  const std::string folder = arguments.out.empty() ? defaultRunFolder(session.stack(), label) : arguments.out;
  claimRunFolder(folder, session);

  const Interrupt interrupt;
  Keepers keepers(session, folder);
  const CapsuleKeeper& capsules = keepers.capsules;
  const runtime::LoopResult result = runInto(folder, session, keepers, interrupt.stop());
  nlohmann::ordered_json description = describeRun(session, result);
  for (const std::string& warning : capsules.warnings()) description["warnings"].push_back(warning);
  description["capsules"] = capsules.files();
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
  command->add_flag("--json", context.json, "Print run.json on stdout instead of the summary");
  command->footer(
      R"(Leaves run.json, log.csv, timing.csv, touched_points.csv, stack.resolved.xml, xray.json and report.html in the
run folder, and the first 5 ticks that failed or came late as capsule-<tick>.json, which `tactus solve`
solves again to the bit.

Examples:
  tactus run examples/explore_table/stack.xml
  tactus run examples/explore_table/stack.xml --backend qp/nlopt --seed 3 --duration 10
  tactus run examples/explore_table/stack.xml --set press=0.8 --out runs/harder)");
  command->callback([=, &context] { context.action = [=, &context] { return run(*arguments, context.json); }; });
}

}  // namespace tactus::app
