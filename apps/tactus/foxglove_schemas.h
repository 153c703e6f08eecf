#pragma once

#include <nlohmann/json.hpp>

/// JSON schemas of messages that Foxglove knows by name (https://docs.foxglove.dev/docs/sdk/schemas), as it publishes
/// them less their descriptions.  Every property is required.
namespace tactus::app::foxglove {

nlohmann::ordered_json frameTransforms();
nlohmann::ordered_json sceneUpdate();
nlohmann::ordered_json pointCloud();

}  // namespace tactus::app::foxglove
