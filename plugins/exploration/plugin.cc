#include "framework/runtime/plugin_api.h"
#include "plugins/exploration/coverage.h"
#include "plugins/exploration/surface_map.h"

namespace {

void registerElements(tactus::control::Registry& registry) {
  tactus::exploration::SurfaceMap::registerIn(registry);
  tactus::exploration::Coverage::registerIn(registry);
}

}  // namespace

TACTUS_PLUGIN("exploration", TACTUS_VERSION, "unspecified", registerElements)
