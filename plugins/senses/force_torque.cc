#include "plugins/senses/force_torque.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::plugins {

using namespace control;

void ForceTorque::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "force-torque";
  row.description = "The wrench through the joint above a link, in the link's axes about its origin.";
  row.source = "Newton and Euler, over all that hangs on the link";
  row.attributes = {
      {.name = "link", .type = ValueType::link, .required = true,
       .description = "The sensor is the joint above it, a fixed one too; not the root."},
      {.name = "force-bias", .type = ValueType::reals, .unit = "N", .default_text = "0 0 0",
       .description = "Added to the force.", .count = 3},
      {.name = "moment-bias", .type = ValueType::reals, .unit = "N m", .default_text = "0 0 0",
       .description = "Added to the moment.", .count = 3},
      {.name = "force-noise", .type = ValueType::real, .unit = "N", .default_text = "0",
       .description = "Standard deviation of each sample.", .lower = 0},
      {.name = "moment-noise", .type = ValueType::real, .unit = "N m", .default_text = "0",
       .description = "Standard deviation of each sample.", .lower = 0},
      {.name = "force-drift", .type = ValueType::real, .unit = "N/√s", .default_text = "0",
       .description = "Of the random walk of the zero.", .lower = 0},
      {.name = "moment-drift", .type = ValueType::real, .unit = "N m/√s", .default_text = "0",
       .description = "Of the random walk of the zero.", .lower = 0},
      {.name = "force-drift-limit", .type = ValueType::real, .unit = "N", .default_text = "1",
       .description = "The walk turns back here.", .lower = 0},
      {.name = "moment-drift-limit", .type = ValueType::real, .unit = "N m", .default_text = "0.05",
       .description = "The walk turns back here.", .lower = 0},
      {.name = "force-range", .type = ValueType::real, .unit = "N",
       .description = "Each component saturates here; without it nowhere.", .lower = 0, .lower_open = true},
      {.name = "moment-range", .type = ValueType::real, .unit = "N m",
       .description = "Each component saturates here; without it nowhere.", .lower = 0, .lower_open = true},
      {.name = "cutoff", .type = ValueType::real, .unit = "Hz", .default_text = "0",
       .description = "Of a first-order low-pass; 0 = none.", .lower = 0},
      {.name = "rate", .type = ValueType::real, .unit = "Hz", .default_text = "0",
       .description = "Samples a second; 0 = one each tick.", .lower = 0},
      {.name = "delay", .type = ValueType::real, .unit = "s", .default_text = "0",
       .description = "From a sample until it is told.", .lower = 0, .upper = 1},
  };
  row.ports = {
      {.name = "wrench", .type = "vector", .unit = "", .description = "Force (N), then moment (N m).", .dimension = 6},
      {.name = "force", .type = "scalar", .unit = "N", .description = "Length of the force.", .dimension = 1},
      {.name = "moment", .type = "scalar", .unit = "N m", .description = "Length of the moment.", .dimension = 1},
  };
  registry.addSensor(row, [](const SensorContext& context) { return std::make_unique<ForceTorque>(context); });
}

ForceTorque::ForceTorque(const SensorContext& context)
    : link_(context.frame("link")),
      halves_{half(context.values, "force"), half(context.values, "moment")},
      cutoff_(context.values.real("cutoff")),
      sampler_(6, context.values.real("rate"), context.values.real("delay"), context.control_period),
      random_(context.seed) {
  if (link_ == context.robot.root) throw ElementError("link", "the root link has no joint above it");
}

ForceTorque::Half ForceTorque::half(const ElementValues& values, const std::string& which) {
  const bool limited = values.has(which + "-range");
  return {values.vector3(which + "-bias"), values.real(which + "-noise"),
          Drift(values.real(which + "-drift"), values.real(which + "-drift-limit")),
          limited ? values.real(which + "-range") : INFINITY};
}

void ForceTorque::doSense(const Sensed& truth, Sensed&, Eigen::Ref<Eigen::VectorXd> readings) {
  const auto found = std::find_if(truth.wrenches.begin(), truth.wrenches.end(),
                                  [this](const LinkWrench& wrench) { return wrench.link == link_; });
  if (found != truth.wrenches.end()) {
    Vector6 wrench;
    wrench << found->force_L, found->moment_L;
    const double dt = truth.time - last_time_;
    const bool filters = started_ && cutoff_ > 0;
    filtered_ += (filters ? 1 - std::exp(-2 * std::numbers::pi * cutoff_ * dt) : 1) * (wrench - filtered_);
    last_time_ = truth.time;
    started_ = true;
    if (sampler_.isDue(truth.time)) {
      auto sample = sampler_.take(truth.time);
      for (int i = 0; i < 6; ++i) {
        const Half& half = halves_[i / 3];
        drift_[i] = half.drift.next(drift_[i], sampler_.interval(), random_);
        const double noise = half.noise > 0 ? half.noise * random_.normal() : 0;
        sample[i] = std::clamp(filtered_[i] + half.bias[i % 3] + drift_[i] + noise, -half.range, half.range);
      }
    }
  }
  if (!started_) {
    readings.setConstant(std::nan(""));
    return;
  }
  sampler_.tell(truth.time);
  readings.head<6>() = sampler_.told();
  readings[6] = sampler_.told().head<3>().norm();
  readings[7] = sampler_.told().tail<3>().norm();
}

void ForceTorque::doArchive(Archive& archive) {
  archive("sampler", sampler_);
  archive("random", random_);
  archive("filtered", filtered_);
  archive("drift", drift_);
  archive("last-time", last_time_);
  archive("started", started_);
}

}  // namespace tactus::plugins
