// Commands that rewrite stacks: fmt and migrate.  Both only print unless they are told to write.
#include <iostream>

#include "apps/tactus/command.h"
#include "apps/tactus/errors.h"
#include "apps/tactus/program.h"
#include "apps/tactus/stack_arguments.h"
#include "dsl/findings.h"
#include "dsl/format_xml.h"
#include "dsl/source_text.h"
#include "dsl/upgrade.h"
#include "dsl/xml_file.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

struct FormatArguments {
  std::vector<std::string> files;
  bool write = false;
  bool check = false;
};

/// Throws dsl::InvalidStack where the file is not XML.
std::string formatted(const std::string& file, const std::string& text) {
  dsl::Findings findings;
  auto source = std::make_shared<dsl::XmlSource>();
  source->text = dsl::SourceText(file, text);
  dsl::parseXml(source, findings);
  findings.throwErrors();
  return dsl::formatXml(text);
}

int format(const FormatArguments& arguments) {
  if (arguments.write && arguments.check) throw UsageError("--write and --check exclude each other");
  int code = exit_done;
  for (const std::string& file : arguments.files) {
    const std::string text = runtime::readFile(file), better = formatted(file, text);
    if (arguments.check) {
      if (text == better) continue;
      std::cout << file << "\n";
      code = exit_mismatch;
    } else if (!arguments.write) {
      std::cout << better;
    } else if (text != better) {
      runtime::writeFile(file, better);
      std::cerr << "written: " << file << "\n";
    }
  }
  return code;
}

struct MigrateArguments {
  std::string stack;
  bool write = false;
  std::vector<std::string> plugins;
};

int migrate(const MigrateArguments& arguments) {
  Program program(arguments.plugins);
  const dsl::Migration migration = dsl::migrate(
      arguments.stack, program.registry(), program.includeFolders(),
      [&](const std::string& name) { program.plugins().loadNamed(name); });
  for (const dsl::Diagnostic& change : migration.changes) std::cerr << dsl::render(change) << "\n";
  if (migration.changes.empty()) std::cerr << arguments.stack << ": nothing to rewrite\n";
  for (const auto& [file, text] : migration.files) {
    if (arguments.write) runtime::writeFile(file, text);
    if (arguments.write || file != arguments.stack)
      std::cerr << (arguments.write ? "written: " : "would change, too: ") << file << "\n";
  }
  if (arguments.write) return exit_done;
  const auto changed = migration.files.find(arguments.stack);
  std::cout << (changed == migration.files.end() ? runtime::readFile(arguments.stack) : changed->second);
  return exit_done;
}

}  // namespace

void addFormat(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("fmt", "Lay out XML files in one way; comments stay");
  const auto arguments = std::make_shared<FormatArguments>();
  command->add_option("FILE", arguments->files, "Stacks, robots, or any XML")->required()->type_name("");
  command->add_flag("--write", arguments->write, "Rewrite the files instead of printing");
  command->add_flag("--check", arguments->check, "Only name the files that would change; exit code 1 when there are any");
  command->footer(R"(Examples:
  tactus fmt stack.xml
  tactus fmt --write examples/*/stack.xml
  tactus fmt --check stack.xml)");
  command->callback([=, &context] { context.action = [=] { return format(*arguments); }; });
}

void addMigrate(CLI::App& program, Context& context) {
  CLI::App* command =
      program.add_subcommand("migrate", "Rewrite a stack and what it includes with the names that elements have now");
  const auto arguments = std::make_shared<MigrateArguments>();
  command->add_option("STACK", arguments->stack, "The stack's XML file")->required()->type_name("");
  command->add_flag("--write", arguments->write, "Rewrite the files; without it the new texts are printed");
  declarePlugins(*command, arguments->plugins);
  command->footer(R"(Only names change: comments and layout stay.  A file of a later format is refused (E019).

Examples:
  tactus migrate old.xml
  tactus migrate old.xml --write)");
  command->callback([=, &context] { context.action = [=] { return migrate(*arguments); }; });
}

}  // namespace tactus::app
