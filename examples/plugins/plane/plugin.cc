#include "framework/runtime/plugin_api.h"
#include "plane_fit.h"

namespace {

void registerElements(tactus::control::Registry& registry) { PlaneFit::registerIn(registry); }

}  // namespace

TACTUS_PLUGIN("plane", "1.0.0", "BSD-3-Clause", registerElements)
