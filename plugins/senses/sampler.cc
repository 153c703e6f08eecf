#include "plugins/senses/sampler.h"

#include <algorithm>
#include <cmath>

namespace tactus::plugins {

Sampler::Sampler(int numbers, double rate, double delay, double period)
    : rate_(rate), delay_(delay), tolerance_(1e-6 * period) {
  const double between = rate > 0 ? std::max(period, 1 / rate) : period;
  const int capacity = static_cast<int>(std::ceil((delay + tolerance_) / between)) + 2;
  samples_.setZero(numbers, capacity);
  times_.assign(static_cast<std::size_t>(capacity), 0);
}

bool Sampler::isDue(double time) const { return last_ < 0 || rate_ <= 0 || time >= next_ - tolerance_; }

Eigen::Ref<Eigen::VectorXd> Sampler::take(double time) {
  const int column = (last_ + 1) % static_cast<int>(times_.size());
  interval_ = last_ < 0 ? 0 : time - times_[static_cast<std::size_t>(last_)];
  times_[static_cast<std::size_t>(column)] = time;
  last_ = column;
  if (rate_ > 0) next_ = (std::floor((time + tolerance_) * rate_) + 1) / rate_;
  return samples_.col(column);
}

void Sampler::archive(control::Archive& archive) {
  archive("samples", samples_);
  archive("times", times_);
  const auto most = static_cast<std::int64_t>(times_.size()) - 1;
  archive.whole("last", last_, -1, most);
  archive.whole("told", told_, -1, most);
  archive("next", next_);
  archive("interval", interval_);
}

bool Sampler::tell(double time) {
  const int before = told_;
  if (told_ < 0) told_ = 0;
  for (std::size_t i = 0; i < times_.size() && told_ != last_; ++i) {
    const int next = (told_ + 1) % static_cast<int>(times_.size());
    if (times_[static_cast<std::size_t>(next)] > time - delay_ + tolerance_) break;
    told_ = next;
  }
  return told_ != before;
}

}  // namespace tactus::plugins
