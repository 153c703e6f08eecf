#pragma once

#include <vector>

#include "framework/control/archive.h"
#include "framework/control/observer.h"

namespace tactus::control {

/// Judges a run by what truly happens, whatever sensors tell: columns of the log and figures of the run.  Nothing that
/// controls can read it.
class Measure {
 public:
  virtual ~Measure() = default;

  /// Every tick, after it; allocates nothing.
  void observe(const ObservedTick& tick) { doObserve(tick); }
  virtual void columns(std::vector<LogColumn>&) const {}
  /// Of the run so far; the same names at any time.  What there is nothing to say of yet is NaN.
  virtual void metrics(std::vector<Metric>&) const {}
  /// What it carries from one tick to the next.
  void archive(Archive& archive) { doArchive(archive); }

 private:
  virtual void doObserve(const ObservedTick& tick) = 0;
  virtual void doArchive(Archive&) {}
};

}  // namespace tactus::control
