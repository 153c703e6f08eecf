#include "plugins/senses/encoders.h"

#include <cmath>
#include <numbers>

namespace tactus::plugins {

using namespace control;

void Encoders::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "encoders";
  row.description = "Joint positions in steps, with noise, and velocities from their differences.";
  row.attributes = {
      {.name = "joints", .type = ValueType::joints, .required = true, .description = "The joints that it measures."},
      {.name = "resolution", .type = ValueType::real, .unit = "rad or m", .default_text = "1e-5",
       .description = "The step of what it tells; 0 = none.", .lower = 0},
      {.name = "noise", .type = ValueType::real, .unit = "rad or m", .default_text = "0",
       .description = "Standard deviation of each sample.", .lower = 0},
      {.name = "velocity-cutoff", .type = ValueType::real, .unit = "Hz", .default_text = "100",
       .description = "Of the velocities' first-order low-pass; 0 = plain differences.", .lower = 0},
      {.name = "rate", .type = ValueType::real, .unit = "Hz", .default_text = "0",
       .description = "Samples a second; 0 = one each tick.", .lower = 0},
      {.name = "delay", .type = ValueType::real, .unit = "s", .default_text = "0",
       .description = "From a sample until it is told.", .lower = 0, .upper = 1},
  };
  row.ports = {{.name = "positions", .type = "vector", .unit = "rad or m",
                .description = "Of its joints, in the order of q."}};
  registry.addSensor(row, [](const SensorContext& context) { return std::make_unique<Encoders>(context); });
}

Encoders::Encoders(const SensorContext& context)
    : joints_(context.joints("joints")),
      resolution_(context.values.real("resolution")),
      noise_(context.values.real("noise")),
      cutoff_(context.values.real("velocity-cutoff")),
      sampler_(2 * static_cast<int>(joints_.size()), context.values.real("rate"), context.values.real("delay"),
               context.control_period),
      random_(context.seed),
      last_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(joints_.size()))),
      velocity_(last_) {
  if (joints_.empty()) throw ElementError("joints", "it needs a joint to measure");
  if (context.model.hasQuaternions())
    throw ElementError("joints", "the robot has joints that turn freely, whose positions no encoder tells");
}

void Encoders::doSense(const Sensed& truth, Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) {
  const Eigen::Index count = last_.size();
  if (sampler_.isDue(truth.time)) {
    auto sample = sampler_.take(truth.time);
    const double h = sampler_.interval();
    const double share = cutoff_ > 0 ? 1 - std::exp(-2 * std::numbers::pi * cutoff_ * h) : 1;
    for (Eigen::Index i = 0; i < count; ++i) {
      double q = truth.q[joints_[static_cast<std::size_t>(i)]];
      if (noise_ > 0) q += noise_ * random_.normal();
      if (resolution_ > 0) q = std::round(q / resolution_) * resolution_;
      if (started_ && h > 0) velocity_[i] += share * ((q - last_[i]) / h - velocity_[i]);
      last_[i] = q;
    }
    started_ = true;
    sample.head(count) = last_;
    sample.tail(count) = velocity_;
  }
  sampler_.tell(truth.time);
  readings = sampler_.told().head(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    felt.q[joints_[static_cast<std::size_t>(i)]] = sampler_.told()[i];
    felt.qd[joints_[static_cast<std::size_t>(i)]] = sampler_.told()[count + i];
  }
}

void Encoders::doArchive(Archive& archive) {
  archive("sampler", sampler_);
  archive("random", random_);
  archive("last", last_);
  archive("velocity", velocity_);
  archive("started", started_);
}

}  // namespace tactus::plugins
