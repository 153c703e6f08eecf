#pragma once

#include <string_view>

namespace tactus::app {

/// The script that replays a run and its style, as apps/report is bundled; built into the program.
struct ReplayPage {
  std::string_view script;
  std::string_view style;
};

ReplayPage replayPage();

}  // namespace tactus::app
