#include "framework/control/activation.h"

#include <algorithm>
#include <cmath>

namespace tactus::control {
namespace {

constexpr double rounding = 1e-9;                                  // s, of sums of periods

}  // namespace

bool Activation::holds(double time) const {
  return when_.active && (!when_.on || *when_.on > 0.5) && time >= when_.from - rounding &&
         time < when_.until - rounding;
}

bool Activation::isConditional() const {
  return when_.on || std::isfinite(when_.from) || std::isfinite(when_.until) || !when_.active;
}

bool Activation::advance(double time, double dt) {
  const bool wanted = holds(time);
  const bool stood = stands_;
  if (!started_) {
    started_ = true;
    stands_ = wanted;
    share_ = wanted ? 1 : 0;
    off_for_ = when_.ramp;
    return false;
  }
  const double step = when_.ramp > dt ? dt / when_.ramp : 1;
  share_ = std::clamp(share_ + (wanted ? step : -step), 0.0, 1.0);
  off_for_ = wanted ? 0 : off_for_ + dt;
  stands_ = wanted || (stood && off_for_ < when_.ramp - rounding);
  return stands_ != stood;
}

void Activation::archive(Archive& archive) {
  archive("active", when_.active);
  archive("started", started_);
  archive("stands", stands_);
  archive("share", share_);
  archive("off-for", off_for_);
}

}  // namespace tactus::control
