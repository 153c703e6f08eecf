#include "framework/control/sensing_guard.h"

#include <cmath>

namespace tactus::control {
namespace {

constexpr double largest = 1e6;                                    // rad, m, N and per second
constexpr double rounding = 1e-9;                                  // s, of sums of periods

bool isNumber(double value) { return std::abs(value) <= largest; }  // false for NaN
bool areNumbers(const Eigen::Vector3d& v) { return isNumber(v.x()) && isNumber(v.y()) && isNumber(v.z()); }

}  // namespace

SensingGuard::SensingGuard(int dof, int links, double hold, double period)
    : links_(links), hold_(hold), period_(period), never_sensed_(dof) {
  for (int i = 0; i < dof; ++i) lost_.push_back({i, 1, i, 1});
  known_.q.setZero(dof);
  known_.qd.setZero(dof);
  known_.contacts.reserve(contact_capacity);
  ignored_links_.reserve(contact_capacity);
}

SensingGuard::SensingGuard(const dynamics::Model& model, int links, double hold, double period)
    : SensingGuard(model.dof(), links, hold, period) {
  for (const dynamics::Model::Joint& joint : model.joints()) {
    if (joint.driver >= 0) continue;
    for (int i = 0; i < joint.coordinate_count; ++i)
      lost_[static_cast<std::size_t>(joint.coordinate + i)] = {joint.position, joint.position_count, joint.coordinate,
                                                               joint.coordinate_count};
  }
  known_.q = model.neutral();
}

const Sensed& SensingGuard::check(const Sensed& raw) {
  record_ = SensingRecord{};
  const bool time_is_good = std::isfinite(raw.time) && (!has_time_ || raw.time >= known_.time);
  known_.time = time_is_good ? raw.time : known_.time + (has_time_ ? period_ : 0);
  has_time_ = true;
  const bool joints_are_good = checkJoints(raw);
  const bool contacts_are_good = checkContacts(raw);
  if (time_is_good && joints_are_good && contacts_are_good) return raw;
  if (contacts_are_good) known_.contacts.assign(raw.contacts.begin(), raw.contacts.end());
  if (record_.blind) known_.qd.setZero();
  return known_;
}

bool SensingGuard::checkJoints(const Sensed& raw) {
  const bool sized = raw.q.size() == known_.q.size() && raw.qd.size() == known_.qd.size();
  for (Joint& joint : lost_) {
    joint.now = !sized;
    for (int i = 0; i < joint.position_count && !joint.now; ++i) joint.now = !isNumber(raw.q[joint.position + i]);
    for (int i = 0; i < joint.coordinate_count && !joint.now; ++i) joint.now = !isNumber(raw.qd[joint.coordinate + i]);
    if (!joint.now) {
      for (int i = 0; i < joint.position_count; ++i) known_.q[joint.position + i] = raw.q[joint.position + i];
      for (int i = 0; i < joint.coordinate_count; ++i) known_.qd[joint.coordinate + i] = raw.qd[joint.coordinate + i];
      if (!joint.ever_good) --never_sensed_;
      joint.ever_good = true;
      joint.lost_for = 0;
      continue;
    }
    joint.lost_for += period_;
    ++record_.joints_held;
    if (!joint.ever_good || joint.lost_for > hold_ + rounding) record_.blind = true;
  }
  return record_.joints_held == 0;
}

bool SensingGuard::isUsable(const ContactRecord& contact) const {
  return contact.link >= 0 && contact.link < links_ && contact.other_link < links_ &&
         areNumbers(contact.point_W) && areNumbers(contact.normal_W) &&
         isNumber(contact.force_N) && isNumber(contact.depth) && areNumbers(contact.friction_W);
}

bool SensingGuard::checkContacts(const Sensed& raw) {
  ignored_links_.clear();
  for (const ContactRecord& contact : raw.contacts) {
    if (isUsable(contact)) continue;
    ignored_links_.push_back(contact.link >= 0 && contact.link < links_ ? contact.link : -1);
  }
  record_.contacts_ignored = static_cast<int>(ignored_links_.size());
  if (record_.contacts_ignored == 0) return true;
  known_.contacts.clear();
  for (const ContactRecord& contact : raw.contacts)
    if (isUsable(contact)) known_.contacts.push_back(contact);
  return false;
}

void SensingGuard::archive(Archive& archive) {
  archive("has-time", has_time_);
  archive("time", known_.time);
  archive.finite("q", known_.q);
  archive.finite("qd", known_.qd);
  archive("never-sensed", never_sensed_);
  std::vector<char> ever_good;
  std::vector<double> lost_for;
  for (const Joint& joint : lost_) {
    ever_good.push_back(joint.ever_good);
    lost_for.push_back(joint.lost_for);
  }
  archive("ever-good", ever_good);
  archive("lost-for", lost_for);
  for (std::size_t i = 0; i < lost_.size(); ++i) {
    lost_[i].ever_good = ever_good[i];
    lost_[i].lost_for = lost_for[i];
  }
}

}  // namespace tactus::control
