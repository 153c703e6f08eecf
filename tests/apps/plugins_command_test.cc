#include <gmock/gmock.h>

#include <filesystem>

#include "framework/runtime/version.h"
#include "framework/runtime/plugin_api.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::HasSubstr;

std::string library(const std::string& name) { return std::string(TEST_PLUGINS) + "/" + name + ".so"; }

const nlohmann::json* find(const nlohmann::json& plugins, const std::string& name) {
  for (const nlohmann::json& plugin : plugins) {
    if (plugin["name"] == name) return &plugin;
  }
  return nullptr;
}

TEST(PluginsCommand, ShippedPluginsAreListed) {
  const Outcome outcome = tactus({"plugins", "list", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json plugins = outcome.json()["plugins"];
  for (const char* name : {"bump-estimate", "null-space", "qp"}) {
    const nlohmann::json* plugin = find(plugins, name);
    ASSERT_TRUE(plugin) << name;
    EXPECT_EQ((*plugin)["elements"], nlohmann::json({name}));
    EXPECT_EQ((*plugin)["version"], TACTUS_VERSION);
  }
}

TEST(PluginsCommand, ExplicitPluginIsLoaded) {
  const nlohmann::json plugins = tactus({"plugins", "list", "--json", "--plugin", library("good")}).json()["plugins"];
  ASSERT_TRUE(find(plugins, "good"));
  EXPECT_EQ((*find(plugins, "good"))["version"], "1.2.3");
}

TEST(PluginsCommand, FoldersAreListedToo) {
  const TemporaryFolder folder;
  std::filesystem::copy(library("good"), folder.file("good.so"));
  Settings with_path;
  with_path.environment = {"TACTUS_PLUGIN_PATH=" + folder.path()};
  EXPECT_TRUE(find(tactus({"plugins", "list", "--json"}, with_path).json()["plugins"], "good"));
  const Outcome outcome = tactus({"plugins", "list", "--json", "--plugin", folder.path()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(find(outcome.json()["plugins"], "good"));
}

TEST(PluginsCommand, RefusedLibrariesOfAFolderAreTold) {
  const TemporaryFolder folder;
  std::filesystem::copy(library("abi"), folder.file("abi.so"));
  std::filesystem::copy(library("good"), folder.file("good.so"));
  const Outcome outcome = tactus({"plugins", "list", "--json", "--plugin", folder.path()});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_TRUE(find(outcome.json()["plugins"], "good"));
  EXPECT_THAT(outcome.json()["refused"].at(0).get<std::string>(), HasSubstr("plugin ABI 99"));
  EXPECT_THAT(outcome.err, HasSubstr("abi.so: built with plugin ABI 99"));
}

TEST(PluginsCommand, ElementsWithoutTheirPluginsNameAreRefused) {
  const Outcome outcome = tactus({"plugins", "list", "--plugin", library("bare")});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("elements of the plugin 'good' begin with 'good.'; call it 'good.idle'"));
}

TEST(PluginsCommand, WrongPluginIsExitFour) {
  const Outcome outcome = tactus({"plugins", "list", "--plugin", library("abi")});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("built with plugin ABI 99, but this program has " + std::to_string(runtime::plugin_abi)));
}

TEST(PluginsCommand, MissingPluginIsExitFour) {
  const Outcome outcome = tactus({"plugins", "list", "--plugin", "/nowhere/acme.so"});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("plugin library /nowhere/acme.so: no such file"));
}

TEST(PluginsCommand, AStackFindsPluginsByNameInThePath) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "<robot", "<plugin name=\"halfway\"/>\n  <robot");
  EXPECT_EQ(tactus({"check", stack}).exit_code, 4);
  Settings with_path;
  with_path.environment = {std::string("TACTUS_PLUGIN_PATH=") + TEST_PLUGINS};
  EXPECT_EQ(tactus({"check", stack}, with_path).exit_code, 0);
  EXPECT_EQ(tactus({"check", stack, "--plugin", TEST_PLUGINS}).exit_code, 0);
}

TEST(PluginsInfo, TellsTheHandshakeAndTheElements) {
  const Outcome outcome = tactus({"plugins", "info", LAWLESS, "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json info = outcome.json();
  EXPECT_EQ(info["name"], "lawless");
  EXPECT_EQ(info["abi"], runtime::plugin_abi);
  EXPECT_EQ(info["eigen_max_align"], 16);
  EXPECT_EQ(info["elements"][0]["name"], "lawless.good");
  const nlohmann::json* target = find(info["elements"][0]["attributes"], "target");
  ASSERT_TRUE(target);
  EXPECT_EQ((*target)["unit"], "m");
  EXPECT_EQ((*target)["default"], "0.6 0.1 0.3");

  const std::string text = tactus({"plugins", "info", LAWLESS}).out;
  EXPECT_THAT(text, HasSubstr("lawless 1.0.0"));
  EXPECT_THAT(text, HasSubstr("  target: 3 numbers; m; default 0.6 0.1 0.3\n      World axes.\n"));
}

TEST(PluginsInfo, KnowsPluginsByName) {
  EXPECT_THAT(tactus({"plugins", "info", "bump-estimate"}).out, HasSubstr("<bump-estimate>: Finds a round bump"));
  const Outcome built_in = tactus({"plugins", "info", "built-in"});
  EXPECT_THAT(built_in.out, HasSubstr("<impedance>: "));
  EXPECT_THAT(built_in.out, ::testing::Not(HasSubstr("bump-estimate")));
  const Outcome unknown = tactus({"plugins", "info", "acme"});
  EXPECT_EQ(unknown.exit_code, 4);
  EXPECT_THAT(unknown.err, HasSubstr("plugin 'acme' was not found; tried:\n"));
}

TEST(PluginsCheck, BrokenLawsAreExitOne) {
  const Outcome outcome =
      tactus({"plugins", "check", LAWLESS, "--stack", TACTUS_SOURCE_DIR "/tests/conformance/lawless.xml"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("<lawless.jacobian> 'jacobian'\n  broken: jacobian: row 1, joint 'a2': J says "));
  EXPECT_THAT(outcome.out, HasSubstr("\ndoes not conform\n"));
}

TEST(PluginsCheck, SaysItAllAsJson) {
  const Outcome outcome = tactus({"plugins", "check", LAWLESS, "--json"});
  EXPECT_EQ(outcome.exit_code, 1);
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["plugin"], "lawless");
  EXPECT_EQ(json["conforms"], false);
  int broken = 0;
  for (const nlohmann::json& finding : json["findings"]) {
    EXPECT_TRUE(finding.contains("instance") && finding.contains("law") && finding.contains("message"));
    broken += finding["outcome"] == "broken";
  }
  EXPECT_GE(broken, 15);
}

TEST(PluginsCheck, WhatConformsIsExitZero) {
  const Outcome outcome = tactus({"plugins", "check", "null-space"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("\nconforms\n"));
}

TEST(PluginsCheck, WhatCannotBeLoadedIsExitFour) {
  EXPECT_EQ(tactus({"plugins", "check", library("abi")}).exit_code, 4);
  EXPECT_EQ(tactus({"plugins", "check", "/nowhere/acme.so"}).exit_code, 4);
  EXPECT_EQ(tactus({"plugins", "check", TEST_PLUGINS}).exit_code, 4);
  EXPECT_EQ(tactus({"plugins", "check"}).exit_code, 2);
}

}  // namespace
}  // namespace tactus::testing
