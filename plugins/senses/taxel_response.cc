#include "plugins/senses/taxel_response.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::plugins {

TaxelResponse::TaxelResponse(int taxels, const Options& options, const std::vector<int>& dead, std::uint64_t seed)
    : options_(options),
      random_(seed),
      drift_(options.drift, options.drift_limit),
      gains_(Eigen::VectorXd::Constant(taxels, options.gain)),
      drifts_(Eigen::VectorXd::Zero(taxels)),
      dead_(static_cast<std::size_t>(taxels), false) {
  for (double& gain : gains_) gain *= 1 + std::clamp(options.gain_spread * random_.normal(), -1.0, 1.0);
  // The first of a random order (Fisher and Yates).
  std::vector<int> order(static_cast<std::size_t>(taxels));
  for (int i = 0; i < taxels; ++i) order[static_cast<std::size_t>(i)] = i;
  const auto drawn = static_cast<std::size_t>(std::lround(options.dead * taxels));
  for (std::size_t i = 0; i < drawn; ++i) {
    const auto other = i + static_cast<std::size_t>(random_.uniform() * static_cast<double>(order.size() - i));
    std::swap(order[i], order[other]);
    dead_[static_cast<std::size_t>(order[i])] = true;
  }
  for (const int taxel : dead) dead_[static_cast<std::size_t>(taxel)] = true;
}

void TaxelResponse::respond(Eigen::Ref<const Eigen::VectorXd> forces_N, double interval,
                            Eigen::Ref<Eigen::VectorXd> values_N) {
  const double step = options_.levels > 0 ? options_.range / options_.levels : 0;
  for (Eigen::Index i = 0; i < gains_.size(); ++i) {
    double value = gains_[i] * forces_N[i];
    if (!drift_.isOff()) value += drifts_[i] = drift_.next(drifts_[i], interval, random_);
    if (options_.noise > 0) value += options_.noise * random_.normal();
    value = std::max(value, 0.0);
    if (options_.range > 0) value = std::min(value, options_.range);
    if (step > 0) value = std::round(value / step) * step;
    values_N[i] = value < options_.threshold || dead_[static_cast<std::size_t>(i)] ? 0 : value;
  }
}

void TaxelResponse::archive(control::Archive& archive) {
  archive("random", random_);
  archive("gains", gains_);
  archive("drifts", drifts_);
  archive("dead", dead_);
}

}  // namespace tactus::plugins
