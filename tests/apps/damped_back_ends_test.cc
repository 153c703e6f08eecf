// Postures in which a level has hardly any room to do what it is asked, and what keeps the back ends from forcing it.

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Case {
  const char* example;
  const char* back_end;
  const char* price;                                               ///< the attribute that keeps it
  const char* seed;
  const char* seconds;                                             ///< without it, a joint runs away before
};

std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.example << " by " << one.back_end; }

class DampedBackEnds : public ::testing::TestWithParam<Case> {
 protected:
  Outcome run(const fs::path& example) const {
    return tactus({"run", example / "stack.xml", "--backend", GetParam().back_end, "--seed", GetParam().seed, "--duration",
                   GetParam().seconds, "--out", folder_.file("run")});
  }
  const TemporaryFolder folder_;
};

TEST_P(DampedBackEnds, KeepTheirJointsFromRunningAway) {
  const fs::path example = fs::path(TACTUS_SOURCE_DIR) / "examples" / GetParam().example;
  const Outcome damped = run(example);
  EXPECT_EQ(damped.exit_code, 0) << damped.err;

  const fs::path copy = folder_.file("example");
  fs::copy(example, copy);
  const std::string stack = contentOf(copy / "stack.xml");
  const std::string without =
      std::regex_replace(stack, std::regex("(<alternative.*) " + std::string(GetParam().price) + "=\"[0-9.]+\""), "$1");
  ASSERT_NE(without, stack);
  std::ofstream(copy / "stack.xml") << without;
  const Outcome undamped = run(copy);
  EXPECT_EQ(undamped.exit_code, 5);
  EXPECT_THAT(undamped.err, HasSubstr("runs away"));
  EXPECT_THAT(undamped.err, HasSubstr("raise its damping or regularisation"));
}

INSTANTIATE_TEST_SUITE_P(Examples, DampedBackEnds,
                         ::testing::Values(Case{"explore_spheres", "hqp", "damping", "1", "6.5"},
                                           Case{"explore_hands", "hqp", "damping", "5", "4"},
                                           Case{"explore_hands", "qp/active-set", "regularisation", "6", "10"}));

}  // namespace
}  // namespace tactus::testing
