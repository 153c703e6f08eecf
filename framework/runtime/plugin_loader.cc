#include "framework/runtime/plugin_loader.h"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>

namespace tactus::runtime {
namespace {

namespace fs = std::filesystem;

constexpr const char* library_suffix = ".so";

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw PluginError("plugin library " + path + ": " + reason);
}

std::string quoted(const std::string& text) { return "'" + text + "'"; }

std::string hexadecimal(std::uint64_t value) {
  std::string digits;
  for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[(value >> shift) & 15];
  return "0x" + digits;
}

/// Eigen's version as it is spoken of: 30400 is 3.4.0.
std::string eigenVersion(std::uint32_t version) {
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
}

const PluginDescriptor* openLibrary(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) refuse(path, "no such file");
  if (!fs::is_regular_file(path, error)) refuse(path, "is not a file");
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const std::string reason = ::dlerror();
    const bool undefined = reason.find("undefined symbol") != std::string::npos;
    refuse(path, "cannot be loaded: " + reason +
                     (undefined ? "; link what defines it into the plugin, and rebuild it against this Tactus" : ""));
  }
  void* symbol = ::dlsym(library, plugin_entry_symbol);
  if (!symbol) {
    refuse(path, std::string("has no function '") + plugin_entry_symbol +
                     "', so it is not a Tactus plugin; write TACTUS_PLUGIN(…) once in its sources");
  }
  try {
    return reinterpret_cast<const PluginDescriptor* (*)()>(symbol)();
  } catch (const std::exception& error) {
    refuse(path, std::string("its entry function threw: ") + error.what());
  } catch (...) {
    refuse(path, "its entry function threw something that is not a std::exception");
  }
}

/// Refuses a descriptor that does not fit this program; says both values.
void checkDescriptor(const PluginDescriptor* descriptor, const std::string& path) {
  if (!descriptor) refuse(path, "its entry function returned no descriptor");
  if (descriptor->magic != plugin_magic) {
    refuse(path, "its descriptor has the magic number " + hexadecimal(descriptor->magic) + ", expected " +
                     hexadecimal(plugin_magic) + "; it is not a Tactus plugin");
  }
  const auto rebuild = [&](const std::string& what, const std::string& theirs, const std::string& ours,
                           const std::string& action) {
    refuse(path, "built with " + what + " " + theirs + ", but this program has " + ours + "; " + action);
  };
  if (descriptor->abi != plugin_abi) {
    rebuild("plugin ABI", std::to_string(descriptor->abi), std::to_string(plugin_abi),
            "rebuild it against this Tactus");
  }
  if (descriptor->size != sizeof(PluginDescriptor)) {
    rebuild("a descriptor of", std::to_string(descriptor->size) + " bytes",
            std::to_string(sizeof(PluginDescriptor)) + " bytes", "rebuild it against this Tactus");
  }
  const auto text = [&](const char* field, const char* name) {
    if (!field) refuse(path, std::string("its descriptor has no ") + name);
    return std::string(field);
  };
  if (text(descriptor->framework_version, "framework version") != TACTUS_VERSION) {
    rebuild("Tactus", descriptor->framework_version, TACTUS_VERSION, "rebuild it against this Tactus");
  }
  if (text(descriptor->compiler, "compiler") != TACTUS_COMPILER_ID) {
    rebuild("compiler", quoted(descriptor->compiler), quoted(TACTUS_COMPILER_ID), "rebuild both with one compiler");
  }
  if (descriptor->eigen_version != TACTUS_EIGEN_VERSION) {
    rebuild("Eigen", eigenVersion(descriptor->eigen_version), eigenVersion(TACTUS_EIGEN_VERSION),
            "rebuild both with one Eigen");
  }
  if (descriptor->eigen_max_align != EIGEN_MAX_ALIGN_BYTES) {
    rebuild("an Eigen alignment of", std::to_string(descriptor->eigen_max_align) + " bytes",
            std::to_string(EIGEN_MAX_ALIGN_BYTES) + " bytes",
            "rebuild it without -march=native or other flags that change the vector width");
  }
  if (text(descriptor->name, "name").empty()) refuse(path, "its name is empty");
  text(descriptor->version, "version");
  text(descriptor->licence, "licence");
  if (!descriptor->register_elements) refuse(path, "its descriptor has no register function");
}

/// Two vendors never meet in one name: each element begins with its plugin's.
void checkNames(const control::ElementTable& table, size_t known, const std::string& plugin, const std::string& path) {
  const std::string prefix = plugin + ".";
  for (size_t i = known; i < table.rows().size(); ++i) {
    const std::string& name = table.rows()[i].name;
    if (name.starts_with(prefix)) continue;
    refuse(path, "registers the element '" + name + "', nothing of it is kept: elements of the plugin '" + plugin +
                     "' begin with '" + prefix + "'; call it '" + prefix + name.substr(name.rfind('.') + 1) + "'");
  }
}

void registerInto(control::Registry& registry, const PluginDescriptor& descriptor, bool shipped,
                  const std::string& path) {
  const std::string failed =
      std::string("registration of plugin '") + descriptor.name + "' failed, nothing of it is kept: ";
  control::Registry enlarged = registry;
  try {
    descriptor.register_elements(enlarged);
  } catch (const std::exception& error) {
    refuse(path, failed + error.what());
  } catch (...) {
    refuse(path, failed + "it threw something that is not a std::exception");
  }
  if (!shipped) checkNames(enlarged.elements(), registry.elements().rows().size(), descriptor.name, path);
  registry = std::move(enlarged);
}

}  // namespace

PluginLoader::PluginLoader(control::Registry& registry, std::vector<std::string> folders,
                           const std::string& shipped_folder)
    : registry_(registry), folders_(std::move(folders)) {
  std::error_code none;
  if (!shipped_folder.empty()) shipped_folder_ = fs::canonical(shipped_folder, none).string();
}

const LoadedPlugin* PluginLoader::find(const std::string& name) const {
  const auto found =
      std::find_if(loaded_.begin(), loaded_.end(), [&](const LoadedPlugin& plugin) { return plugin.name == name; });
  return found == loaded_.end() ? nullptr : &*found;
}

const LoadedPlugin& PluginLoader::loadFile(const std::string& path) { return load(path, ""); }

const LoadedPlugin& PluginLoader::load(const std::string& path, const std::string& expected_name) {
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  const std::string library = error ? path : real.string();
  for (const LoadedPlugin& plugin : loaded_) {
    if (plugin.path == library) return plugin;
  }

  const PluginDescriptor* descriptor = openLibrary(library);
  checkDescriptor(descriptor, library);
  if (!expected_name.empty() && descriptor->name != expected_name) {
    refuse(library, std::string("it calls itself '") + descriptor->name + "', not '" + expected_name + "'");
  }
  if (const LoadedPlugin* other = find(descriptor->name)) {
    refuse(library, "the name '" + other->name + "' is taken by " + other->path + "; name only one of the two");
  }
  const size_t known = registry_.elements().rows().size();
  const bool shipped = !shipped_folder_.empty() && fs::path(library).parent_path() == shipped_folder_;
  registerInto(registry_, *descriptor, shipped, library);

  LoadedPlugin plugin{descriptor->name, descriptor->version, descriptor->licence, library, {}, descriptor};
  const auto& rows = registry_.elements().rows();
  for (size_t i = known; i < rows.size(); ++i) plugin.elements.push_back(rows[i].name);
  loaded_.push_back(std::move(plugin));
  return loaded_.back();
}

const LoadedPlugin& PluginLoader::loadNamed(const std::string& name) {
  if (const LoadedPlugin* plugin = find(name)) return *plugin;
  if (name.empty() || name.find('/') != std::string::npos) {
    throw PluginError("'" + name + "' is not the name of a plugin; a stack names plugins, never library paths");
  }
  std::string tried;
  for (const std::string& folder : folders_) {
    const std::string path = (fs::path(folder) / (name + library_suffix)).string();
    std::error_code error;
    if (!fs::exists(path, error)) {
      tried += "\n  " + path + ": no such file";
      continue;
    }
    // The first file of that name decides: a broken one is told, not passed over for another.
    try {
      return load(path, name);
    } catch (const PluginError& refusal) {
      throw PluginError("plugin '" + name + "' cannot be used; tried:" + tried + "\n  " + path + ": refused\n" +
                        refusal.what());
    }
  }
  throw PluginError("plugin '" + name + "' was not found; tried:" + (tried.empty() ? " no folder" : tried) +
                    "\nname its library with --plugin FILE, or its folder in TACTUS_PLUGIN_PATH");
}

void PluginLoader::loadFolder(const std::string& folder) {
  std::error_code error;
  std::vector<fs::path> libraries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == library_suffix) libraries.push_back(entry.path());
  }
  std::sort(libraries.begin(), libraries.end());
  for (const fs::path& library : libraries) {
    if (!find(library.stem().string())) loadFile(library.string());
  }
}

}  // namespace tactus::runtime
