#include <algorithm>
#include <iostream>

#include "apps/tactus/errors.h"
#include "apps/tactus/session.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/study_check.h"
#include "apps/tactus/text.h"
#include "dsl/codes.h"
#include "dsl/lint.h"
#include "dsl/nearest_name.h"
#include "dsl/read_study.h"
#include "dsl/source_text.h"
#include "framework/runtime/file_error.h"
#include "sim/simbody_plant.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

struct CheckArguments {
  std::vector<std::string> files;
  std::vector<std::string> set;
  std::string back_end;
  std::vector<std::string> plugins;
  bool strict = false;
};

/// Findings of one file, warnings first, and the exit code that they call for.
struct Findings {
  std::vector<dsl::Diagnostic> warnings;
  std::vector<dsl::Diagnostic> errors;
  int exit_code = exit_done;
};

/// Targets whose figure no run of this stack will have.
std::vector<dsl::Diagnostic> unknownTargets(const Session& session) {
  std::vector<dsl::Diagnostic> found;
  const std::vector<std::string> names = session.metricNames();
  for (const dsl::ResolvedElement& element : session.stack().elements) {
    if (element.values.row().name != "target") continue;
    const control::Value& metric = element.values.value("metric");
    if (std::find(names.begin(), names.end(), metric.text) != names.end()) continue;
    dsl::Diagnostic warning;
    warning.severity = dsl::Severity::warning;
    warning.code = dsl::code::unknown_figure.id;
    warning.message = "no run of this stack has a figure '" + metric.text + "'";
    warning.suggestion = dsl::nearestName(metric.text, names);
    warning.place = metric.origin.place;
    warning.length = dsl::countCharacters(metric.text);
    warning.path = element.path;
    const auto& files = session.stack().files;
    if (const auto file = files.find(warning.place.file); file != files.end())
      warning.source_line = dsl::SourceText(file->first, file->second).lineAt(warning.place.line);
    found.push_back(std::move(warning));
  }
  return found;
}

Findings checkFile(Program& program, const StackOptions& options, bool strict) {
  Findings findings;
  try {
    if (dsl::isStudy(options.file)) {
      planOf(program, dsl::readStudy(options.file, program.registry(), program.includeFolders()), findings.warnings);
      if (strict && !findings.warnings.empty()) findings.exit_code = exit_invalid_stack;
      return findings;
    }
    const dsl::Stack stack = program.read(options, &findings.warnings);
    const auto warn = [&](const std::vector<dsl::Diagnostic>& remarks) {
      findings.warnings.insert(findings.warnings.end(), remarks.begin(), remarks.end());
    };
    warn(unknownTargets(Session(stack, program.registry())));
    if (!strict) return findings;
    warn(dsl::lint(stack, program.registry(), sim::PlantOptions().step));
    if (!findings.warnings.empty()) findings.exit_code = exit_invalid_stack;
  } catch (const dsl::InvalidStack& invalid) {
    findings.errors = invalid.diagnostics;
    findings.exit_code = exitCode(findings.errors);
  } catch (const runtime::FileError& error) {
    dsl::Diagnostic diagnostic;
    diagnostic.code = "E001";
    diagnostic.message = error.reason;
    diagnostic.place = {options.file, 1, 1};
    findings.errors.push_back(diagnostic);
    findings.exit_code = exit_files;
  }
  return findings;
}

int check(const CheckArguments& arguments, bool json) {
  Program program(arguments.plugins);
  ordered_json errors = ordered_json::array(), warnings = ordered_json::array();
  int code = exit_done;
  for (const std::string& file : arguments.files) {
    const Findings findings = checkFile(program, {file, arguments.set, arguments.back_end, {}, {}}, arguments.strict);
    for (const dsl::Diagnostic& warning : findings.warnings) warnings.push_back(toJson(warning));
    for (const dsl::Diagnostic& error : findings.errors) errors.push_back(toJson(error));
    if (code == exit_done) code = findings.exit_code;
    if (json) continue;
    for (const auto* list : {&findings.warnings, &findings.errors}) {
      for (const dsl::Diagnostic& diagnostic : *list) std::cerr << dsl::render(diagnostic) << "\n";
    }
    if (findings.exit_code == exit_done) std::cout << file << ": ok\n";
  }
  if (json) std::cout << jsonText(ordered_json{{"errors", errors}, {"warnings", warnings}}, 2) << "\n";
  return code;
}

}  // namespace

void addCheck(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("check", "Read and compile stacks without running them; tell every error");
  const auto arguments = std::make_shared<CheckArguments>();
  command->add_option("STACK", arguments->files, "XML files of stacks")->required()->type_name("");
  command->add_option("--set", arguments->set, "Give a <parameter> of the stacks another value")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command->add_option("--backend", arguments->back_end, "Check for this back end instead of the stack's")
      ->type_name("BACKEND");
  command->add_flag("--strict", arguments->strict,
                    "Also look for what is hardly meant: dead levels, duplicate rows, unstable gains, places out of "
                    "reach, …; then every warning is exit code 3");
  declarePlugins(*command, arguments->plugins);
  command->add_flag("--json", context.json, "{errors: [{file, line, column, code, message, suggestion?}], warnings}");
  command->footer(R"(Examples:
  tactus check examples/explore_table/stack.xml
  tactus check --strict stack.xml
  tactus check --json a.xml b.xml)");
  command->callback([=, &context] { context.action = [=, &context] { return check(*arguments, context.json); }; });
}

}  // namespace tactus::app
