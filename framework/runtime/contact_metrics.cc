#include "framework/runtime/contact_metrics.h"

#include <algorithm>
#include <limits>

namespace tactus::runtime {

bool TouchSwitch::update(double force_N, double dt) {
  const bool other = on_ ? force_N <= off_force : force_N >= on_force;
  waited_ = other ? waited_ + dt : 0;
  // Half a step of slack: sums of dt are not exact.
  if (waited_ < hold - 0.5 * dt) return false;
  on_ = !on_;
  waited_ = 0;
  return true;
}

ContactMetrics::ContactMetrics(int links, int objects, const std::vector<int>& desired_links, bool touches_itself)
    : objects_(objects),
      touches_itself_(touches_itself),
      desired_(static_cast<size_t>(links), false),
      pair_force_(static_cast<size_t>(links) * static_cast<size_t>(objects), 0.0),
      switches_(static_cast<size_t>(links)) {
  for (int link : desired_links) desired_.at(static_cast<size_t>(link)) = true;
}

void ContactMetrics::update(const std::vector<control::ContactRecord>& records, double dt) {
  std::fill(pair_force_.begin(), pair_force_.end(), 0.0);
  now_ = Now{};
  for (const control::ContactRecord& record : records) {
    if (record.isOfSelf()) {
      now_.self_max_N = std::max(now_.self_max_N, record.force_N);
      continue;
    }
    pair_force_[static_cast<size_t>(record.link * objects_ + record.object)] += record.force_N;
  }

  double sum = 0;
  int switched = 0;
  for (size_t link = 0; link < desired_.size(); ++link) {
    double link_force = 0;
    for (size_t object = 0; object < static_cast<size_t>(objects_); ++object) {
      const double force = pair_force_[link * static_cast<size_t>(objects_) + object];
      if (force <= 0) continue;
      link_force += force;
      if (!desired_[link]) {
        now_.undesired_max_N = std::max(now_.undesired_max_N, force);
        continue;
      }
      ++now_.contacts;
      sum += force;
      now_.max_N = std::max(now_.max_N, force);
    }
    if (!desired_[link]) continue;
    switched += switches_[link].update(link_force, dt);
    now_.links += switches_[link].on();
  }
  if (now_.contacts > 0) now_.mean_N = sum / now_.contacts;

  if (count_while_ && !(*count_while_ > 0.5)) return;
  self_peak_ = std::max(self_peak_, now_.self_max_N);
  undesired_peak_ = std::max(undesired_peak_, now_.undesired_max_N);
  if (!touched() && now_.contacts == 0) return;
  ++ticks_;
  time_ += dt;
  ticks_in_contact_ += now_.contacts > 0;
  contacts_ += now_.contacts;
  force_sum_ += sum;
  max_sum_ += now_.max_N;
  peak_ = std::max(peak_, now_.max_N);
  links_sum_ += now_.links;
  switches_counted_ += switched;
}

void TouchSwitch::archive(control::Archive& archive) {
  archive("on", on_);
  archive("waited", waited_);
}

void ContactMetrics::archive(control::Archive& archive) {
  archive("switches", switches_);
  archive("ticks", ticks_);
  archive("ticks-in-contact", ticks_in_contact_);
  archive("contacts", contacts_);
  archive("switches-counted", switches_counted_);
  archive("time", time_);
  archive("force-sum", force_sum_);
  archive("max-sum", max_sum_);
  archive("peak", peak_);
  archive("undesired-peak", undesired_peak_);
  archive("self-peak", self_peak_);
  archive("links-sum", links_sum_);
}

std::vector<control::Metric> ContactMetrics::metrics() const {
  const auto ratio = [&](double sum, double count) {
    return touched() ? sum / count : std::numeric_limits<double>::quiet_NaN();
  };
  std::vector<control::Metric> metrics = {
          {"contact_force_mean_N", ratio(force_sum_, static_cast<double>(contacts_))},
          {"contact_force_max_mean_N", ratio(max_sum_, static_cast<double>(ticks_in_contact_))},
          {"contact_force_peak_N", ratio(peak_, 1)},
          {"undesired_force_peak_N", undesired_peak_},
          {"links_in_contact_mean", ratio(links_sum_, static_cast<double>(ticks_))},
          {"contact_switches_per_s", ratio(static_cast<double>(switches_counted_), time_)}};
  if (touches_itself_) metrics.push_back({"self_force_peak_N", self_peak_});
  return metrics;
}

}  // namespace tactus::runtime
