#include "apps/tactus/capsule_keeper.h"

#include "dsl/read_stack.h"
#include "framework/control/conflict.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {

CapsuleKeeper::CapsuleKeeper(const Session& session, const std::string& folder)
    : stack_(session.stack()),
      places_(session.taskPlaces()),
      folder_(folder),
      tick_(static_cast<int>(session.tick())),
      joints_(session.controller().model().jointNames()) {}

void CapsuleKeeper::before(const control::Controller& controller) {
  if (hasRoom()) before_ = controller.backEnd().warmStart();
}

void CapsuleKeeper::observe(const control::ObservedTick& tick) {
  const control::TickRecord& record = tick.controller.record();
  if (record.sensing.blind) {                                      // the back end was not asked: its problem is an older tick's
    ++tick_;
    return;
  }
  const bool failed = record.fallback || record.status != control::Status::ok || tick.controller.solution().late;
  if (record.status == control::Status::infeasible && !infeasible_) {
    infeasible_ = tick.controller.problem();
    infeasible_time_ = tick.sensed.time;
  }
  if (failed && hasRoom()) {
    const control::TickSolution& solution = tick.controller.solution();
    dsl::Capsule capsule = capsuleOf(tick.controller, tick.sensed);
    capsule.status = solution.status;
    capsule.message = solution.message;
    capsule.late = solution.late;
    capsule.iterations = solution.iterations;
    capsule.torque = solution.torque;
    write(tick.controller.problem(), capsule);
  }
  ++tick_;
}

void CapsuleKeeper::broken(const control::BrokenTick& tick) {
  if (tick.error.part != control::TickError::Part::back_end || !hasRoom()) return;
  dsl::Capsule capsule = capsuleOf(tick.controller, tick.sensed);
  capsule.status = control::Status::failed;
  capsule.message = tick.error.reason;
  capsule.threw = true;
  capsule.torque.setZero(tick.controller.model().dof());
  write(tick.controller.problem(), capsule);
}

std::vector<std::string> CapsuleKeeper::warnings() const {
  std::vector<std::string> warnings = warnings_;
  if (!infeasible_) return warnings;
  const std::string why =
      control::describe(control::findConflict(*infeasible_), *infeasible_, {joints_, places_});
  if (!why.empty())
    warnings.push_back("first infeasible at t = " + control::formatNumber(infeasible_time_) + " s: " + why);
  return warnings;
}

dsl::Capsule CapsuleKeeper::capsuleOf(const control::Controller& controller, const control::Sensed& sensed) const {
  dsl::Capsule capsule;
  capsule.back_end = controller.backEnd().recipe().back_end;
  capsule.options = controller.backEnd().recipe().options;
  capsule.warm_start = before_;
  capsule.deadline = controller.backEnd().deadline();
  capsule.tick = tick_;
  capsule.time = sensed.time;
  capsule.q = sensed.q;
  capsule.qd = sensed.qd;
  capsule.joints = joints_;
  capsule.places = places_;
  capsule.stack = dsl::writeResolved(stack_);
  return capsule;
}

void CapsuleKeeper::write(const control::TickProblem& problem, const dsl::Capsule& capsule) {
  const std::string name = "capsule-" + std::to_string(tick_) + ".json";
  const std::string path = folder_ + "/" + name;
  try {
    runtime::writeWhole(path, dsl::capsuleToJson(problem, capsule));
    files_.push_back(name);
  } catch (const runtime::FileError& error) {
    warnings_.push_back(std::string("no capsule: ") + error.what());
  }
}

bool CapsuleKeeper::isCapsule(const std::string& file_name) {
  return file_name.starts_with("capsule-") && file_name.ends_with(".json");
}

}  // namespace tactus::app
