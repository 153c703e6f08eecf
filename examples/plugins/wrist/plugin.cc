#include "admittance.h"
#include "framework/runtime/plugin_api.h"
#include "wrench.h"

namespace {

void registerElements(tactus::control::Registry& registry) {
  wrist::WrenchSensor::registerIn(registry);
  wrist::Admittance::registerIn(registry);
}

}  // namespace

TACTUS_PLUGIN("wrist", "1.0.0", "BSD-3-Clause", registerElements)
