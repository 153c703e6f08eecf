#pragma once

#include <span>

namespace tactus::app {

/// A file of apps/tactus/templates, built into the program.
struct Template {
  const char* path;                                                ///< below templates: "plugin/reach.cc"
  const char* content;                                             ///< with @NAME@ and @TACTUS_DIR@
};

std::span<const Template> templates();

}  // namespace tactus::app
