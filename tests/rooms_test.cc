// Which room may include which: the table of docs/architecture.md, kept.
//
// Strategy: read the #include lines of every source file.  Own includes are written from the project's root, so a
// room is the first folders of the path.  Transitive reach is checked where it matters: the plant must be built
// without framework/dynamics.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = TACTUS_SOURCE_DIR;

std::vector<fs::path> sources(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".h" || extension == ".cc") files.push_back(entry.path());
  }
  return files;
}

std::vector<std::string> includes(const fs::path& file) {
  static const std::regex line_pattern(R"(^\s*#\s*include\s*["<]([^">]+)[">])");
  std::vector<std::string> result;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_search(line, match, line_pattern)) result.push_back(match[1]);
  }
  return result;
}

bool startsWith(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

const std::vector<std::string> kRooms = {"framework/geometry", "framework/description", "framework/dynamics", "framework/control",
                                         "framework/runtime",     "tasks",              "dsl",
                                         "conformance",           "plugins",            "sim",
                                         "apps"};

/// What each room may include of the project, besides itself.
const std::map<std::string, std::vector<std::string>> kMayUse = {
    {"framework/geometry", {}},
    {"framework/description", {"framework/geometry"}},
    {"framework/dynamics", {"framework/description"}},
    {"framework/control", {"framework/geometry", "framework/description", "framework/dynamics"}},
    {"framework/runtime", {"framework/geometry", "framework/description", "framework/dynamics", "framework/control"}},
    {"tasks", {"framework/description", "framework/dynamics", "framework/control"}},
    {"dsl", {"framework"}},
    {"conformance", {"framework", "tasks", "dsl"}},
    {"plugins", {"framework"}},
    {"sim", {"framework/geometry", "framework/description", "framework/runtime", "framework/control/archive.h",
             "framework/control/sensed.h"}},
    {"apps", {"framework", "tasks", "dsl", "plugins/grasp", "sim", "conformance"}},
};

/// Foreign libraries by the start of the included path, and the rooms that may include them.
const std::vector<std::pair<std::vector<std::string>, std::set<std::string>>> kForeign = {
    {{"Simbody.h", "SimTK", "simbody/", "simmath/"}, {"sim"}},
    {{"tinyxml2.h"}, {"dsl", "apps"}},
    {{"urdf_"}, {"dsl"}},
    {{"assimp/"}, {"dsl"}},
    {{"coin/", "IpIpopt", "IpTNLP"}, {"plugins"}},
    {{"nlopt"}, {"plugins"}},
    {{"nlohmann/"}, {"dsl", "apps"}},
    {{"CLI/"}, {"apps"}},
    {{"mujoco/", "kdl/", "dart/"}, {"bench"}},                     // witnesses, of tests and benchmarks only
};

TEST(Rooms, EachKnowsOnlyWhatIsBelowIt) {
  int checked = 0;
  for (const auto& [room, allowed] : kMayUse) {
    for (const fs::path& file : sources(room)) {
      for (const std::string& include : includes(file)) {
        const bool own = std::any_of(kRooms.begin(), kRooms.end(),
                                     [&](const std::string& other) { return startsWith(include, other + "/"); });
        if (!own || startsWith(include, room + "/")) continue;
        ++checked;
        EXPECT_TRUE(std::any_of(allowed.begin(), allowed.end(), [&](const std::string& a) {
          return startsWith(include, a);
        })) << fs::relative(file, kRoot) << " includes " << include << ", which " << room << " may not use";
      }
    }
  }
  EXPECT_GT(checked, 50) << "hardly anything was checked: are includes still written from the project's root?";
}

TEST(Rooms, ForeignLibrariesStayInTheirRooms) {
  for (const std::string& room : kRooms) {
    for (const fs::path& file : sources(room)) {
      for (const std::string& include : includes(file)) {
        for (const auto& [starts, rooms] : kForeign) {
          const bool foreign = std::any_of(starts.begin(), starts.end(),
                                           [&](const std::string& start) { return startsWith(include, start); });
          if (!foreign) continue;
          EXPECT_TRUE(rooms.count(room)) << fs::relative(file, kRoot) << " includes " << include;
        }
      }
    }
  }
}

TEST(Rooms, ThePlantIsBuiltWithoutFrameworkDynamics) {
  std::set<fs::path> seen;
  std::vector<fs::path> open = sources("sim");
  ASSERT_FALSE(open.empty());
  while (!open.empty()) {
    const fs::path file = open.back();
    open.pop_back();
    if (!seen.insert(file).second) continue;
    for (const std::string& include : includes(file)) {
      EXPECT_FALSE(startsWith(include, "framework/dynamics/")) << fs::relative(file, kRoot) << " reaches " << include;
      if (fs::exists(kRoot / include)) open.push_back(kRoot / include);
    }
  }
  EXPECT_GT(seen.size(), 5u);
}

TEST(Rooms, TestsMirrorTheRooms) {
  for (const std::string room : {"geometry", "dynamics", "control", "runtime", "tasks", "dsl", "conformance", "plugins", "sim", "apps"}) {
    EXPECT_TRUE(fs::exists(kRoot / "tests" / room / "CMakeLists.txt")) << room;
  }
}

TEST(Rooms, NoFileIsBuiltWithNdebug) {
  // Simbody's headers change their class layout on NDEBUG while Debian's library is built without it.
#ifdef NDEBUG
  FAIL() << "NDEBUG is defined";
#endif
  std::ifstream commands(TACTUS_BINARY_DIR "/compile_commands.json");
  ASSERT_TRUE(commands) << "no compile_commands.json";
  for (std::string line; std::getline(commands, line);) {
    EXPECT_EQ(line.find("-DNDEBUG"), std::string::npos) << line;
    EXPECT_EQ(line.find("-march=native"), std::string::npos) << line;
    EXPECT_EQ(line.find("-ffast-math"), std::string::npos) << line;
  }
}

}  // namespace
