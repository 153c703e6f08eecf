#include <algorithm>
#include <filesystem>
#include <iostream>
#include <set>

#include "apps/tactus/command.h"
#include "apps/tactus/program.h"
#include "apps/tactus/templates.h"
#include "apps/tactus/text.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/program_path.h"

namespace tactus::app {
namespace {

namespace fs = std::filesystem;

/// What an element's prefix may be: "acme" of <acme.reach>.
bool isName(std::string_view name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto inside = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
  return !name.empty() && letter(name.front()) && std::all_of(name.begin(), name.end(), inside);
}

void checkName(const std::string& name) {
  if (!isName(name)) {
    throw UsageError("'" + name + "' is not a name: it begins with a letter, and letters, digits, '_' and '-' follow");
  }
}

/// Names that a plugin cannot have: those of the shipped ones, and what CMake keeps for itself.
void checkFree(const std::string& name) {
  static const std::set<std::string> of_cmake{"all",     "clean", "codegen", "edit_cache", "help",
                                              "install", "list_install_components", "package", "package_source",
                                              "rebuild_cache", "test"};
  if (of_cmake.contains(name))
    throw UsageError("a plugin cannot be called '" + name + "': CMake has a target of that name");
  Program program(std::vector<std::string>{});
  for (const runtime::LoadedPlugin& plugin : program.plugins().loaded())
    if (plugin.name == name) throw UsageError("'" + name + "' is a plugin that Tactus ships; take another name");
}

/// Where find_package finds this Tactus: in its build tree or where it is installed.
std::string packageFolder() {
  const fs::path root = fs::path(runtime::shippedModelFolder()).parent_path().parent_path().parent_path();
  for (const fs::path& folder : {root, root / TACTUS_LIBDIR "/cmake/Tactus", root / "lib/cmake/Tactus"})
    if (fs::exists(folder / "TactusConfig.cmake")) return folder.string();
  return "/usr/lib/cmake/Tactus";
}

std::string filled(std::string text, const std::string& name) {
  const auto replace = [&](std::string_view word, const std::string& by) {
    for (size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += by.size())
      text.replace(at, word.size(), by);
  };
  replace("@NAME@", name);
  replace("@TACTUS_DIR@", packageFolder());
  return text;
}

[[noreturn]] void refuseExisting(const fs::path& path) {
  throw runtime::FileError(path.string(), "is there already; give another name, or another folder with --out");
}

void writeTemplate(const Template& file, const fs::path& to, const std::string& name) {
  runtime::writeFile(to.string(), filled(file.content, name));
  std::cout << to.string() << "\n";
}

/// `out` as it is asked for, which must be there.
fs::path folderOf(const std::string& out) {
  if (!fs::is_directory(out)) throw runtime::FileError(out, "is not a folder");
  return out == "." ? fs::path() : fs::path(out);
}

int newPlugin(const std::string& name, const std::string& out) {
  checkName(name);
  checkFree(name);
  const fs::path folder = folderOf(out) / name;
  if (fs::exists(fs::symlink_status(folder))) refuseExisting(folder);
  std::error_code error;
  if (!fs::create_directory(folder, error)) throw runtime::FileError(folder.string(), "cannot be made", error.value());
  try {
    for (const Template& file : templates()) {
      const fs::path path = file.path;
      if (*path.begin() == "plugin") writeTemplate(file, folder / path.filename(), name);
    }
  } catch (...) {
    fs::remove_all(folder, error);
    throw;
  }
  std::cerr << "next: cd " << folder.string() << "; README.md has the commands that build, test and run it\n";
  return exit_done;
}

int newStack(const std::string& name, const std::string& out) {
  checkName(name);
  const fs::path file = folderOf(out) / (name + ".xml");
  if (fs::exists(fs::symlink_status(file))) refuseExisting(file);
  for (const Template& each : templates())
    if (std::string_view(each.path) == "stack/stack.xml") writeTemplate(each, file, name);
  std::cerr << "next: tactus run " << file.string() << "\n";
  return exit_done;
}

using Make = int (*)(const std::string& name, const std::string& out);

void addKind(CLI::App& command, Context& context, const char* kind, const char* what, Make make) {
  CLI::App* kind_command = command.add_subcommand(kind, what);
  const auto name = std::make_shared<std::string>();
  const auto out = std::make_shared<std::string>(".");
  kind_command->add_option("NAME", *name, "Begins with a letter; letters, digits, '_' and '-' follow")
      ->required()
      ->type_name("");
  kind_command->add_option("--out", *out, "The folder in which it is made; the working one without it")
      ->type_name("DIR");
  kind_command->footer(command.get_footer());
  kind_command->callback([=, &context] { context.action = [=] { return make(*name, *out); }; });
}

}  // namespace

void addNew(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("new", "A plugin or a stack to begin with, which works as it is");
  command->require_subcommand(0, 1);
  command->footer(R"(Nothing is overwritten; what is there already is refused (exit code 6).

Examples:
  tactus new plugin acme
  tactus new stack first --out stacks)");
  addKind(*command, context, "plugin", "A folder with a task, its test, a stack, CMakeLists.txt and README.md",
          newPlugin);
  addKind(*command, context, "stack", "A stack that lifts an arm: NAME.xml", newStack);
}

}  // namespace tactus::app
