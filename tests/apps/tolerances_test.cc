#include "apps/tactus/tolerances.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/runtime/file_error.h"
#include "tests/runtime/temporary_folder.h"

namespace tactus::app {
namespace {

using ::testing::HasSubstr;
using tactus::testing::TemporaryFolder;

std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  try {
    readTolerances(folder.write("tolerances.xml", content));
  } catch (const runtime::FileError& error) {
    return error.what();
  }
  return "";
}

TEST(Tolerances, InTheirOrder) {
  const TemporaryFolder folder;
  const auto tolerances = readTolerances(folder.write(
      "t.xml", "<tolerances><tolerance columns='*' atol='1e-6'/><tolerance columns='q/*' rtol='0.5'/></tolerances>"));
  ASSERT_EQ(tolerances.size(), 2u);
  EXPECT_EQ(tolerances[0].columns, "*");
  EXPECT_EQ(tolerances[0].atol, 1e-6);
  EXPECT_EQ(tolerances[0].rtol, 0);
  EXPECT_EQ(tolerances[1].rtol, 0.5);
}

TEST(Tolerances, DefaultsReadBack) {
  const TemporaryFolder folder;
  EXPECT_EQ(readTolerances(folder.write("t.xml", defaultTolerances())).size(), 1u);
}

TEST(Tolerances, SayWhatIsWrongAndWhere) {
  EXPECT_THAT(refusal("<tolerances>\n<tolerance columns='*' atol='1.5abc'/></tolerances>"),
              HasSubstr("line 2: atol=\"1.5abc\" is not a number ≥ 0"));
  EXPECT_THAT(refusal("<tolerances><tolerance columns='*' atol='-1'/></tolerances>"), HasSubstr("is not a number ≥ 0"));
  EXPECT_THAT(refusal("<tolerances><tolerance atol='1'/></tolerances>"), HasSubstr("needs columns"));
  EXPECT_THAT(refusal("<tolerances><tolerence/></tolerances>"), HasSubstr("<tolerence>: expected <tolerance>"));
  EXPECT_THAT(refusal("<stack/>"), HasSubstr("expected the element <tolerances>"));
  EXPECT_THAT(refusal("<tolerances>"), HasSubstr("is not well-formed XML"));
}

}  // namespace
}  // namespace tactus::app
