// Real libraries, each wrong in one way (plugins/faulty_plugin.cc).  Every refusal is tested for its text: it names
// both values and leaves the registry as it was.

#include "framework/runtime/plugin_loader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/runtime/temporary_folder.h"

namespace tactus::runtime {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string library(const std::string& fault) { return std::string(TEST_PLUGINS) + "/" + fault + ".so"; }

class PluginLoaderTest : public ::testing::Test {
 protected:
  /// What loading the file says; "" when it is accepted.
  std::string refusalOf(const std::string& path) {
    try {
      loader.loadFile(path);
    } catch (const PluginError& error) {
      EXPECT_TRUE(registry.elements().rows().empty()) << "a refused plugin left something behind";
      return error.what();
    }
    return "";
  }

  control::Registry registry;
  PluginLoader loader{registry, {TEST_PLUGINS}};
};

TEST_F(PluginLoaderTest, GoodPluginRegistersItsElements) {
  const LoadedPlugin& plugin = loader.loadFile(library("good"));
  EXPECT_EQ(plugin.name, "good");
  EXPECT_EQ(plugin.version, "1.2.3");
  EXPECT_EQ(plugin.licence, "BSD-3-Clause");
  EXPECT_EQ(plugin.elements, std::vector<std::string>{"good.idle"});
  ASSERT_NE(registry.elements().findBackEnd("good.idle"), nullptr);
  const control::ElementValues values = control::makeValues(*registry.elements().findBackEnd("good.idle"));
  EXPECT_NE(registry.makeBackEnd(values), nullptr);
}

TEST_F(PluginLoaderTest, LoadingTwiceIsLoadingOnce) {
  EXPECT_EQ(&loader.loadFile(library("good")), &loader.loadNamed("good"));
  EXPECT_EQ(loader.loaded().size(), 1u);
}

TEST_F(PluginLoaderTest, LinksAreFollowed) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_symlink(library("good"), folder.file("link.so"));
  EXPECT_EQ(loader.loadFile(folder.file("link.so")).path, std::filesystem::canonical(library("good")).string());
}

TEST_F(PluginLoaderTest, MissingFile) {
  EXPECT_EQ(refusalOf("/nowhere/x.so"), "plugin library /nowhere/x.so: no such file");
}

TEST_F(PluginLoaderTest, FolderInsteadOfFile) { EXPECT_THAT(refusalOf(TEST_PLUGINS), HasSubstr("is not a file")); }

TEST_F(PluginLoaderTest, NotALibrary) {
  const testing::TemporaryFolder folder;
  EXPECT_THAT(refusalOf(folder.write("text.so", "not a library")), HasSubstr("cannot be loaded: "));
}

TEST_F(PluginLoaderTest, NoEntrySymbol) {
  EXPECT_THAT(refusalOf(library("nosymbol")),
              AllOf(HasSubstr("has no function 'tactus_plugin'"), HasSubstr("write TACTUS_PLUGIN(")));
}

TEST_F(PluginLoaderTest, UndefinedSymbol) {
  EXPECT_THAT(refusalOf(library("undefined")),
              AllOf(HasSubstr("cannot be loaded: "), HasSubstr("undefined symbol: "),
                    HasSubstr("functionOfAnotherLibrary"), HasSubstr("; link what defines it into the plugin")));
}

TEST_F(PluginLoaderTest, ThrowingEntryFunction) {
  EXPECT_THAT(refusalOf(library("entry_throw")), HasSubstr("its entry function threw: the dongle is missing"));
  EXPECT_THAT(refusalOf(library("entry_throw_other")),
              HasSubstr("its entry function threw something that is not a std::exception"));
}

TEST_F(PluginLoaderTest, DescriptorWithoutTexts) {
  EXPECT_THAT(refusalOf(library("nullcompiler")), HasSubstr("its descriptor has no compiler"));
  EXPECT_THAT(refusalOf(library("nullversion")), HasSubstr("its descriptor has no version"));
  EXPECT_THAT(refusalOf(library("nulllicence")), HasSubstr("its descriptor has no licence"));
}

TEST_F(PluginLoaderTest, NoDescriptor) {
  EXPECT_THAT(refusalOf(library("nodescriptor")), HasSubstr("its entry function returned no descriptor"));
}

TEST_F(PluginLoaderTest, WrongMagic) {
  EXPECT_THAT(refusalOf(library("magic")),
              HasSubstr("the magic number 0x6d616c6963650001, expected 0x7461637475730001; it is not a Tactus plugin"));
}

TEST_F(PluginLoaderTest, WrongAbi) {
  EXPECT_THAT(refusalOf(library("abi")),
              HasSubstr("built with plugin ABI 99, but this program has " +
                        std::to_string(plugin_abi) + "; rebuild it against this Tactus"));
}

TEST_F(PluginLoaderTest, WrongSize) {
  EXPECT_THAT(refusalOf(library("size")), HasSubstr("built with a descriptor of 8 bytes, but this program has " +
                                                    std::to_string(sizeof(PluginDescriptor)) + " bytes"));
}

TEST_F(PluginLoaderTest, WrongFrameworkVersion) {
  EXPECT_THAT(refusalOf(library("framework")),
              HasSubstr("built with Tactus 0.0.1, but this program has " TACTUS_VERSION "; rebuild it"));
}

TEST_F(PluginLoaderTest, WrongCompiler) {
  EXPECT_THAT(refusalOf(library("compiler")),
              HasSubstr("built with compiler 'clang 99', but this program has '" TACTUS_COMPILER_ID "'"));
}

TEST_F(PluginLoaderTest, WrongEigenVersion) {
  EXPECT_THAT(refusalOf(library("eigen")), HasSubstr("built with Eigen 3.3.9, but this program has 3.4."));
}

TEST_F(PluginLoaderTest, WrongEigenAlignment) {
  EXPECT_THAT(refusalOf(library("align")),
              AllOf(HasSubstr("an Eigen alignment of 64 bytes, but this program has " +
                              std::to_string(EIGEN_MAX_ALIGN_BYTES) + " bytes"),
                    HasSubstr("without -march=native")));
}

TEST_F(PluginLoaderTest, NoName) { EXPECT_THAT(refusalOf(library("noname")), HasSubstr("its name is empty")); }

TEST_F(PluginLoaderTest, NoRegisterFunction) {
  EXPECT_THAT(refusalOf(library("noregister")), HasSubstr("its descriptor has no register function"));
}

TEST_F(PluginLoaderTest, ThrowingRegistrationLeavesNothing) {
  EXPECT_THAT(
      refusalOf(library("standard_throw")),
      HasSubstr("registration of plugin 'good' failed, nothing of it is kept: the licence server is on holiday"));
  EXPECT_THAT(refusalOf(library("other_throw")), HasSubstr("it threw something that is not a std::exception"));
}

TEST_F(PluginLoaderTest, ElementRegisteredTwiceLeavesNothing) {
  EXPECT_THAT(refusalOf(library("duplicate")), AllOf(HasSubstr("registration of plugin 'duplicate' failed"),
                                                     HasSubstr("duplicate.idle")));
}

TEST_F(PluginLoaderTest, FailureHalfwayKeepsWhatWasThereBefore) {
  control::ElementRow taken;
  taken.name = "halfway.taken";
  taken.kind = control::ElementKind::back_end;
  taken.description = "Was here first.";
  registry.addBackEnd(taken, [](const control::ElementValues&) { return nullptr; });
  EXPECT_THROW(loader.loadFile(library("halfway")), PluginError);
  EXPECT_EQ(registry.elements().findBackEnd("halfway.idle"), nullptr);
  ASSERT_NE(registry.elements().findBackEnd("halfway.taken"), nullptr);
  EXPECT_EQ(registry.elements().findBackEnd("halfway.taken")->description, "Was here first.");
}

TEST_F(PluginLoaderTest, ElementsCarryTheirPluginsName) {
  EXPECT_THAT(refusalOf(library("bare")),
              HasSubstr("bare.so: registers the element 'idle', nothing of it is kept: elements of the plugin 'good' "
                        "begin with 'good.'; call it 'good.idle'"));
  EXPECT_THAT(refusalOf(library("stranger")), HasSubstr("registers the element 'other.idle'"));
}

TEST_F(PluginLoaderTest, ShippedPluginsNameTheirElementsFreely) {
  PluginLoader with_shipped(registry, {}, TEST_PLUGINS);
  EXPECT_EQ(with_shipped.loadFile(library("bare")).elements, std::vector<std::string>{"idle"});
}

TEST_F(PluginLoaderTest, TwoPluginsOfOneName) {
  loader.loadFile(library("good"));
  try {
    loader.loadFile(library("twin"));
    FAIL() << "the second one was accepted";
  } catch (const PluginError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("twin.so: the name 'good' is taken by "), HasSubstr("good.so")));
  }
}

TEST_F(PluginLoaderTest, UnknownNameListsEveryPathTried) {
  PluginLoader two(registry, {"/first", "/second"});
  try {
    two.loadNamed("acme");
    FAIL() << "found a plugin that does not exist";
  } catch (const PluginError& error) {
    EXPECT_STREQ(
        error.what(),
        "plugin 'acme' was not found; tried:\n  /first/acme.so: no such file\n  /second/acme.so: no such file\n"
        "name its library with --plugin FILE, or its folder in TACTUS_PLUGIN_PATH");
  }
}

TEST_F(PluginLoaderTest, RefusedNameListsPathsAndReason) {
  PluginLoader two(registry, {"/first", TEST_PLUGINS});
  try {
    two.loadNamed("abi");
    FAIL() << "a wrong ABI was accepted";
  } catch (const PluginError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("plugin 'abi' cannot be used"), HasSubstr("/first/abi.so: no such file"),
                                    HasSubstr("abi.so: refused"), HasSubstr("plugin ABI 99")));
  }
}

TEST_F(PluginLoaderTest, AStackNamesPluginsNeverPaths) {
  for (const std::string name : {"../evil", "/tmp/evil", ""}) {
    try {
      loader.loadNamed(name);
      FAIL() << "'" << name << "' was taken as a name";
    } catch (const PluginError& error) {
      EXPECT_THAT(error.what(), HasSubstr("a stack names plugins, never library paths"));
    }
  }
}

TEST_F(PluginLoaderTest, NameMustBeThePluginsOwn) {
  try {
    loader.loadNamed("twin");
    FAIL() << "twin.so calls itself 'good'";
  } catch (const PluginError& error) {
    EXPECT_THAT(error.what(), HasSubstr("it calls itself 'good', not 'twin'"));
  }
}

TEST_F(PluginLoaderTest, FolderIsLoadedInTheOrderOfNames) {
  const testing::TemporaryFolder folder;
  std::filesystem::copy(library("good"), folder.file("good.so"));
  folder.write("notes.txt", "no library");
  loader.loadFolder(folder.path());
  ASSERT_EQ(loader.loaded().size(), 1u);
  EXPECT_EQ(loader.loaded().front().name, "good");
}

TEST_F(PluginLoaderTest, NamedPluginGoesBeforeTheFolders) {
  const testing::TemporaryFolder folder;
  std::filesystem::copy(library("good"), folder.file("good.so"));
  loader.loadFile(library("good"));
  loader.loadFolder(folder.path());
  ASSERT_EQ(loader.loaded().size(), 1u);
  EXPECT_THAT(loader.loaded().front().path, Not(HasSubstr(folder.path())));
}

TEST_F(PluginLoaderTest, MissingFolderHoldsNoPlugins) {
  loader.loadFolder("/nowhere");
  EXPECT_TRUE(loader.loaded().empty());
}

}  // namespace
}  // namespace tactus::runtime
