#include "framework/runtime/plugin_api.h"
#include "plugins/enclose/enclose.h"

TACTUS_PLUGIN("enclose", TACTUS_VERSION, "unspecified", tactus::plugins::Enclose::registerIn)
