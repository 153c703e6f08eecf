// Broken at random, a stack or a robot is read or refused, and every refusal has a place inside a file that was read.
// Mutations: bytes changed, removed, doubled; stretches removed, doubled, swapped; pieces of syntax put in.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "dsl/compile.h"
#include "dsl/codes.h"
#include "dsl/read_robot.h"
#include "dsl/read_stack.h"
#include "tests/dsl/placed.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

std::string contentOf(const std::string& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The stacks of all examples, benchmarks and tests, broken ones too.
std::vector<std::string> everyStack() {
  std::vector<std::string> files;
  for (const char* room : {"examples", "bench/stacks", "tests/conformance", "tests/dsl/broken", "tests/apps/data"})
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::string(TACTUS_SOURCE_DIR) + "/" + room))
      if (entry.path().extension() == ".xml" && contentOf(entry.path()).find("<stack") != std::string::npos)
        files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string operator()(std::string text) {
    const int times = 1 + static_cast<int>(pick(3));
    for (int i = 0; i < times && !text.empty(); ++i) mutate(text);
    return text;
  }

 private:
  std::size_t pick(std::size_t below) { return below == 0 ? 0 : random_() % below; }

  void mutate(std::string& text) {
    static const std::vector<std::string> pieces{"<",
                                                 ">",
                                                 "/>",
                                                 "\"",
                                                 "'",
                                                 "&",
                                                 "${",
                                                 "}",
                                                 "<!--",
                                                 "-->",
                                                 "]]>",
                                                 "<![CDATA[",
                                                 "</level>",
                                                 "nan",
                                                 "1e999",
                                                 "-1",
                                                 "0",
                                                 "\xFF",
                                                 "\xC3",
                                                 "ü",
                                                 "\t",
                                                 "\r\n",
                                                 "<include file=\"stack.xml\"/>",
                                                 "<box/>",
                                                 " x=\"\"",
                                                 ";",
                                                 ".",
                                                 "touch.held",
                                                 "name=\"hold\"",
                                                 "class=\"c\"",
                                                 "<!DOCTYPE a>",
                                                 "<stack/>",
                                                 std::string(1, '\0')};
    const std::size_t at = pick(text.size()), length = 1 + pick(60);
    switch (pick(7)) {
      case 0: text[at] = static_cast<char>(random_()); break;
      case 1: text.erase(at, 1); break;
      case 2: text.erase(at, length); break;
      case 3: text.insert(at, text.substr(at, length)); break;
      case 4: text.insert(pick(text.size()), text.substr(at, length)); break;
      case 5: text.insert(at, pieces[pick(pieces.size())]); break;
      default: text.resize(at); break;
    }
  }

  std::mt19937 random_;
};

TEST(Mutants, OfStacksAreReadOrRefusedAtAPlace) {
  control::Registry registry = makeRegistry();
  dsl::ReadOptions options = readOptions();
  options.load_plugin = [](const std::string&) {};                 // what it would bring stays unknown
  const std::vector<std::string> files = everyStack();
  ASSERT_GE(files.size(), 10u);
  int refused = 0, count = 0;
  Mutator mutate(20);
  for (const std::string& name : files) {
    const std::string original = contentOf(name);
    for (std::size_t i = 0; i < 10000 / files.size() + 1; ++i, ++count) {
      const std::string mutant = mutate(original);
      const std::string file = writeFile("mutant.xml", mutant);
      try {
        const dsl::Stack stack = dsl::readStack(file, registry, options);
        dsl::readStack(writeFile("resolved.xml", dsl::writeResolved(stack)), registry, options);
      } catch (const dsl::InvalidStack& invalid) {
        ++refused;
        EXPECT_EQ(lackOf(invalid, file, mutant), "") << mutant;
      }
    }
  }
  EXPECT_GE(count, 10000);
  EXPECT_GT(refused, count / 2);
}

TEST(Mutants, OfAStackThatIsValidCompileOrAreRefused) {
  control::Registry registry = makeRegistry();
  Mutator mutate(21);
  const std::string original = smallStack(
      "<signals><test.probe name=\"a\"/><test.probe name=\"b\" from=\"a.value\"/></signals>\n"
      "<level priority=\"1\" strict=\"true\"><test.pull name=\"p\" frame=\"flange\" joints=\"arm\" from=\"b.value\"/>\n"
      "<posture name=\"q\" joints=\"a1 a2\" stiffness=\"2\"/></level>");
  int compiled = 0;
  for (int i = 0; i < 500; ++i) {
    const std::string mutant = mutate(original);
    const std::string file = writeFile("mutant.xml", mutant);
    try {
      const dsl::Stack stack = dsl::readStack(file, registry, readOptions());
      compiled += dsl::compile(stack, registry) != nullptr;
    } catch (const dsl::InvalidStack& invalid) {
      EXPECT_EQ(lackOf(invalid, file, mutant), "") << mutant;
    }
  }
  EXPECT_GT(compiled, 0);
}

TEST(Mutants, OfRobotsAreReadOrRefusedAtAPlace) {
  Mutator mutate(22);
  for (const char* name : {"/models/lwr_4plus.urdf", "/tests/dsl/broken/coupled.urdf", "/tests/dsl/broken/ball.urdf"}) {
    const std::string original = contentOf(std::string(TACTUS_SOURCE_DIR) + name);
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
      const std::string mutant = mutate(original);
      const std::string file = writeFile("mutant.urdf", mutant);
      std::vector<dsl::Diagnostic> warnings;
      try {
        dsl::readRobot(file, warnings);
      } catch (const dsl::InvalidStack& invalid) {
        ++refused;
        EXPECT_EQ(lackOf(invalid, file, mutant), "") << mutant;
      }
    }
    EXPECT_GT(refused, 100) << name;
  }
}

}  // namespace
}  // namespace tactus::dsl_test
