// What Tactus sees of the library: its name, version and licence, and what it adds to the language.

#include "framework/runtime/plugin_api.h"
#include "reach.h"

namespace {

void registerElements(tactus::control::Registry& registry) {
  Reach::registerIn(registry);
}

}  // namespace

TACTUS_PLUGIN("@NAME@", "0.1.0", "BSD-3-Clause", registerElements)
