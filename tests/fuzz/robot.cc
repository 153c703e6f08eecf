// The bytes are a URDF file: it is read, and built into a model where its masses allow, or refused at a place.

#include "apps/tactus/temporary_folder.h"
#include "dsl/read_robot.h"
#include "framework/dynamics/model.h"
#include "tests/fuzz/require.h"

using namespace tactus;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const app::TemporaryFolder folder;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string file = fuzz::write(folder.path + "/robot.urdf", text);
  std::vector<dsl::Diagnostic> warnings;
  try {
    const dynamics::Model model(dsl::readRobot(file, warnings));
  } catch (const dsl::InvalidStack& refusal) {
    fuzz::require(dsl_test::lackOf(refusal, file, text));
  } catch (const dynamics::ModelError& refusal) {
    if (refusal.place.line < 1) fuzz::require(std::string("no place: ") + refusal.what());
  }
  return 0;
}
