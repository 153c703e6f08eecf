#pragma once

#include <memory>
#include <string>

#include "framework/control/observer.h"

namespace tactus::runtime {

/// A stack's own recorder, under guard: what it throws besides FileError names it and the time.
class GuardedObserver final : public control::Observer {
 public:
  /// With `switch_off` a recorder that throws observes nothing more and the run goes on; else PartError ends it.
  GuardedObserver(std::string name, std::unique_ptr<control::Observer> observer, bool switch_off);

  void before(const control::Controller& controller) override;
  void observe(const control::ObservedTick& tick) override;
  void broken(const control::BrokenTick& tick) override;
  void close() override;

  const std::string& name() const { return name_; }
  /// Why it was switched off; "" while it was not.
  const std::string& fault() const { return fault_; }

 private:
  template <class Step>
  void guarded(Step step);

  std::string name_;
  std::unique_ptr<control::Observer> observer_;
  bool switch_off_;
  double time_ = 0;                                                // s, of the last tick
  std::string fault_;
};

}  // namespace tactus::runtime
