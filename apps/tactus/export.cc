#include <iostream>
#include <memory>

#include "apps/tactus/command.h"
#include "apps/tactus/export_mcap.h"

namespace tactus::app {
namespace {

struct ExportArguments {
  std::string run;
  std::string mcap;
};

}  // namespace

void addExport(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("export", "Write a run as a file for other programs");
  const auto arguments = std::make_shared<ExportArguments>();
  command->add_option("RUN", arguments->run, "Folder of a run")->required()->type_name("RUN");
  command
      ->add_option("--mcap", arguments->mcap, "MCAP, which Foxglove opens: scene, frames, contacts, the log's columns")
      ->required()
      ->type_name("FILE");
  command->footer(R"(The same run gives the same bytes.  A run that was cut off is written as far as it came.

Examples:
  tactus export runs/first --mcap first.mcap)");
  command->callback([=, &context] {
    context.action = [=] {
      const RunRecord run = readRunRecord(arguments->run);
      for (const std::string& warning : run.warnings) std::cerr << "tactus export: warning: " << warning << "\n";
      exportMcap(run, arguments->mcap);
      std::cerr << arguments->mcap << "\n";
      return exit_done;
    };
  });
}

}  // namespace tactus::app
