#include <filesystem>
#include <map>

#include "conformance/laws.h"
#include "conformance/states.h"
#include "dsl/compile.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/temporary_folder.h"

namespace tactus::conformance {
namespace {

constexpr int kTicks = 8 * kStretch;

/// Every file that the recorder leaves, by its path in the run folder.  `slowness` scales the wall-clock times that it
/// is told.
std::map<std::string, std::string> record(const Subject& subject, double slowness) {
  dsl::Stack stack = subject.stack;
  std::erase_if(stack.run.recorders, [&](const dsl::ElementInstance& other) { return other.name != subject.name; });
  const runtime::TemporaryFolder folder;
  const auto controller = dsl::compile(stack, subject.registry);
  const auto recorders = dsl::makeRecorders(stack, subject.registry, *controller, folder.path);
  Bench bench(stack, subject.registry);
  States states(stack, 1);
  for (int k = 0; k < kTicks; ++k) {
    states.next(bench);
    for (const auto& recorder : recorders) recorder->before(*controller);
    const Eigen::VectorXd& torque = controller->tick(bench.sensed);
    for (const auto& recorder : recorders)
      recorder->observe({bench.sensed, bench.sensed, *controller, torque, slowness * (k + 1)});
    bench.endTick();
  }
  for (const auto& recorder : recorders) recorder->close();
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path))
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), folder.path).string()] = runtime::readFile(entry.path().string());
  return files;
}

}  // namespace

void checkRecorder(const Subject& subject, Report& report) {
  std::map<std::string, std::string> first;
  judge(subject, "files", report, [&] {
    first = record(subject, 1);
    if (first.empty()) throw Broken{"it left no file in the run folder"};
  });
  if (report.findings.back().outcome == Outcome::broken) return;
  judge(subject, "determinism", report, [&] {
    for (const auto& [name, content] : record(subject, 2))
      if (!first.contains(name) || first[name] != content)
        throw Broken{"a second run of the same inputs left another '" + name + "': no wall-clock time goes into results"};
  });
}

}  // namespace tactus::conformance
