#pragma once

#include <nlohmann/json.hpp>

namespace tactus::app {

/// What the program was built from and runs with: name → version.
nlohmann::ordered_json versions();

}  // namespace tactus::app
