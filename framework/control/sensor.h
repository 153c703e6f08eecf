#pragma once

#include <string>
#include <vector>

#include "framework/control/archive.h"
#include "framework/control/element_table.h"
#include "framework/control/sensed.h"

namespace tactus::control {

/// Stands between the plant and the controller: turns what there is into what is felt.
///
/// `felt` starts as a copy of `truth` and goes through the sensors of the stack in their order.  A sensor may change
/// joints and contacts in it, and writes numbers of its own, `readings`: those of its ports, one after the other in
/// the order of its element's row.  NaN in a reading says that there is none now: the controller keeps the last good
/// one.
///
/// What it draws it draws from the seed that it was made with, so that runs repeat.  It is called once a tick and takes
/// no memory; `felt.contacts` has room for `SensingGuard::contact_capacity`.
class Sensor {
 public:
  virtual ~Sensor() = default;

  void sense(const Sensed& truth, Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) {
    doSense(truth, felt, readings);
  }
  /// Numbers behind a port, fixed for its life; as it stands, the dimension that the row says.
  virtual int count(const PortRow& port) const { return port.dimension; }
  /// Links, indices into description::Robot::links, whose LinkWrench it reads in `truth`.  A plant that cannot tell
  /// it, or not yet, leaves it out.
  virtual std::vector<int> wrenchLinks() const { return {}; }
  /// What it carries from one tick to the next, its random draws among it.
  void archive(Archive& archive) { doArchive(archive); }
  /// Of a sensor that makes others go wrong: its kind, and whether it strikes in this tick; null where it is none.
  struct Fault {
    std::string kind;
    bool strikes = false;
  };
  virtual const Fault* fault() const { return nullptr; }

 private:
  virtual void doSense(const Sensed& truth, Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) = 0;
  virtual void doArchive(Archive&) {}
};

}  // namespace tactus::control
