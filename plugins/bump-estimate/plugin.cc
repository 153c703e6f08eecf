#include "framework/runtime/plugin_api.h"
#include "plugins/bump-estimate/bump_estimate.h"

TACTUS_PLUGIN("bump-estimate", TACTUS_VERSION, "unspecified", tactus::plugins::BumpEstimate::registerIn)
