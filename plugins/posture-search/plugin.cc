#include "framework/runtime/plugin_api.h"
#include "plugins/posture-search/contact_optimum.h"

TACTUS_PLUGIN("posture-search", TACTUS_VERSION, "unspecified", tactus::plugins::ContactOptimum::registerIn)
