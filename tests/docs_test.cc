// What README.md and docs/ show works as shown: stacks are run, and the plugin that is made by hand is built by itself.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "dsl/codes.h"
#include "framework/runtime/csv_table.h"
#include "tests/runtime/temporary_folder.h"

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> pages() {
  std::vector<fs::path> files{fs::path(TACTUS_SOURCE_DIR) / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TACTUS_SOURCE_DIR) / "docs")) {
    if (entry.path().extension() == ".md") files.push_back(entry.path());
  }
  return files;
}

/// The fenced blocks of that language on a page, from the line that begins with `after`.
std::vector<std::string> blocks(const fs::path& page, const std::string& language, const std::string& after = "") {
  std::vector<std::string> found;
  std::ifstream in(page);
  std::string block;
  bool inside = false, begun = after.empty();
  for (std::string line; std::getline(in, line);) {
    begun = begun || line.rfind(after, 0) == 0;
    if (begun && !inside && line == "```" + language) {
      inside = true;
      block.clear();
    } else if (inside && line == "```") {
      inside = false;
      found.push_back(block);
    } else if (inside) {
      block += line + "\n";
    }
  }
  return found;
}

/// The page whose stacks are broken.
const fs::path kMessages = fs::path(TACTUS_SOURCE_DIR) / "docs/messages.md";

/// The blocks that hold a whole, valid stack of elements that are always there.
std::vector<std::string> stacks(const fs::path& page) {
  std::vector<std::string> found;
  if (page == kMessages) return found;
  for (const std::string& block : blocks(page, "xml")) {
    if (block.rfind("<stack", 0) == 0 && block.find("<plugin") == std::string::npos) found.push_back(block);
  }
  return found;
}

/// Runs a shell command; what it says goes into `output`.
int shell(const std::string& command, std::string* output = nullptr) {
  std::string said;
  FILE* pipe = ::popen(("(" + command + ") 2>&1").c_str(), "r");
  if (!pipe) return -1;
  char part[4096];
  for (size_t count; (count = std::fread(part, 1, sizeof part, pipe)) > 0;) said.append(part, count);
  if (output) *output = said;
  return WEXITSTATUS(::pclose(pipe));
}

const std::string kProgram = TACTUS_BINARY_DIR "/bin/tactus";

TEST(Docs, EveryStackShownPassesCheckAndReadsBackResolved) {
  const tactus::testing::TemporaryFolder folder;
  int checked = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& stack : stacks(page)) {
      const std::string name = std::to_string(checked++), file = folder.write(name + ".xml", stack);
      std::string said;
      EXPECT_EQ(shell(kProgram + " check " + file, &said), 0) << page << ":\n" << said;
      EXPECT_EQ(shell(kProgram + " run " + file + " --duration 0.01 --out " + folder.file(name), &said), 0) << said;
      EXPECT_EQ(shell(kProgram + " check " + folder.file(name) + "/stack.resolved.xml", &said), 0) << page << ":\n" << said;
      EXPECT_EQ(shell(kProgram + " golden record " + folder.file("case" + name) + " --stack " + file +
                          " --duration 0.01 --reason 'does it read back?'", &said), 0) << page << ":\n" << said;
    }
  }
  EXPECT_GE(checked, 2);
}

/// Studies are shown for the stack of examples/explore_table.
TEST(Docs, EveryStudyShownPassesCheck) {
  const tactus::testing::TemporaryFolder folder;
  fs::copy(TACTUS_SOURCE_DIR "/examples/explore_table/stack.xml", folder.file("stack.xml"));
  int checked = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& block : blocks(page, "xml")) {
      if (block.rfind("<study", 0) != 0) continue;
      ++checked;
      std::string said;
      const std::string file = folder.write("study.xml", block);
      EXPECT_EQ(shell(kProgram + " check --strict " + file, &said), 0) << page << ":\n" << said;
    }
  }
  EXPECT_GE(checked, 1);
}

/// Blocks of `console`: what follows a "$ tactus …" is what it prints, from the project's folder.
TEST(Docs, WhatCommandsPrintIsWhatThePagesShow) {
  int commands = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& block : blocks(page, "console")) {
      ASSERT_EQ(block.rfind("$ tactus ", 0), 0u) << page << ":\n" << block;
      const size_t end = block.find('\n');
      std::string said;
      shell("cd " TACTUS_SOURCE_DIR " && " + kProgram + block.substr(8, end - 8), &said);
      EXPECT_EQ(said, block.substr(end + 1)) << page;
      ++commands;
    }
  }
  EXPECT_GE(commands, 4);
}

/// Pages that are made from the element table are those that it makes now.
TEST(Docs, TheReferenceIsWhatTheTableSays) {
  const tactus::testing::TemporaryFolder folder;
  std::string said;
  ASSERT_EQ(shell(kProgram + " schema md --out " + folder.path() + " && " + kProgram + " schema xsd --out " + folder.path(),
                  &said), 0) << said;
  EXPECT_EQ(shell("diff -r " + folder.path() + " " TACTUS_SOURCE_DIR "/docs/reference", &said), 0)
      << said << "make it again: tactus schema md --out docs/reference; tactus schema xsd --out docs/reference";
}

/// Every valid stack of the project, as editors see it; those of plugins validate against a schema that knows the plugin
/// (tests/package).
TEST(Docs, EveryStackValidatesAgainstTheSchema) {
  const std::string schema = TACTUS_SOURCE_DIR "/docs/reference/stack.xsd";
  std::string said;
  if (shell("command -v xmllint", &said) != 0) GTEST_SKIP() << "xmllint is not installed";
  const tactus::testing::TemporaryFolder folder;
  std::vector<std::string> files;
  for (const char* room : {"examples", "bench", "tests/apps/data", "tests/golden"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TACTUS_SOURCE_DIR) / room)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream in(entry.path());
      const std::string text((std::istreambuf_iterator<char>(in)), {});
      const bool stack = entry.path().extension() == ".xml" &&
                         (text.find("<stack") != std::string::npos || text.find("<study") != std::string::npos);
      if (stack && text.find("<plugin name") == std::string::npos) files.push_back(entry.path());
    }
  }
  for (const fs::path& page : pages())
    for (const std::string& stack : stacks(page)) files.push_back(folder.write(std::to_string(files.size()) + ".xml", stack));
  ASSERT_GE(files.size(), 6u);
  for (const std::string& file : files)
    EXPECT_EQ(shell("xmllint --noout --schema " + schema + " " + file, &said), 0) << said;

  const std::string misspelled = folder.write("misspelled.xml",
                                              "<stack format=\"1\"><robot model=\"lwr_allegro\"/><level priority=\"1\">"
                                              "<posture name=\"rest\" stifness=\"1\"/></level></stack>");
  EXPECT_NE(shell("xmllint --noout --schema " + schema + " " + misspelled, &said), 0);
  EXPECT_NE(said.find("'stifness' is not allowed"), std::string::npos) << said;
}

/// What docs/messages.md says under a heading "## E012: …".
struct MessageSection {
  std::string heading;
  std::map<std::string, std::string> files;                        ///< by name; the stack's is stack.xml
  bool has_no_snippet = false;
};

/// A block is a file of the name that stands above it, `robot.urdf`:, and without one the stack.
std::vector<MessageSection> messageSections() {
  std::vector<MessageSection> sections;
  std::ifstream in(kMessages);
  const std::string stack = "stack.xml";
  std::string name = stack, content;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (inside && line == "```") {
      sections.back().files[name] = content;
      name = stack;
      content.clear();
      inside = false;
    } else if (inside) {
      content += line + "\n";
    } else if (line.rfind("## E", 0) == 0 || line.rfind("## W", 0) == 0) {
      sections.push_back({line.substr(3), {}});
    } else if (!sections.empty()) {
      inside = line == "```xml";
      if (line.rfind("No snippet: ", 0) == 0) sections.back().has_no_snippet = true;
      if (line.size() > 3 && line.front() == '`' && line.substr(line.size() - 2) == "`:")
        name = line.substr(1, line.size() - 3);
    }
  }
  return sections;
}

TEST(Docs, EveryMessageHasASnippetThatProvokesIt) {
  std::vector<std::string> wanted, found;
  for (const tactus::dsl::Code& code : tactus::dsl::all_codes)
    wanted.push_back(std::string(code.id) + ": " + code.meaning);
  std::sort(wanted.begin(), wanted.end());
  int without = 0;
  for (const MessageSection& section : messageSections()) {
    found.push_back(section.heading);
    EXPECT_NE(section.has_no_snippet, !section.files.empty()) << section.heading;
    if (section.has_no_snippet) ++without;
    if (section.files.empty()) continue;
    const std::string code = section.heading.substr(0, 4);
    const tactus::testing::TemporaryFolder folder;
    for (const auto& [name, content] : section.files) folder.write(name, content);
    std::string said;
    if (section.files.count("stack.xml")) {
      const int exit_code = shell(kProgram + " check --strict --json " + folder.file("stack.xml"), &said);
      EXPECT_EQ(exit_code, code == "E070" ? 4 : 3) << section.heading << "\n" << said;
      EXPECT_NE(said.find("\"code\": \"" + code + "\""), std::string::npos) << section.heading << "\n" << said;
    } else {                                                       // only `dynamics` takes such a robot
      const int exit_code = shell(kProgram + " dynamics " + folder.file("robot.urdf"), &said);
      EXPECT_EQ(exit_code, 0) << section.heading << "\n" << said;
      EXPECT_NE(said.find("warning[" + code + "]"), std::string::npos) << section.heading << "\n" << said;
    }
  }
  EXPECT_EQ(found, wanted);                                        // in the order of their numbers
  EXPECT_LE(without, 7);
}

/// README's first stack settles: no torque is cut, and all back ends that it names agree.
TEST(Docs, TheFirstStackIsStable) {
  const tactus::testing::TemporaryFolder folder;
  std::string stack = stacks(fs::path(TACTUS_SOURCE_DIR) / "README.md").at(0);
  // A rest that is not the start: a stack that starts where it wants to be would show little.
  const std::string rest = "stiffness=\"1\" damping=\"0.02\"/>";
  ASSERT_NE(stack.find(rest), std::string::npos);
  stack.replace(stack.find(rest), rest.size(),
                "stiffness=\"1\" damping=\"0.02\" q=\"0 -0.6 0 1.6 0 -0.4 0  0 0.3 0.3 0.3  0 0.3 0.3 0.3  0 0.3 0.3 0.3  "
                "0.3 1.1 0.1 0.1\"/>");
  const std::string file = folder.write("first.xml", stack);
  for (const std::string back_end : {"null-space", "qp/nlopt"}) {
    const std::string run = folder.file(back_end.substr(0, 2));
    std::string said;
    ASSERT_EQ(shell(kProgram + " run " + file + " --backend " + back_end + " --out " + run, &said), 0) << said;
    EXPECT_NE(said.find("fallback 0, infeasible 0, limited 0\n"), std::string::npos) << said;
    const auto log = tactus::runtime::CsvTable::read(run + "/log.csv");
    EXPECT_LT(log.numbers("task/palm/error").back(), 1e-4) << back_end;
    EXPECT_LT(log.numbers("task/rest/error").back(), 5e-3) << back_end;
  }
}

/// The plugin that docs/plugins.md makes by hand, made as it says from `tactus_dir`, used by `program`.
void makeAndUsePlugin(const std::string& tactus_dir, const std::string& program) {
  const fs::path page = fs::path(TACTUS_SOURCE_DIR) / "docs/plugins.md";
  const std::string section = "## By hand: two files";
  const tactus::testing::TemporaryFolder folder;
  folder.write("wiggle.cc", blocks(page, "cpp", section).at(0));
  folder.write("CMakeLists.txt", blocks(page, "cmake", section).at(0));
  const std::string stack = folder.write("wiggle.xml", blocks(page, "xml", section).at(0));
  const std::string build = folder.file("build");
  std::string said;
  ASSERT_EQ(shell("cmake -S " + folder.path() + " -B " + build + " -DCMAKE_BUILD_TYPE=Release -DTactus_DIR=" + tactus_dir +
                  " && cmake --build " + build, &said), 0) << said;

  EXPECT_EQ(shell(program + " run " + stack, &said), 4) << "without the plugin:\n" << said;
  EXPECT_NE(said.find("the plugin 'acme' cannot be loaded"), std::string::npos) << said;
  ASSERT_EQ(shell(program + " run " + stack + " --plugin " + build + "/acme.so --out " + folder.file("run"), &said), 0)
      << said;
  const auto log = tactus::runtime::CsvTable::read(folder.file("run/log.csv"));
  const std::vector<double> error = log.numbers("task/shoulder/error");
  EXPECT_GT(error[20], 0);
  EXPECT_LT(*std::max_element(error.begin(), error.end()), 0.2);
  EXPECT_EQ(shell("TACTUS_PLUGIN_PATH=" + build + " " + program + " check " + stack, &said), 0) << said;
  EXPECT_EQ(shell(program + " explain acme.wiggle --plugin " + build + "/acme.so", &said), 0) << said;
  EXPECT_NE(said.find("amplitude: number; rad; ≥ 0; default 0.1"), std::string::npos) << said;
}

TEST(Docs, ThePluginMadeByHandIsMadeFromTheBuildTree) { makeAndUsePlugin(TACTUS_BINARY_DIR, kProgram); }

TEST(Docs, ThePluginMadeByHandIsMadeFromAnInstalledTactus) {
  const tactus::testing::TemporaryFolder prefix;
  std::string said;
  ASSERT_EQ(shell("cmake --install " TACTUS_BINARY_DIR " --prefix " + prefix.path(), &said), 0) << said;
  std::string package;
  for (const auto& entry : fs::recursive_directory_iterator(prefix.path())) {
    if (entry.path().filename() == "TactusConfig.cmake") package = entry.path().parent_path().string();
  }
  ASSERT_FALSE(package.empty()) << said;
  makeAndUsePlugin(package, prefix.file("bin/tactus"));
}

}  // namespace
