// What a user does with an installed Tactus: makes a plugin, builds, tests and runs it; copies an example; is refused.
//
// Strategy: `cmake --install` into a folder that is then moved, so that nothing can lean on where it was built or first
// put. Not tested here: the Debian package itself (scripts/package).

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/runtime/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct Said {
  int exit_code;
  std::string text;                                                // both streams
};

Said shell(const std::string& command) {
  std::string said;
  FILE* pipe = ::popen(("(" + command + ") 2>&1").c_str(), "r");
  if (!pipe) return {-1, "no shell"};
  char part[4096];
  for (size_t count; (count = std::fread(part, 1, sizeof part, pipe)) > 0;) said.append(part, count);
  return {WEXITSTATUS(::pclose(pipe)), said};
}

class Installed : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new tactus::testing::TemporaryFolder;
    const Said said = shell("cmake --install " TACTUS_BINARY_DIR " --prefix " + folder->file("first"));
    ASSERT_EQ(said.exit_code, 0) << said.text;
    fs::rename(folder->file("first"), prefix());
    for (const auto& entry : fs::recursive_directory_iterator(prefix()))
      if (entry.path().filename() == "TactusConfig.cmake") package = entry.path().parent_path();
    ASSERT_FALSE(package.empty());
  }
  static void TearDownTestSuite() { delete folder; }

  static std::string prefix() { return folder->file("tactus"); }
  static std::string tactus() { return prefix() + "/bin/tactus"; }

  /// Builds the plugin in `source`, with more flags for the compiler, and only `target` of it.  A debug build: quick to
  /// make, and with Eigen's checks.
  static Said build(const std::string& source, const std::string& flags = "", const std::string& target = "all") {
    return shell("cmake -S " + source + " -B " + source + "/build -DCMAKE_BUILD_TYPE=Debug -DTactus_DIR=" +
                 package.string() + " -DCMAKE_CXX_FLAGS='" + flags + "' && cmake --build " + source +
                 "/build --target " +
                 target);
  }

  /// Test, laws and run of a plugin that is built.
  static void use(const std::string& source, const std::string& name) {
    const std::string library = source + "/build/" + name + ".so", stack = source + "/stack.xml";
    Said said = shell("ctest --test-dir " + source + "/build --output-on-failure --no-tests=error");
    EXPECT_EQ(said.exit_code, 0) << said.text;
    said = shell(tactus() + " plugins check " + library + " --stack " + stack);
    EXPECT_EQ(said.exit_code, 0) << said.text;
    EXPECT_THAT(said.text, HasSubstr("\nconforms\n"));
    said = shell(tactus() + " run " + stack + " --plugin " + library + " --duration 0.5 --out " + source + "/run");
    EXPECT_EQ(said.exit_code, 0) << said.text;
    EXPECT_TRUE(fs::exists(source + "/run/log.csv"));
    said = shell("TACTUS_PLUGIN_PATH=" + source + "/build " + tactus() + " check " + stack);
    EXPECT_EQ(said.exit_code, 0) << said.text;
    said = shell(tactus() + " schema xsd --plugin " + library + " > " + source + "/stack.xsd && xmllint --noout --schema " +
                 source + "/stack.xsd " + stack);
    EXPECT_EQ(said.exit_code, 0) << said.text;
  }

  /// A new plugin 'acme' in a folder of this test.
  std::string newPlugin() const {
    const Said said = shell(tactus() + " new plugin acme --out " + own.path());
    EXPECT_EQ(said.exit_code, 0) << said.text;
    return own.file("acme");
  }

  /// That the library is refused everywhere, with exit code 4 and this sentence.
  static void expectRefused(const std::string& source, const std::string& sentence) {
    const std::string library = source + "/build/acme.so";
    for (const std::string& command : {"run " + source + "/stack.xml --plugin " + library, "plugins info " + library,
                                       "plugins check " + library, "plugins list --plugin " + library}) {
      const Said said = shell(tactus() + " " + command);
      EXPECT_EQ(said.exit_code, 4) << command << "\n" << said.text;
      EXPECT_THAT(said.text, HasSubstr(sentence)) << command;
    }
  }

  tactus::testing::TemporaryFolder own;
  static tactus::testing::TemporaryFolder* folder;
  static fs::path package;
};
tactus::testing::TemporaryFolder* Installed::folder = nullptr;
fs::path Installed::package;

TEST_F(Installed, ProgramFindsItsOwnPluginsAndModels) {
  const Said said = shell("cd " + own.path() + " && " + tactus() + " new stack first && " + tactus() +
                          " run first.xml --duration 0.1 && " + tactus() + " plugins list");
  EXPECT_EQ(said.exit_code, 0) << said.text;
  EXPECT_THAT(said.text, AllOf(HasSubstr("first with null-space, seed 1: done"), HasSubstr(prefix() + "/lib")));
  EXPECT_THAT(said.text, ::testing::Not(HasSubstr(TACTUS_BINARY_DIR)));
}

TEST_F(Installed, HasAManualPageForEachCommand) {
  const Said said = shell("cd " + prefix() + "/share/man/man1 && gzip -dc tactus.1.gz tactus-golden-record.1.gz");
  EXPECT_EQ(said.exit_code, 0) << said.text;
  EXPECT_THAT(said.text, AllOf(HasSubstr(".TH TACTUS 1"), HasSubstr(".TH TACTUS-GOLDEN-RECORD 1")));
}

/// By the commands of the README that `new plugin` writes, as they stand there.  Its test gets the one of
/// docs/plugins.md.
TEST_F(Installed, ANewPluginIsBuiltTestedCheckedAndRun) {
  const std::string readme = tactus::testing::contentOf(newPlugin() + "/README.md");
  const std::string page = tactus::testing::contentOf(TACTUS_SOURCE_DIR "/docs/plugins.md");
  const std::string last_include = "#include \"conformance/conformance.h\"\n";
  const size_t from = page.find(last_include) + last_include.size();
  const std::string shown = page.substr(from, page.find("```", from) - from);
  EXPECT_THAT(shown, HasSubstr("bench.tick();"));
  own.write("acme/reach_test.cc",
            tactus::testing::contentOf(own.file("acme/reach_test.cc")) + "\nTEST(Page, IsTrue) {\n" + shown + "}\n");
  const size_t begin = readme.find("```sh\n") + 6;
  const std::string commands = readme.substr(begin, readme.find("\n```", begin) - begin);
  EXPECT_THAT(commands, HasSubstr("-DTactus_DIR=" + package.string()));
  const Said said =
      shell("set -e; export PATH=" + prefix() + "/bin:$PATH; cd " + own.file("acme") + "\n" + commands + "\n");
  EXPECT_EQ(said.exit_code, 0) << said.text;
  EXPECT_THAT(said.text, AllOf(HasSubstr("100% tests passed"), HasSubstr("\nconforms\n"),
                               HasSubstr("acme-reach with null-space, seed 1: done")));
}

/// Headers of a Tactus with another ABI number, as of another version.
TEST_F(Installed, APluginOfAnotherAbiIsRefused) {
  const std::string acme = newPlugin(), other = own.file("other");
  fs::copy(prefix() + "/include/tactus", other, fs::copy_options::recursive);
  const std::string header = other + "/framework/runtime/plugin_api.h";
  std::string text = tactus::testing::contentOf(header);
  const std::string number = "plugin_abi = ";
  const size_t at = text.find(number) + number.size();
  text.replace(at, text.find(';', at) - at, "99");
  own.write("other/framework/runtime/plugin_api.h", text);

  const Said said = build(acme, "-I" + other, "acme");
  ASSERT_EQ(said.exit_code, 0) << said.text;
  expectRefused(acme, "acme.so: built with plugin ABI 99, but this program has ");
}

#ifdef __x86_64__
TEST_F(Installed, APluginOfAnotherEigenAlignmentIsRefused) {
  const std::string acme = newPlugin();
  const Said said = build(acme, "-mavx", "acme");
  ASSERT_EQ(said.exit_code, 0) << said.text;
  expectRefused(acme, "built with an Eigen alignment of 32 bytes, but this program has 16 bytes; "
                      "rebuild it without -march=native");
}
#endif

class InstalledExample : public Installed, public ::testing::WithParamInterface<std::string> {};

TEST_P(InstalledExample, IsBuiltTestedAndRun) {
  const std::string source = own.file(GetParam());
  fs::copy(prefix() + "/share/tactus/examples/plugins/" + GetParam(), source, fs::copy_options::recursive);
  const Said said = build(source);
  ASSERT_EQ(said.exit_code, 0) << said.text;
  use(source, GetParam());
}

std::vector<std::string> examples() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(TACTUS_SOURCE_DIR "/examples/plugins"))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(EveryPlugin, InstalledExample, ::testing::ValuesIn(examples()),
                         [](const auto& info) { return info.param; });

}  // namespace
