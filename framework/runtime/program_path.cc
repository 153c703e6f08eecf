#include "framework/runtime/program_path.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace tactus::runtime {
namespace fs = std::filesystem;

std::string programFolder() { return fs::canonical("/proc/self/exe").parent_path().string(); }

namespace {

/// Where bin, lib and share stand: beside the program, or, of a program from elsewhere such as a plugin's own test,
/// above this library.
fs::path root() {
  const fs::path beside = fs::path(programFolder()).parent_path();
  if (fs::exists(beside / "share" / "tactus")) return beside;
  Dl_info library;
  if (::dladdr(reinterpret_cast<const void*>(&programFolder), &library) == 0) return beside;
  std::error_code none;
  for (fs::path folder = fs::canonical(library.dli_fname, none); folder.has_relative_path();) {
    folder = folder.parent_path();
    if (fs::exists(folder / "share" / "tactus")) return folder;
  }
  return beside;
}

}  // namespace

std::string shippedPluginFolder() {
  const fs::path root = runtime::root();
  // Debian's multiarch installs below lib/<triplet>; every other tree, the build tree too, below lib.
  const fs::path installed = root / TACTUS_INSTALL_LIBDIR / "tactus" / "plugins";
  return (fs::exists(installed) ? installed : root / "lib" / "tactus" / "plugins").string();
}

std::string shippedModelFolder() {
  return (root() / "share" / "tactus" / "models").string();
}

std::vector<std::string> foldersFromEnvironment(const char* name) {
  std::vector<std::string> folders;
  const char* value = std::getenv(name);
  std::string_view rest = value ? value : "";
  while (!rest.empty()) {
    const size_t colon = rest.find(':');
    if (colon != 0) folders.emplace_back(rest.substr(0, colon));
    rest.remove_prefix(colon == std::string_view::npos ? rest.size() : colon + 1);
  }
  return folders;
}

}  // namespace tactus::runtime
