#include "framework/runtime/guarded_observer.h"

#include "framework/control/element_values.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/part_error.h"

namespace tactus::runtime {

GuardedObserver::GuardedObserver(std::string name, std::unique_ptr<control::Observer> observer, bool switch_off)
    : name_(std::move(name)), observer_(std::move(observer)), switch_off_(switch_off) {}

template <class Step>
void GuardedObserver::guarded(Step step) {
  if (!fault_.empty()) return;
  try {
    step();
    return;
  } catch (const FileError&) {
    throw;
  } catch (const std::exception& error) {
    fault_ = error.what();
  } catch (...) {
    fault_ = "it threw something that is not a std::exception";
  }
  fault_ = "recorder '" + name_ + "' failed at t = " + control::formatNumber(time_) + " s: " + fault_;
  if (!switch_off_) throw PartError(fault_);
}

void GuardedObserver::before(const control::Controller& controller) {
  guarded([&] { observer_->before(controller); });
}

void GuardedObserver::observe(const control::ObservedTick& tick) {
  time_ = tick.truth.time;
  guarded([&] { observer_->observe(tick); });
}

void GuardedObserver::broken(const control::BrokenTick& tick) {
  guarded([&] { observer_->broken(tick); });
}

void GuardedObserver::close() {
  guarded([&] { observer_->close(); });
}

}  // namespace tactus::runtime
