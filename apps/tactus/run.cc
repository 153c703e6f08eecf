#include <filesystem>
#include <iostream>

#include "apps/tactus/interrupt.h"
#include "apps/tactus/progress.h"
#include "apps/tactus/report.h"
#include "apps/tactus/run_folder.h"
#include "apps/tactus/stack_arguments.h"
#include "dsl/read_stack.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

struct RunArguments : StackArguments {
  std::string out;
};

int exitCodeOf(runtime::Ending ending) {
  switch (ending) {
    case runtime::Ending::done: return exit_done;
    case runtime::Ending::interrupted: return exit_interrupted;
    case runtime::Ending::plant_error: return exit_numerical;
  }
  return exit_numerical;
}

int run(const RunArguments& arguments, bool json) {
  Program program(arguments.plugins);
  Session session(readAloud(program, arguments.stack), program.registry());
  const std::string label = arguments.stack.back_end.empty() ? session.backEndName() : arguments.stack.back_end;
  const std::string folder = arguments.out.empty() ? defaultRunFolder(session.stack(), label) : arguments.out;
  claimRunFolder(folder, session);
  runtime::writeFile(folder + "/stack.resolved.xml", dsl::writeResolved(session.stack()));

  const auto recorder = session.recordInto(folder);
  const Interrupt interrupt;
  runtime::LoopResult result;
  {
    Progress progress(session.stack().run.duration);
    result = session.run({recorder.get(), &progress}, interrupt.stop());
  }
  recorder->close();
  const nlohmann::ordered_json description = describeRun(session, result);
  writeJson(folder + "/run.json", description);
  if (session.statistics().ticks() > 0) writeReport(folder);

  if (json) {
    std::cout << description.dump(2) << "\n";
  } else {
    std::cout << summaryTable(description);
  }
  if (!result.message.empty()) std::cerr << "tactus run: " << result.message << "; the log is kept\n";
  std::cerr << "run folder: " << folder << ", pictures in report.html\n";
  return exitCodeOf(result.ending);
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
      R"(Leaves run.json, log.csv, timing.csv, touched_points.csv, stack.resolved.xml and report.html in the run folder.

Examples:
  tactus run examples/explore_table/stack.xml
  tactus run examples/explore_table/stack.xml --backend qp/nlopt --seed 3 --duration 10
  tactus run examples/explore_table/stack.xml --set press=0.8 --out runs/harder)");
  command->callback([=, &context] { context.action = [=, &context] { return run(*arguments, context.json); }; });
}

}  // namespace tactus::app
