// Names that elements and attributes once had: read with a warning, rewritten by migrate, nothing else touched.

#include "dsl/upgrade.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dsl/source_text.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

using control::ValueType;
using testing::ElementsAre;
using testing::HasSubstr;

/// <test.nudge stiffness> was once <test.shove spring>; back end 'all' has an option that was once 'tol'.
control::Registry renamedRegistry() {
  control::Registry registry = makeRegistry();
  control::ElementRow row{.name = "test.nudge",
                          .kind = control::ElementKind::task,
                          .description = "Pushes a little.",
                          .attributes = {{.name = "stiffness", .type = ValueType::real, .unit = "N/m",
                                          .default_text = "1", .formerly = {"spring", "k"}},
                                         {.name = "old", .type = ValueType::real, .unit = "N",
                                          .deprecated = "write 'stiffness'"}},
                          .formerly = {"test.shove"}};
  registry.addTask(row, [](const control::BuildContext&) { return nullptr; });
  return registry;
}

std::vector<std::string> said(const std::vector<dsl::Diagnostic>& diagnostics) {
  std::vector<std::string> found;
  for (const auto& diagnostic : diagnostics)
    found.push_back(std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column) + " " +
                    diagnostic.code + " " + diagnostic.message);
  return found;
}

const std::string old_level =
    "<!-- kept -->\n<level priority=\"1\"><test.shove  name='a'\n   spring=\"3\" ></test.shove><test.nudge name=\"b\" k=\"4\"/></level>";

TEST(Upgrade, FormerNamesAreReadWithAWarning) {
  control::Registry registry = renamedRegistry();
  std::vector<dsl::Diagnostic> warnings;
  const dsl::Stack stack = dsl::readStack(writeFile("stack.xml", smallStack(old_level)), registry, readOptions(), &warnings);
  ASSERT_EQ(stack.levels[0].tasks.size(), 2u);
  EXPECT_EQ(stack.levels[0].tasks[0].values.real("stiffness"), 3);
  EXPECT_EQ(stack.levels[0].tasks[1].values.real("stiffness"), 4);
  EXPECT_THAT(said(warnings),
              ElementsAre("4:21 W012 <test.shove> is called <test.nudge> now; 'tactus migrate' rewrites it",
                          "5:4 W012 attribute 'spring' is called 'stiffness' now; 'tactus migrate' rewrites it",
                          "5:50 W012 attribute 'k' is called 'stiffness' now; 'tactus migrate' rewrites it"));
}

TEST(Upgrade, MigrateRewritesNamesAndNothingElse) {
  const control::Registry registry = renamedRegistry();
  const std::string inner = writeFile("inner.xml", "<level><test.shove name=\"c\"/> <!-- as it was --></level>");
  const std::string text = smallStack("<level priority=\"1\"><include file=\"inner.xml\"/><test.nudge k=\"1\"  name='b'/></level>");
  const std::string file = writeFile("stack.xml", text);
  const dsl::Migration migration = dsl::migrate(file, registry, {});
  ASSERT_EQ(migration.files.size(), 2u);
  EXPECT_EQ(migration.files.at(inner), "<level><test.nudge name=\"c\"/> <!-- as it was --></level>");
  std::string wanted = text;
  wanted.replace(wanted.find(" k=\"1\""), 2, " stiffness");
  EXPECT_EQ(migration.files.at(file), wanted);
  EXPECT_EQ(migration.changes.size(), 2u);
  EXPECT_TRUE(dsl::migrate(writeFile("new.xml", wanted), registry, {}).changes.size() == 1u) << "the include's alone";
}

TEST(Upgrade, BothNamesAtOnceAreRefused) {
  control::Registry registry = renamedRegistry();
  const std::string text = smallStack("<level priority=\"1\"><test.nudge name=\"b\" k=\"4\" stiffness=\"5\"/></level>");
  try {
    dsl::readStack(writeFile("stack.xml", text), registry, readOptions());
    FAIL() << "was read";
  } catch (const dsl::InvalidStack& invalid) {
    EXPECT_THAT(said(invalid.diagnostics), ElementsAre(HasSubstr("E012 <test.nudge> has no attribute 'k'")));
  }
}

TEST(Upgrade, WhatIsDeprecatedIsWarnedOf) {
  control::Registry registry = renamedRegistry();
  std::vector<dsl::Diagnostic> warnings;
  dsl::readStack(writeFile("stack.xml", smallStack("<level priority=\"1\"><test.nudge name=\"b\" old=\"4\"/></level>")),
                 registry, readOptions(), &warnings);
  EXPECT_THAT(said(warnings), ElementsAre("3:42 W011 attribute 'old' is deprecated: write 'stiffness'"));
}

TEST(Upgrade, TheTableRefusesAFormerNameThatIsTaken) {
  control::Registry registry = renamedRegistry();
  const auto add = [&](control::ElementRow row) { registry.addTask(std::move(row), {}); };
  EXPECT_THROW(add({.name = "test.shove"}), std::invalid_argument);
  EXPECT_THROW(add({.name = "test.other", .formerly = {"test.pull"}}), std::invalid_argument);
  EXPECT_THROW(add({.name = "test.other", .attributes = {{.name = "x", .formerly = {"x"}}}}), std::invalid_argument);
}

}  // namespace
}  // namespace tactus::dsl_test
