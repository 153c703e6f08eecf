#include <gtest/gtest.h>

#include <sys/wait.h>

#include <cstdio>
#include <string>

// The programs' own messages.
namespace {

struct Outcome {
  int status = -1;
  std::string text;
};

Outcome run(const std::string& command) {
  Outcome outcome;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  char buffer[400];
  while (std::fgets(buffer, sizeof buffer, pipe)) outcome.text += buffer;
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

TEST(BenchDynamics, SaysThatAFilterFindsNothing) {
  const Outcome outcome = run(TACTUS_BINARY_DIR "/bin/bench_dynamics --quick --filter no_such_robot");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.text, "bench_dynamics: --filter finds no model/operation: they are as in the table, e.g. "
                          "'humanoid/rnea'\n");
}

TEST(InstallDependencies, NamesAnUnknownArgument) {
  const Outcome outcome = run(TACTUS_SOURCE_DIR "/scripts/install_dependencies --everything");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.text, "install_dependencies: unknown argument '--everything': there are --peers, --package and --fuzz\n");
}

}  // namespace
