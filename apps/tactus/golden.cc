#include "framework/runtime/golden.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "apps/tactus/inputs.h"
#include "apps/tactus/interrupt.h"
#include "apps/tactus/run_folder.h"
#include "apps/tactus/stack_arguments.h"
#include "framework/runtime/temporary_folder.h"
#include "apps/tactus/text.h"
#include "apps/tactus/tolerances.h"
#include "apps/tactus/versions.h"
#include "dsl/model_search.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct GoldenArguments : StackArguments {
  std::vector<std::string> cases;
  std::string reason;
  std::string keep;
};

/// Puts the new folder in the place of the case in one step.  What stood there is left in the new folder's place.
void exchange(const std::string& fresh, const std::string& folder) {
  if (!fs::exists(folder)) return fs::rename(fresh, folder);
  if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno != EINVAL && errno != ENOSYS) throw runtime::FileError(folder, "cannot be replaced", errno);
  // A file system without exchange: two steps, and the first is taken back when the second fails.
  const std::string old = fresh + ".old";
  fs::rename(folder, old);
  try {
    fs::rename(fresh, folder);
  } catch (...) {
    fs::rename(old, folder);
    throw;
  }
  fs::rename(old, fresh);
}

/// A case is a folder, or the name of one in tests/golden.
fs::path caseFolder(const std::string& name) {
  return fs::is_directory(name) || name.find('/') != std::string::npos ? fs::path(name)
                                                                       : fs::path("tests/golden") / name;
}

/// Model name of the processor, "" where the system does not tell.
std::string processor() {
  std::string info;
  try {
    info = runtime::readFile("/proc/cpuinfo");
  } catch (const runtime::FileError&) {
    return "";
  }
  const size_t line = info.find("model name");
  if (line == std::string::npos) return "";
  const size_t colon = info.find(": ", line);
  return info.substr(colon + 2, info.find('\n', colon) - colon - 2);
}

ordered_json provenance(const Session& session, const std::string& reason, Program& program) {
  ordered_json inputs = ordered_json::object();
  for (const auto& [file, content] : session.stack().files)
    inputs[fs::path(file).filename().string()] = hashOf(content);
  for (const std::string& file : filesOfShapes(session.stack()))
    inputs[fs::path(file).filename().string()] = hashOf(runtime::readFile(file));
  ordered_json plugins = ordered_json::object();
  for (const runtime::LoadedPlugin& plugin : program.plugins().loaded()) plugins[plugin.name] = plugin.version;
  return {{"reason", reason},
          {"backend", session.backEndName()},
          {"seed", session.stack().run.seed},
          {"duration_s", session.stack().run.duration},
          {"versions", versions()},
          {"plugins", plugins},
          {"processor", processor()},
          {"inputs", inputs}};
}

/// The resolved stack without places of this machine, so that a case reads on another: a robot found by its name keeps
/// the name; one that stands beside the stack, and files of shapes, are named from the case's folder.
std::string portableStack(const dsl::Stack& stack, const fs::path& folder) {
  std::string xml = dsl::writeResolved(stack);
  const std::string absolute = fs::absolute(stack.robot_file).string();
  const bool by_name = dsl::findModel(stack.robot_model, stack.file, {}).file.empty();
  const std::string portable = by_name ? stack.robot_model : fs::relative(absolute, folder).string();
  if (const size_t at = xml.find(absolute); at != std::string::npos) xml.replace(at, absolute.size(), portable);
  for (const std::string& file : filesOfShapes(stack)) {
    const std::string from_case = fs::relative(file, folder).string();
    for (size_t at = xml.find(file); at != std::string::npos; at = xml.find(file, at + from_case.size()))
      xml.replace(at, file.size(), from_case);
  }
  return xml;
}

/// Runs the case's stack and returns its log in `folder`.
std::string runInto(const std::string& folder, Session& session, const Interrupt& interrupt) {
  const auto recorder = session.recordInto(folder);
  const runtime::LoopResult result = session.run({recorder.get()}, interrupt.stop());
  if (result.error) std::rethrow_exception(result.error);
  if (result.ending == runtime::Ending::interrupted) throw Interrupted();
  recorder->close();
  return folder + "/log.csv";
}

/// A run in which tasks lost their numbers is no example for later ones.
void refuseUnusable(const Session& session) {
  if (session.faultCode() != exit_done) {
    throw runtime::PlantError(session.warnings().front() + "; such a run is not recorded");
  }
}

/// Takes over what is not recorded: tolerances, a robot that stands in the case, notes.
void keepOtherFiles(const fs::path& folder, const fs::path& made) {
  fs::permissions(made, fs::exists(folder) ? fs::status(folder).permissions() : fs::perms(0755));
  if (!fs::exists(folder)) return;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name == "stack.xml" || name == "expected.csv" || name == "provenance.json") continue;
    fs::copy(entry.path(), made / name, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  }
}

/// Refuses to put a case where something else stands.
void checkPlace(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw runtime::FileError(folder.string(), "is not a folder");
  if (!fs::is_empty(folder) && !fs::exists(folder / "stack.xml")) {
    throw runtime::FileError(folder.string(), "holds files that are not of a golden case; give a new folder");
  }
}

int record(const GoldenArguments& arguments) {
  if (arguments.reason.find_first_not_of(" \t\n") == std::string::npos) {
    throw UsageError("golden record: --reason must say why the golden values are new");
  }
  fs::path folder = fs::weakly_canonical(fs::absolute(caseFolder(arguments.cases.front())));
  if (!folder.has_filename()) folder = folder.parent_path();       // "case/"
  const Interrupt interrupt;
  Program program(arguments.plugins);
  StackOptions source = arguments.stack;
  if (source.file.empty()) source.file = (folder / "stack.xml").string();
  if (!fs::exists(source.file) && arguments.stack.file.empty()) {
    throw UsageError("golden record: a new case needs --stack FILE");
  }
  checkPlace(folder);
  const dsl::Stack stack = readAloud(program, source);

  // The case is made beside its place and put there whole: whatever fails before leaves the old one as it was.
  fs::create_directories(folder.parent_path());
  const runtime::TemporaryFolder fresh(folder.parent_path() / ("." + folder.filename().string() + "-"));
  const fs::path made = fresh.path;
  keepOtherFiles(folder, made);
  // The case keeps the stack with everything resolved, so that it stands alone.
  const std::string stack_file = (made / "stack.xml").string();
  runtime::writeFile(stack_file, portableStack(stack, folder));
  Session session(readAloud(program, {stack_file, {}, {}, {}, {}}), program.registry());
  const runtime::TemporaryFolder run;
  const std::string log = runInto(run.path, session, interrupt);
  refuseUnusable(session);
  runtime::writeFile((made / "expected.csv").string(), runtime::readFile(log));
  if (!fs::exists(made / "tolerances.xml")) {
    runtime::writeFile((made / "tolerances.xml").string(), defaultTolerances());
  }
  writeJson((made / "provenance.json").string(), provenance(session, arguments.reason, program));
  if (interrupt.stop()) throw Interrupted();
  exchange(made.string(), folder.string());
  std::cerr << "recorded " << folder.string() << "\n";
  return exit_done;
}

int verifyCase(Program& program, const std::string& name, const std::string& keep, ordered_json& results) {
  const fs::path folder = caseFolder(name);
  const auto expected = runtime::CsvTable::read((folder / "expected.csv").string());
  const auto tolerances = readTolerances((folder / "tolerances.xml").string());
  Session session(readAloud(program, {(folder / "stack.xml").string(), {}, {}, {}, {}}), program.registry());
  const runtime::TemporaryFolder temporary;
  const Interrupt interrupt;
  const std::string log = runInto(temporary.path, session, interrupt);
  if (!keep.empty()) {
    fs::create_directories(keep);
    runtime::writeFile(keep + "/" + folder.filename().string() + ".csv", runtime::readFile(log));
  }
  const runtime::GoldenComparison comparison =
      runtime::compareGolden(expected, runtime::CsvTable::read(log), tolerances);

  ordered_json failures = ordered_json::array();
  for (const runtime::ColumnFailure& failure : comparison.failures) {
    failures.push_back({{"column", failure.column},
                        {"task", runtime::taskOfColumn(failure.column)},
                        {"time", failure.time},
                        {"worst_ratio", failure.worst_ratio},
                        {"expected", failure.expected},
                        {"actual", failure.actual}});
  }
  results.push_back({{"case", name},
                     {"passed", comparison.passed()},
                     {"missing", comparison.missing},
                     {"extra", comparison.extra},
                     {"rows", {{"expected", comparison.expected_rows}, {"actual", comparison.actual_rows}}},
                     {"failures", failures}});
  std::cerr << name << ": " << (comparison.passed() ? "passed" : "FAILED") << "\n" << comparison.text();
  return comparison.passed() ? exit_done : exit_mismatch;
}

int verify(const GoldenArguments& arguments, bool json) {
  Program program(arguments.plugins);
  ordered_json results = ordered_json::array();
  int code = exit_done;
  for (const std::string& name : arguments.cases) {
    code = std::max(code, verifyCase(program, name, arguments.keep, results));
  }
  if (json) std::cout << jsonText(ordered_json{{"cases", results}}, 2) << "\n";
  return code;
}

}  // namespace

void addGolden(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("golden", "Recorded runs that must repeat");
  command->require_subcommand(0, 1);
  const auto arguments = std::make_shared<GoldenArguments>();
  constexpr const char* examples =
      R"(A case is a folder with stack.xml, expected.csv, tolerances.xml and provenance.json: a path, or a name in
tests/golden.

Examples:
  tactus golden record table-short --stack examples/explore_table/stack.xml --duration 2 --reason "new contact law"
  tactus golden verify table-short)";
  command->footer(examples);

  CLI::App* record_command = command->add_subcommand("record", "Run a stack and keep its log as the golden one");
  record_command->add_option("CASE", arguments->cases, "Folder or name of the case")
      ->required()
      ->expected(1)
      ->type_name("");
  record_command->add_option("--stack", arguments->stack.file, "The stack; that of the case itself without it")
      ->type_name("FILE");
  record_command->add_option("--reason", arguments->reason, "Why the golden values are new")
      ->required()
      ->type_name("TEXT");
  record_command->add_option("--backend", arguments->stack.back_end, "Back end instead of the stack's")
      ->type_name("BACKEND");
  arguments->declare(*record_command);
  record_command->footer(examples);
  record_command->callback([=, &context] { context.action = [=] { return record(*arguments); }; });

  CLI::App* verify_command = command->add_subcommand("verify", "Run cases again and compare; writes nothing into them");
  verify_command->add_option("CASE", arguments->cases, "Folders or names of cases")->required()->type_name("");
  verify_command->add_option("--keep", arguments->keep, "Folder that gets the new logs as <case>.csv")
      ->type_name("DIR");
  declarePlugins(*verify_command, arguments->plugins);
  verify_command->add_flag("--json", context.json, "{cases: [{case, passed, missing, extra, rows, failures}]}");
  verify_command->footer(examples);
  verify_command->callback(
      [=, &context] { context.action = [=, &context] { return verify(*arguments, context.json); }; });
}

}  // namespace tactus::app
