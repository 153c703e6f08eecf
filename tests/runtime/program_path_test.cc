#include "framework/runtime/program_path.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>

namespace tactus::runtime {
namespace {

TEST(ProgramPath, IsTheFolderOfThisTest) {
  EXPECT_TRUE(std::filesystem::exists(programFolder() + "/test_runtime")) << programFolder();
}

TEST(ProgramPath, PluginsAndModelsStandBesideTheProgram) {
  const std::filesystem::path root = std::filesystem::path(programFolder()).parent_path();
  EXPECT_EQ(shippedPluginFolder(), (root / "lib/tactus/plugins").string());
  EXPECT_EQ(shippedModelFolder(), (root / "share/tactus/models").string());
}

TEST(ProgramPath, FoldersOfAVariable) {
  ::setenv("TACTUS_TEST_FOLDERS", "/a:/b/c::/d", 1);
  EXPECT_EQ(foldersFromEnvironment("TACTUS_TEST_FOLDERS"), (std::vector<std::string>{"/a", "/b/c", "/d"}));
  ::setenv("TACTUS_TEST_FOLDERS", "", 1);
  EXPECT_TRUE(foldersFromEnvironment("TACTUS_TEST_FOLDERS").empty());
  ::unsetenv("TACTUS_TEST_FOLDERS");
  EXPECT_TRUE(foldersFromEnvironment("TACTUS_TEST_FOLDERS").empty());
}

}  // namespace
}  // namespace tactus::runtime
