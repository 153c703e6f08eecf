#include "framework/runtime/program_path.h"

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace tactus::runtime {
namespace fs = std::filesystem;

std::string programFolder() { return fs::canonical("/proc/self/exe").parent_path().string(); }

std::string shippedPluginFolder() {
  const fs::path root = fs::path(programFolder()).parent_path();
  // Debian's multiarch installs below lib/<triplet>; every other tree, the build tree too, below lib.
  const fs::path installed = root / TACTUS_INSTALL_LIBDIR / "tactus" / "plugins";
  return (fs::exists(installed) ? installed : root / "lib" / "tactus" / "plugins").string();
}

std::string shippedModelFolder() {
  return (fs::path(programFolder()).parent_path() / "share" / "tactus" / "models").string();
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
