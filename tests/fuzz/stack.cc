// The bytes are a stack, on the way of `tactus check --strict`: read, held against the table and what it refers to,
// compiled, ticked once.  It is taken or refused at a place; what was taken is written, and reads back.

#include "apps/tactus/program.h"
#include "apps/tactus/temporary_folder.h"
#include "dsl/lint.h"
#include "tests/fuzz/require.h"

using namespace tactus;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static app::Program program;
  static const app::TemporaryFolder folder;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string file = fuzz::write(folder.path + "/stack.xml", text);
  const std::string resolved_file = folder.path + "/resolved.xml";
  app::StackOptions options;
  options.file = file;
  try {
    const dsl::Stack stack = program.read(options);
    dsl::lint(stack, program.registry());
    options.file = fuzz::write(resolved_file, dsl::writeResolved(stack));
  } catch (const dsl::InvalidStack& refusal) {
    fuzz::require(dsl_test::lackOf(refusal, file, text));
    return 0;
  }
  try {
    program.read(options);
  } catch (const dsl::InvalidStack& refusal) {
    fuzz::require(std::string("the resolved stack is refused: ") + refusal.what());
  }
  return 0;
}
