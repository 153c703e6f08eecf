#pragma once

#include <string_view>
#include <typeinfo>
#include <vector>

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

 private:
  virtual void doUpdate(const Tick& tick) = 0;
  virtual const void* doPort(std::string_view name) const = 0;
};

}  // namespace tactus::control
