#include "dull_skin.h"
#include "framework/runtime/plugin_api.h"
#include "lens.h"
#include "tap.h"
#include "touch_list.h"

namespace {

void registerElements(tactus::control::Registry& registry) {
  probe::Lens::registerIn(registry);
  probe::DullSkin::registerIn(registry);
  probe::Tap::registerIn(registry);
  probe::TouchList::registerIn(registry);
}

}  // namespace

TACTUS_PLUGIN("probe", "1.0.0", "BSD-3-Clause", registerElements)
