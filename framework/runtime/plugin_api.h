#pragma once

#include <cstdint>

#include "framework/control/registry.h"
#include "framework/runtime/version.h"

/// What a plugin library shows to Tactus: one function that returns plain data, checked before any C++ type
/// crosses.  Write TACTUS_PLUGIN("acme", "1.0.0", "BSD-3-Clause", registerElements) once in the library.
namespace tactus::runtime {

inline constexpr std::uint64_t plugin_magic = 0x7461637475730001;  // "tactus", descriptor 1
inline constexpr std::uint32_t plugin_abi = 8;
inline constexpr const char* plugin_entry_symbol = "tactus_plugin";

struct PluginDescriptor {
  std::uint64_t magic;
  std::uint32_t abi;
  std::uint32_t size;                                              ///< sizeof(PluginDescriptor)
  const char* framework_version;
  const char* compiler;                                            ///< __VERSION__ and the libstdc++ ABI
  std::uint32_t eigen_version;
  std::uint32_t eigen_max_align;                                   ///< bytes; differs with -march=native
  const char* name;
  const char* version;
  const char* licence;
  void (*register_elements)(control::Registry&);
};

}  // namespace tactus::runtime

#define TACTUS_STRINGIFY_(x) #x
#define TACTUS_STRINGIFY(x) TACTUS_STRINGIFY_(x)
#define TACTUS_COMPILER_ID __VERSION__ " cxx11abi=" TACTUS_STRINGIFY(_GLIBCXX_USE_CXX11_ABI)
#define TACTUS_EIGEN_VERSION (EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION)

#define TACTUS_PLUGIN(plugin_name, plugin_version, plugin_licence, register_function)                             \
  extern "C" __attribute__((visibility("default"))) const tactus::runtime::PluginDescriptor* tactus_plugin() {    \
    static const tactus::runtime::PluginDescriptor descriptor{tactus::runtime::plugin_magic,                      \
                                                              tactus::runtime::plugin_abi,                        \
                                                              sizeof(tactus::runtime::PluginDescriptor),          \
                                                              TACTUS_VERSION,                                     \
                                                              TACTUS_COMPILER_ID,                                 \
                                                              TACTUS_EIGEN_VERSION,                               \
                                                              EIGEN_MAX_ALIGN_BYTES,                              \
                                                              plugin_name,                                        \
                                                              plugin_version,                                     \
                                                              plugin_licence,                                     \
                                                              register_function};                                 \
    return &descriptor;                                                                                           \
  }
