#include "apps/tactus/capsule_keeper.h"

#include <filesystem>

#include "dsl/capsule.h"
#include "dsl/read_stack.h"
#include "framework/control/conflict.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {

CapsuleKeeper::CapsuleKeeper(const Session& session, const std::string& folder)
    : stack_(session.stack()),
      folder_(folder),
      before_(session.controller().backEnd().warmStart()),
      joints_(session.controller().model().jointNames()) {}

void CapsuleKeeper::observe(const runtime::ObservedTick& tick) {
  const control::TickRecord& record = tick.controller.record();
  if (record.sensing.blind) {                                      // the back end was not asked: its problem is an older tick's
    ++tick_;
    return;
  }
  const bool failed = record.fallback || record.status != control::Status::ok || tick.controller.solution().late;
  const bool room = static_cast<int>(files_.size()) < most_capsules && warnings_.empty();
  if (record.status == control::Status::infeasible && !infeasible_) {
    infeasible_ = tick.controller.problem();
    infeasible_time_ = tick.sensed.time;
  }
  if (failed && room) write(tick);
  if (room) before_ = tick.controller.backEnd().warmStart();
  ++tick_;
}

std::vector<std::string> CapsuleKeeper::warnings() const {
  std::vector<std::string> warnings = warnings_;
  if (!infeasible_) return warnings;
  const std::string why =
      control::describe(control::findConflict(*infeasible_), *infeasible_, {joints_, taskPlaces(stack_)});
  if (!why.empty())
    warnings.push_back("first infeasible at t = " + control::formatNumber(infeasible_time_) + " s: " + why);
  return warnings;
}

void CapsuleKeeper::write(const runtime::ObservedTick& tick) {
  const control::TickSolution& solution = tick.controller.solution();
  dsl::Capsule capsule;
  capsule.back_end = stack_.back_end.row().name;
  for (const auto& [name, value] : stack_.back_end.all()) capsule.options[name] = value.text;
  capsule.warm_start = before_;
  capsule.deadline = tick.controller.backEnd().deadline();
  capsule.status = solution.status;
  capsule.message = solution.message;
  capsule.late = solution.late;
  capsule.iterations = solution.iterations;
  capsule.torque = solution.torque;
  capsule.tick = tick_;
  capsule.time = tick.sensed.time;
  capsule.q = tick.sensed.q;
  capsule.qd = tick.sensed.qd;
  capsule.joints = tick.controller.model().jointNames();
  capsule.places = taskPlaces(stack_);
  capsule.stack = dsl::writeResolved(stack_);

  const std::string name = "capsule-" + std::to_string(tick_) + ".json";
  const std::string path = folder_ + "/" + name;
  try {
    runtime::writeFile(path, dsl::capsuleToJson(tick.controller.problem(), capsule));
    files_.push_back(name);
  } catch (const runtime::FileError& error) {
    std::error_code ignored;                                       // half a capsule is none
    std::filesystem::remove(path, ignored);
    warnings_.push_back(std::string("no capsule: ") + error.what());
  }
}

bool CapsuleKeeper::isCapsule(const std::string& file_name) {
  return file_name.starts_with("capsule-") && file_name.ends_with(".json");
}

}  // namespace tactus::app
