#include "framework/runtime/golden.h"

#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "apps/tactus/interrupt.h"
#include "apps/tactus/run_folder.h"
#include "apps/tactus/stack_arguments.h"
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

/// A folder of its own in the system's place for such, taken away at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() : path((fs::temp_directory_path() / "tactus-golden-XXXXXX").string()) {
    if (!::mkdtemp(path.data())) throw runtime::FileError(path, "cannot be created", errno);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string path;
};

/// A case is a folder, or the name of one in tests/golden.
fs::path caseFolder(const std::string& name) {
  return fs::is_directory(name) || name.find('/') != std::string::npos ? fs::path(name)
                                                                       : fs::path("tests/golden") / name;
}

/// FNV-1a, 64 bit: tells whether an input is the one that was recorded.
std::string hashOf(const std::string& content) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char c : content) hash = (hash ^ c) * 0x100000001b3;
  std::string digits = "fnv1a64:";
  for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[(hash >> shift) & 15];
  return digits;
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
/// the name, one that stands beside the stack is named from the case's folder.
std::string portableStack(const dsl::Stack& stack, const fs::path& folder) {
  std::string xml = dsl::writeResolved(stack);
  const std::string absolute = fs::absolute(stack.robot_file).string();
  const bool by_name = dsl::findModel(stack.robot_model, stack.file, {}).file.empty();
  const std::string portable = by_name ? stack.robot_model : fs::relative(absolute, folder).string();
  if (const size_t at = xml.find(absolute); at != std::string::npos) xml.replace(at, absolute.size(), portable);
  return xml;
}

/// Runs the case's stack and returns its log in `folder`.
std::string runInto(const std::string& folder, Session& session) {
  const auto recorder = session.recordInto(folder);
  const Interrupt interrupt;
  const runtime::LoopResult result = session.run({recorder.get()}, interrupt.stop());
  recorder->close();
  if (result.ending == runtime::Ending::plant_error) throw runtime::PlantError(result.message);
  if (result.ending == runtime::Ending::interrupted) throw Interrupted();
  return folder + "/log.csv";
}

int record(const GoldenArguments& arguments) {
  if (arguments.reason.find_first_not_of(" \t\n") == std::string::npos) {
    throw UsageError("golden record: --reason must say why the golden values are new");
  }
  const fs::path folder = caseFolder(arguments.cases.front());
  const std::string stack_file = (folder / "stack.xml").string();
  Program program(arguments.plugins);
  StackOptions source = arguments.stack;
  if (source.file.empty()) source.file = stack_file;
  if (!fs::exists(source.file) && arguments.stack.file.empty()) {
    throw UsageError("golden record: a new case needs --stack FILE");
  }
  // The case keeps the stack with everything resolved, so that it stands alone.
  const dsl::Stack stack = readAloud(program, source);
  fs::create_directories(folder);
  runtime::writeFile(stack_file, portableStack(stack, folder));
  Session session(readAloud(program, {stack_file, {}, {}, {}, {}}), program.registry());
  const TemporaryFolder temporary;
  const std::string log = runInto(temporary.path, session);
  runtime::writeFile((folder / "expected.csv").string(), runtime::readFile(log));
  if (!fs::exists(folder / "tolerances.xml")) {
    runtime::writeFile((folder / "tolerances.xml").string(), defaultTolerances());
  }
  writeJson((folder / "provenance.json").string(), provenance(session, arguments.reason, program));
  std::cerr << "recorded " << folder.string() << "\n";
  return exit_done;
}

int verifyCase(Program& program, const std::string& name, const std::string& keep, ordered_json& results) {
  const fs::path folder = caseFolder(name);
  const auto expected = runtime::CsvTable::read((folder / "expected.csv").string());
  const auto tolerances = readTolerances((folder / "tolerances.xml").string());
  Session session(readAloud(program, {(folder / "stack.xml").string(), {}, {}, {}, {}}), program.registry());
  const TemporaryFolder temporary;
  const std::string log = runInto(temporary.path, session);
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
  if (json) std::cout << ordered_json{{"cases", results}}.dump(2) << "\n";
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
