#include "framework/runtime/plugin_api.h"
#include "plugins/senses/encoders.h"
#include "plugins/senses/fault.h"
#include "plugins/senses/force_torque.h"
#include "plugins/senses/skin.h"

namespace {

void registerElements(tactus::control::Registry& registry) {
  tactus::plugins::Skin::registerIn(registry);
  tactus::plugins::ForceTorque::registerIn(registry);
  tactus::plugins::Encoders::registerIn(registry);
  tactus::plugins::Fault::registerIn(registry);
}

}  // namespace

TACTUS_PLUGIN("senses", TACTUS_VERSION, "unspecified", registerElements)
