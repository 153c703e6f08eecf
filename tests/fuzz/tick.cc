// The bytes are a tick problem file or a capsule.  It is refused with a reason, or taken: then what is written of it
// reads back as the same text, and every back end answers it in bounded work with a torque of finite numbers.

#include "apps/tactus/program.h"
#include "dsl/capsule.h"
#include "dsl/tick_file.h"
#include "tests/fuzz/require.h"

using namespace tactus;

namespace {

std::string textOf(const dsl::TickFile& file) {
  return file.capsule ? dsl::capsuleToJson(file.problem, *file.capsule) : dsl::tickProblemToJson(file.problem);
}

void solve(const control::Registry& registry, const std::string& name, const control::TickProblem& problem) {
  const auto back_end = registry.makeBackEnd(control::makeValues(*registry.elements().findBackEnd(name)));
  control::TickSolution solution;
  back_end->prepare(problem, solution);
  back_end->solve(problem, solution);
  if (solution.torque.size() != problem.dof || !solution.torque.allFinite())
    fuzz::require(name + ": no finite torque for every joint");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static app::Program program;
  try {
    const dsl::TickFile file = dsl::parseTickFile(std::string(reinterpret_cast<const char*>(data), size));
    const std::string written = textOf(file);
    if (textOf(dsl::parseTickFile(written)) != written) fuzz::require("another file is read than was written");
    if (file.capsule) return 0;                                    // may hold what no back end has to answer
    for (const std::string& name : program.registry().names(control::ElementKind::back_end))
      solve(program.registry(), name, file.problem);
  } catch (const dsl::JsonFileError& refusal) {
    if (std::string(refusal.what()).empty()) fuzz::require("no message");
  }
  return 0;
}
