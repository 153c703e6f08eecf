#include "apps/tactus/state_keeper.h"

#include <algorithm>
#include <cmath>

#include "apps/tactus/text.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {

StateKeeper::StateKeeper(Session& session, const std::string& folder, const std::vector<double>& times)
    : session_(session), folder_(folder) {
  for (const double time : times) ticks_.insert(std::lround(time / session.controller().period()));
}

void StateKeeper::before(const control::Controller&) {
  if (isDue()) save();
}

void StateKeeper::save() {
  const dsl::SavedState state = session_.save();
  const std::string name = "state-" + timeText(session_.time()) + ".json";
  if (std::find(files_.begin(), files_.end(), name) != files_.end()) return;
  runtime::writeWhole(folder_ + "/" + name, dsl::stateToJson(state));
  files_.push_back(name);
}

bool StateKeeper::isState(const std::string& file_name) {
  return file_name.starts_with("state-") && file_name.ends_with(".json");
}

}  // namespace tactus::app
