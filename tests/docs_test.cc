// Every stack shown in README.md and docs/ passes `tactus check`.

#include <gtest/gtest.h>

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> pages() {
  std::vector<fs::path> files{fs::path(TACTUS_SOURCE_DIR) / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TACTUS_SOURCE_DIR) / "docs")) {
    if (entry.path().extension() == ".md") files.push_back(entry.path());
  }
  return files;
}

/// The fenced xml blocks of a page that hold a whole stack.
std::vector<std::string> stacks(const fs::path& page) {
  std::vector<std::string> found;
  std::ifstream in(page);
  std::string block;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (!inside && line == "```xml") {
      inside = true;
      block.clear();
    } else if (inside && line == "```") {
      inside = false;
      if (block.rfind("<stack", 0) == 0) found.push_back(block);
    } else if (inside) {
      block += line + "\n";
    }
  }
  return found;
}

TEST(Docs, EveryStackShownPassesCheck) {
  int checked = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& stack : stacks(page)) {
      const fs::path file = fs::path(testing::TempDir()) / ("docs_stack_" + std::to_string(checked++) + ".xml");
      std::ofstream(file) << stack;
      const std::string command = std::string(TACTUS_BINARY_DIR "/bin/tactus check ") + file.string();
      const int status = std::system(command.c_str());
      EXPECT_EQ(WEXITSTATUS(status), 0) << page << ":\n" << stack;
    }
  }
  EXPECT_GE(checked, 2);
}

}  // namespace
