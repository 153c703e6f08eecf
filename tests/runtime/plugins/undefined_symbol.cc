// A plugin whose registration calls a function that no library defines.

#include "framework/runtime/plugin_api.h"

void functionOfAnotherLibrary(tactus::control::Registry&);

TACTUS_PLUGIN("undefined", "1.0.0", "BSD-3-Clause", functionOfAnotherLibrary)
