// `sim` never reaches framework/dynamics through its includes, at any depth.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
const fs::path root = TACTUS_SOURCE_DIR;

/// The project's own files that `start` includes, directly or not; paths from the project root.
std::set<std::string> reachable(const std::vector<std::string>& start) {
  static const std::regex include("^\\s*#\\s*include\\s*[\"<]([^\">]+)[\">]");
  std::set<std::string> seen(start.begin(), start.end());
  std::vector<std::string> pending = start;
  while (!pending.empty()) {
    std::ifstream file(root / pending.back());
    pending.pop_back();
    for (std::string line; std::getline(file, line);) {
      std::smatch match;
      if (std::regex_search(line, match, include) && fs::exists(root / match[1].str()) && seen.insert(match[1]).second)
        pending.push_back(match[1]);
    }
  }
  return seen;
}

bool reachesDynamics(const std::set<std::string>& files) {
  return std::any_of(files.begin(), files.end(),
                     [](const std::string& file) { return file.starts_with("framework/dynamics/"); });
}

TEST(IncludeRule, SimNeverReachesTheOwnDynamics) {
  std::vector<std::string> sources;
  for (const fs::directory_entry& entry : fs::directory_iterator(root / "sim"))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cc")
      sources.push_back("sim/" + entry.path().filename().string());
  ASSERT_GT(sources.size(), 8u);
  const std::set<std::string> files = reachable(sources);
  EXPECT_TRUE(files.contains("framework/runtime/plant.h")) << "the scan follows includes";
  EXPECT_FALSE(reachesDynamics(files));
}

TEST(IncludeRule, TheScanFindsABreach) {
  EXPECT_TRUE(reachesDynamics(reachable({"tests/sim/dynamics_against_simbody_test.cc"})));
}

}  // namespace
