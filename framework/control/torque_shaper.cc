#include "framework/control/torque_shaper.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::control {
namespace {

constexpr double noticed = 1e-9;                                   // of the effort: cuts that are worth telling

}  // namespace

TorqueShaper::TorqueShaper(const Eigen::VectorXd& effort, double rate, double period)
    : effort_(effort),
      step_(Eigen::VectorXd::Constant(effort.size(), std::numeric_limits<double>::infinity())),
      period_(period),
      torque_(Eigen::VectorXd::Zero(effort.size())),
      difference_(Eigen::VectorXd::Zero(effort.size())) {
  if (std::isfinite(rate)) step_ = rate * period * effort;
}

void TorqueShaper::startTransfer(double ramp) {
  if (!has_torque_) return;
  ramp_ = left_ = std::max(ramp, left_);
  begins_ = true;
}

void TorqueShaper::apply(const Eigen::VectorXd& wanted) {
  limited_ = rate_limited_ = false;
  if (begins_) difference_ = torque_ - wanted;
  begins_ = false;
  left_ = std::max(0.0, left_ - period_);
  const double share = left_ > 0 ? left_ / ramp_ : 0;
  for (Eigen::Index i = 0; i < torque_.size(); ++i) {
    const double aim = share > 0 ? wanted[i] + share * difference_[i] : wanted[i];
    const double allowed = std::fmin(std::fmax(aim, -effort_[i]), effort_[i]);
    double reached = allowed;
    // Between two torques within the limits, so it is within them.
    if (has_torque_) reached = std::fmin(std::fmax(allowed, torque_[i] - step_[i]), torque_[i] + step_[i]);
    if (std::abs(aim - allowed) > noticed * effort_[i]) limited_ = true;
    if (std::abs(allowed - reached) > noticed * effort_[i]) rate_limited_ = true;
    torque_[i] = reached;
  }
  has_torque_ = true;
}

void TorqueShaper::archive(Archive& archive) {
  archive.finite("torque", torque_);
  archive.finite("difference", difference_);
  archive("ramp", ramp_);
  archive("left", left_);
  archive("begins", begins_);
  archive("has-torque", has_torque_);
}

}  // namespace tactus::control
