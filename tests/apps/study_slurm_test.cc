// A study as a job array of a real Slurm, whose cluster is this machine and lives in a temporary folder.

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

/// What a shell command says, and its exit code.
std::pair<int, std::string> shell(const std::string& command) {
  std::string said;
  FILE* pipe = ::popen(("(" + command + ") 2>&1").c_str(), "r");
  if (!pipe) return {-1, ""};
  char part[4096];
  for (size_t count; (count = std::fread(part, 1, sizeof part, pipe)) > 0;) said.append(part, count);
  return {WEXITSTATUS(::pclose(pipe)), said};
}

TEST(StudyOnSlurm, AJobArrayMakesTheTablesOfOneMachine) {
  const TemporaryFolder folder, cluster;
  changedStack(folder, "name=\"floor\"", "name=\"floor\" jitter=\"0 0 0.01\"");
  const std::string study = folder.write("study.xml", R"(<study format="1" stack="stack.xml" duration="0.5">
  <factor parameter="press" values="0.3 0.6"/>
  <seeds count="5"/>
  <compare metric="contact_force_mean_N" by="press" baseline="0.3"/>
</study>)");
  ASSERT_EQ(tactus({"study", study, "--out", folder.file("alone")}).exit_code, 0);

  // The array, then a job that merges when all of its jobs have ended.
  const std::string program = TACTUS_BINARY_DIR "/bin/tactus", out = folder.file("array");
  const std::string merge = "--wrap \"" + program + " study merge " + out + "\"";
  const std::string array = TACTUS_SOURCE_DIR "/scripts/study.sbatch " + study + " " + out;
  const std::string job = folder.write("submit", "set -e\ncd " + folder.path() + "\nexport TACTUS=" + program +
                                                     "\njob=$(sbatch --parsable --array=1-3 " + array + ")\n" +
                                                     "sbatch --wait --dependency=afterany:$job --output=merge.txt " +
                                                     merge + "\ncat slurm-*.out\n");
  const auto [code, said] =
      shell(TACTUS_SOURCE_DIR "/tests/apps/with_slurm " + cluster.path() + " timeout 120 bash " + job);
  if (code == 77) GTEST_SKIP() << said;
  ASSERT_EQ(code, 0) << said << contentOf(folder.file("merge.txt"));
  for (const char* shard : {"1/3: 4 trials", "2/3: 3 trials", "3/3: 3 trials"})
    EXPECT_THAT(said, ::testing::HasSubstr(std::string("shard ") + shard + ", 0 failed"));
  for (const char* table : {"trials.csv", "summary.json", "comparisons.csv", "index.html"}) {
    EXPECT_FALSE(contentOf(folder.file(std::string("alone/") + table)).empty()) << table;
    EXPECT_EQ(contentOf(folder.file(std::string("alone/") + table)), contentOf(out + "/" + table)) << table;
  }
}

}  // namespace
}  // namespace tactus::testing
