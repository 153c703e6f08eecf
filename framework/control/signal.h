#pragma once

#include <string_view>
#include <typeinfo>
#include <vector>

#include "framework/control/archive.h"
#include "framework/control/tick.h"

namespace tactus::control {

/// A named source of values that tasks and other signals read through typed ports.  Signals run in dependency
/// order, before the tasks; `update` allocates nothing.
class Signal {
 public:
  virtual ~Signal() = default;

  void update(const Tick& tick) { doUpdate(tick); }
  /// The value behind a port of the signal's element row; stays at one address for the signal's life.
  const void* port(std::string_view name) const { return doPort(name); }
  virtual void columns(std::vector<LogColumn>&) const {}
  virtual void metrics(std::vector<Metric>&) const {}
  /// What it carries from one tick to the next, what stands behind its ports as far as the next update does not make
  /// that anew.
  void archive(Archive& archive) { doArchive(archive); }

 private:
  virtual void doUpdate(const Tick& tick) = 0;
  virtual void doArchive(Archive&) {}
  virtual const void* doPort(std::string_view name) const = 0;
};

}  // namespace tactus::control
