#include "tasks/follow_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/control/displacement.h"
#include "tasks/orientation_error.h"

namespace tactus::tasks {

using namespace control;

void FollowSurface::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "follow-surface";
  row.kind = ElementKind::task;
  row.description = "Moves a hand along an unknown surface through key positions, turned to the median contact normal.";
  row.source = "thesis A.1";
  row.attributes = {
      {.name = "frame", .type = ValueType::link, .required = true, .description = "The link that follows."},
      {.name = "along", .type = ValueType::points, .unit = "m",
       .description = "Key positions, world axes, in order; they need not lie on the surface. Without them, and without "
                      "`towards`, the link stays where it is on the surface.", .count = 3,
       .in_world = InWorld::positions, .reached_by = "frame"},
      {.name = "towards", .type = ValueType::port,
       .description = "Instead of `along`: the place that a signal names, e.g. map.next.", .port_type = "place"},
      {.name = "on", .type = ValueType::port, .default_text = "touch.held",
       .description = "Contacts whose normals show the surface.", .port_type = "contact-set"},
      {.name = "normal-axis", .type = ValueType::reals, .unit = "1", .default_text = "1 0 0",
       .description = "Axis of the frame that faces the surface.", .count = 3},
      {.name = "forward-axis", .type = ValueType::reals, .unit = "1", .default_text = "0 0 1",
       .description = "Axis of the frame from palm to fingers, perpendicular to normal-axis.", .count = 3},
      {.name = "approach", .type = ValueType::reals, .unit = "1", .default_text = "0 0 -1",
       .description = "Direction of the first approach, world axes.", .count = 3,
       .in_world = InWorld::directions},
      {.name = "lean", .type = ValueType::real, .unit = "rad",
       .description = "How far the normal axis may lean from `approach`, at most; not given: as far as the surface does.",
       .lower = 0, .upper = 3.1, .lower_open = true},
      {.name = "approach-speed", .type = ValueType::real, .unit = "m/s", .default_text = "0.02",
       .description = "Speed along the last normal while nothing touches.", .lower = 0},
      {.name = "reach", .type = ValueType::real, .unit = "m", .default_text = "0.03",
       .description = "G: how far ahead the reference runs.", .lower = 0, .lower_open = true},
      {.name = "near", .type = ValueType::real, .unit = "m", .default_text = "0.03",
       .description = "d: nearer than this to the key, the reference slows down.", .lower = 0, .lower_open = true},
      {.name = "key-threshold", .type = ValueType::real, .unit = "m", .default_text = "0.015",
       .description = "Tangential distance at which a key counts as passed.", .lower = 0, .lower_open = true},
      {.name = "stiffness", .type = ValueType::real, .unit = "N/m", .default_text = "300",
       .description = "k_p, within the surface.", .lower = 0},
      {.name = "damping", .type = ValueType::real, .unit = "N s/m", .default_text = "300",
       .description = "d_p, within the surface.", .lower = 0},
      {.name = "normal-damping", .type = ValueType::real, .unit = "N s/m", .default_text = "100",
       .description = "d_p along the normal axis.", .lower = 0},
      {.name = "rotation-stiffness", .type = ValueType::real, .unit = "N m/rad", .default_text = "10",
       .description = "k_r, about the two axes within the surface.", .lower = 0},
      {.name = "yaw-stiffness", .type = ValueType::real, .unit = "N m/rad", .default_text = "0",
       .description = "Stiffness about the normal axis towards `heading` (thesis: 0).", .lower = 0},
      {.name = "rotation-damping", .type = ValueType::real, .unit = "N m s/rad", .default_text = "3",
       .description = "d_r.", .lower = 0},
      {.name = "heading", .type = ValueType::reals, .unit = "1",
       .description = "Direction that the forward axis keeps, world axes; not given: it turns freely.", .count = 3,
       .in_world = InWorld::directions},
      {.name = "headings", .type = ValueType::points, .unit = "1",
       .description = "Instead of `heading`: one direction a key, on the way to it.", .count = 3,
       .in_world = InWorld::directions},
      {.name = "turn-reach", .type = ValueType::real, .unit = "rad",
       .description = "How far ahead of the hand its heading runs, at most, less as the pull fades; not given: all the way.",
       .lower = 0, .lower_open = true},
      {.name = "turn-avoids", .type = ValueType::reals, .unit = "1",
       .description = "Direction through which the heading does not turn, world axes: it takes the other way round.",
       .count = 3, .in_world = InWorld::directions},
      {.name = "tilt", .type = ValueType::real, .unit = "rad", .default_text = "0",
       .description = "Lean of the forward axis into the surface.", .lower = -1.5, .upper = 1.5},
      {.name = "yield-from", .type = ValueType::real, .unit = "N",
       .description = "The pull towards the key fades while the largest force of `yield-on` is above this; not given: never.",
       .lower = 0},
      {.name = "yield-until", .type = ValueType::real, .unit = "N",
       .description = "Force at which it is gone; not given: one and a half times `yield-from`.", .lower = 0,
       .lower_open = true},
      {.name = "yield-filter", .type = ValueType::real, .unit = "s", .default_text = "0.02",
       .description = "Time constant of the filter on that force.", .lower = 0},
      {.name = "yield-on", .type = ValueType::port,
       .description = "Contacts whose forces make it yield, e.g. touch.all; not given: those of `on`.",
       .port_type = "contact-set"},
      {.name = "normal-filter", .type = ValueType::real, .unit = "s", .default_text = "0.1",
       .description = "Time constant of the filter on the median normal.", .lower = 0},
      {.name = "stall-time", .type = ValueType::real, .unit = "s", .default_text = "2",
       .description = "A key is given up after so long without progress.", .lower = 0, .lower_open = true},
      {.name = "stall-progress", .type = ValueType::real, .unit = "m", .default_text = "0.005",
       .description = "What counts as progress towards a key.", .lower = 0},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<FollowSurface>(context); });
}

namespace {

Eigen::Vector3d direction(const BuildContext& context, const std::string& attribute) {
  const Eigen::Vector3d v = context.values.vector3(attribute);
  if (v.norm() < 1e-9) throw ElementError(attribute, attribute + " must not be a zero vector");
  return v.normalized();
}

}  // namespace

FollowSurface::FollowSurface(const BuildContext& context)
    : Task(Relation::equality, 6),
      contacts_(context.port<ContactSet>("on")),
      yield_contacts_(context.values.has("yield-on") ? context.port<ContactSet>("yield-on") : contacts_),
      frame_(context.frame("frame")),
      reach_(context.values.real("reach")),
      near_(context.values.real("near")),
      key_threshold_(context.values.real("key-threshold")),
      yield_filter_(context.values.real("yield-filter")),
      normal_filter_(context.values.real("normal-filter")),
      tilt_(context.values.real("tilt")),
      stiffness_(context.values.real("stiffness")),
      damping_(context.values.real("damping")),
      damping_normal_(context.values.real("normal-damping")),
      turn_stiffness_(context.values.real("rotation-stiffness")),
      yaw_stiffness_(context.values.real("yaw-stiffness")),
      turn_damping_(context.values.real("rotation-damping")),
      approach_speed_(context.values.real("approach-speed")),
      stall_time_(context.values.real("stall-time")),
      stall_progress_(context.values.real("stall-progress")),
      has_heading_(context.values.has("heading")),
      heading_W_(has_heading_ ? direction(context, "heading") : Eigen::Vector3d::Zero()),
      approach_W_(direction(context, "approach")),
      normal_W_(approach_W_) {
  if (context.values.has("lean")) lean_ = context.values.real("lean");
  if (context.values.has("along") && context.values.has("towards"))
    throw ElementError("along", "where to: give along, key positions, or towards, a signal's place, not both");
  if (context.values.has("towards")) {
    towards_ = &context.port<Place>("towards");
  } else if (context.values.has("along")) {
    const std::vector<double>& along = context.values.numbers("along");
    for (std::size_t i = 0; i + 2 < along.size(); i += 3) keys_W_.emplace_back(along[i], along[i + 1], along[i + 2]);
    if (keys_W_.empty()) throw ElementError("along", "along needs at least one key position 'x y z'");
    key_W_ = reference_W_ = keys_W_.front();
  }
  const Eigen::Vector3d normal_axis = direction(context, "normal-axis");
  const Eigen::Vector3d forward_axis = direction(context, "forward-axis");
  if (std::abs(normal_axis.dot(forward_axis)) > 1e-6) {
    throw ElementError("forward-axis", "forward-axis must be perpendicular to normal-axis");
  }
  R_EH_ << normal_axis, forward_axis, normal_axis.cross(forward_axis);
  if (context.values.has("yield-from")) {
    yield_from_ = context.values.real("yield-from");
    yield_until_ = context.values.has("yield-until") ? context.values.real("yield-until") : 1.5 * yield_from_;
    if (!(yield_until_ > yield_from_)) throw ElementError("yield-until", "yield-until must be greater than yield-from");
  }
  if (context.values.has("headings")) {
    if (has_heading_) throw ElementError("headings", "give heading, one for all keys, or headings, one for each, not both");
    const std::vector<double>& numbers = context.values.numbers("headings");
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      headings_W_.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
      if (headings_W_.back().norm() < 1e-9) throw ElementError("headings", "a heading must not be a zero vector");
    }
    if (headings_W_.size() != keys_W_.size())
      throw ElementError("headings", "headings has " + std::to_string(headings_W_.size()) + " directions, expected " +
                                         std::to_string(keys_W_.size()) + ", one a key");
    has_heading_ = true;
  }
  if (context.values.has("turn-reach")) turn_reach_ = context.values.real("turn-reach");
  if (context.values.has("turn-avoids")) turn_avoids_W_ = direction(context, "turn-avoids");
  if (yaw_stiffness_ > 0 && !has_heading_ && !towards_) throw ElementError("yaw-stiffness", "yaw-stiffness needs a heading");
}

const Eigen::Vector3d& FollowSurface::key() const {
  if (towards_) return towards_->position_W;
  if (keys_W_.empty()) return reference_W_;
  return keys_W_[std::min<std::size_t>(key_index_, keys_W_.size() - 1)];
}

// Zero: none.
Eigen::Vector3d FollowSurface::heading() const {
  if (yaw_stiffness_ <= 0) return Eigen::Vector3d::Zero();
  if (!headings_W_.empty()) return headings_W_[std::min<std::size_t>(key_index_, headings_W_.size() - 1)];
  if (towards_ && !has_heading_) return towards_->known ? towards_->heading_W : Eigen::Vector3d::Zero();
  return heading_W_;
}

void FollowSurface::updateNormal(double dt) {
  const std::vector<Contact>& contacts = contacts_.contacts;
  if (contacts.empty()) return;
  std::size_t first = 0, second = 0;
  double least_cosine = 2;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = i + 1; j < contacts.size(); ++j) {
      const double cosine = contacts[i].normal_W.dot(contacts[j].normal_W);
      if (cosine < least_cosine) {
        least_cosine = cosine;
        first = i;
        second = j;
      }
    }
  }
  Eigen::Vector3d median = contacts[first].normal_W + contacts[second].normal_W;
  median = median.norm() > 1e-6 ? median.normalized() : contacts[first].normal_W;
  const Eigen::Vector3d blended = normal_W_ + dt / (normal_filter_ + dt) * (median - normal_W_);
  if (blended.norm() > 1e-6) normal_W_ = blended.normalized();
}

void FollowSurface::updatePull(double dt) {
  if (!std::isfinite(yield_from_)) return;
  double largest = 0;
  for (const Contact& contact : yield_contacts_.contacts) largest = std::max(largest, contact.force_N);
  pressed_ += dt / (yield_filter_ + dt) * (largest - pressed_);
  const double s = std::clamp((pressed_ - yield_from_) / (yield_until_ - yield_from_), 0.0, 1.0);
  pull_ = 1 - s * s * (3 - 2 * s);
}

Eigen::Vector3d FollowSurface::wantedNormal() const {
  const Eigen::Vector3d axis = approach_W_.cross(normal_W_);
  const double leaned = std::atan2(axis.norm(), approach_W_.dot(normal_W_));
  if (leaned <= lean_ || axis.norm() < 1e-9) return normal_W_;
  return Eigen::AngleAxisd(lean_, axis.normalized()) * approach_W_;
}

// Angle about the normal from one direction to another.
double FollowSurface::turnFrom(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W) const {
  const Eigen::Vector3d normal_W = wantedNormal();
  const auto angle = [&](const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W) {
    const Eigen::Vector3d a = a_W - a_W.dot(normal_W) * normal_W;
    return std::atan2(normal_W.dot(a.cross(b_W)), a.dot(b_W));
  };
  if (!turn_avoids_W_) return angle(from_W, to_W);
  return angle(-*turn_avoids_W_, to_W) - angle(-*turn_avoids_W_, from_W);
}

Eigen::Matrix3d FollowSurface::wantedOrientation(const Eigen::Matrix3d& R_WH) const {
  const Eigen::Vector3d normal_W = wantedNormal();
  Eigen::Vector3d ahead = heading();
  if (ahead.isZero()) ahead = R_WH.col(1);
  Eigen::Vector3d forward = ahead - ahead.dot(normal_W) * normal_W;
  if (forward.norm() < 1e-6) {
    // The hand points along the normal: any direction within the surface will do; keep the third axis.
    forward = R_WH.col(2).cross(normal_W);
  }
  forward.normalize();
  const double turn = turnFrom(R_WH.col(1), forward), most = pull_ * turn_reach_;
  if (std::isfinite(turn_reach_) && std::abs(turn) > most)
    forward = Eigen::AngleAxisd(std::copysign(most, turn) - turn, normal_W) * forward;
  const Eigen::Vector3d leaned_forward = std::cos(tilt_) * forward + std::sin(tilt_) * normal_W;
  const Eigen::Vector3d leaned_normal = std::cos(tilt_) * normal_W - std::sin(tilt_) * forward;
  Eigen::Matrix3d R_WR;
  R_WR << leaned_normal, leaned_forward, leaned_normal.cross(leaned_forward);
  return R_WR;
}

// What the hand must still turn, beyond a turn-reach.
double FollowSurface::leftToTurn(const Eigen::Matrix3d& R_WH) const {
  const Eigen::Vector3d normal_W = wantedNormal(), ahead = heading();
  const Eigen::Vector3d wanted = ahead - ahead.dot(normal_W) * normal_W;
  return wanted.norm() > 1e-6 ? std::max(std::abs(turnFrom(R_WH.col(1), wanted)) - turn_reach_, 0.0) : 0;
}

void FollowSurface::advanceKey(double time, double way) {
  if (towards_) {                                                  // who names the places also says when to go on
    key_index_ = towards_->number;
    return;
  }
  if (key_index_ >= static_cast<int>(keys_W_.size())) return;
  if (!key_started_) {
    key_started_ = true;
    key_start_time_ = time;
    nearest_ = way;
    progress_time_ = time;
  }
  if (way < nearest_ - stall_progress_) {
    nearest_ = way;
    progress_time_ = time;
  }
  const bool passed = !contacts_.contacts.empty() && way < key_threshold_;
  const bool stalled = !passed && time - progress_time_ > stall_time_ && !contacts_.contacts.empty();
  if (passed) ++keys_passed_;
  if (stalled) {
    ++keys_given_up_;
    given_up_s_ += time - key_start_time_;
  }
  if (passed || stalled) {
    ++key_index_;
    key_started_ = false;
    last_key_time_ = time;
  }
}

void FollowSurface::doUpdate(const Tick& tick, TickTask& rows) {
  updateNormal(tick.dt);
  updatePull(tick.dt);
  const Eigen::Isometry3d X_WE = tick.robot.framePose(frame_);
  const Eigen::Vector3d p_W = X_WE.translation();
  const Eigen::Matrix3d R_WH = X_WE.linear() * R_EH_;
  const dynamics::Vector6d velocity = tick.robot.frameVelocity(frame_);

  // Tangential way to the key; p_r − p by A.1.6.
  Eigen::Vector3d way = key() - p_W;
  way -= way.dot(normal_W_) * normal_W_;
  if (towards_ ? !towards_->known : keys_W_.empty()) way.setZero();
  distance_ = way.norm();
  const Eigen::Vector3d x_e = way * (pull_ * reach_ / std::max(distance_, near_));
  key_W_ = key();
  reference_W_ = p_W + x_e;
  // With a heading of its own, a key is only there once the hand has turned: a turn-reach counts as much as a reach.
  const bool turns = !headings_W_.empty() && yaw_stiffness_ > 0 && std::isfinite(turn_reach_);
  advanceKey(tick.time, distance_ + (turns ? leftToTurn(R_WH) * reach_ / turn_reach_ : 0));

  const auto across = [&](const Eigen::Vector3d& v) { return Eigen::Vector3d(v - normal_W_ * normal_W_.dot(v)); };
  const Eigen::Vector3d v_W = velocity.head<3>();
  const double wanted_normal_speed = contacts_.contacts.empty() ? approach_speed_ : 0;
  const Eigen::Vector3d force = stiffness_ * x_e - damping_ * across(v_W) +
                                damping_normal_ * (wanted_normal_speed - normal_W_.dot(v_W)) * normal_W_;

  const Eigen::Vector3d turn = orientationError(R_WH, wantedOrientation(R_WH));
  const Eigen::Vector3d moment = turn_stiffness_ * across(turn) + yaw_stiffness_ * normal_W_.dot(turn) * normal_W_ -
                                 turn_damping_ * velocity.tail<3>();

  rows.rows = 6;
  tick.robot.frameJacobian(frame_, rows.jacobian.topRows<6>());
  rows.force.head<3>() = force;
  rows.force.segment<3>(3) = moment;
  error_ = distance_;
  key_number_ = key_index_;
}

void FollowSurface::doArchive(Archive& archive) {
  archive("normal", normal_W_);
  archive.whole("key", key_index_, 0, towards_ ? std::numeric_limits<int>::max() : static_cast<int>(keys_W_.size()));
  archive("nearest", nearest_);
  archive("progress-time", progress_time_);
  archive("key-started", key_started_);
  archive("key-start-time", key_start_time_);
  archive("given-up-s", given_up_s_);
  archive("keys-passed", keys_passed_);
  archive("keys-given-up", keys_given_up_);
  archive("key-number", key_number_);
  archive("pressed", pressed_);
  archive("last-key-time", last_key_time_);
}

bool FollowSurface::displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                                 Eigen::Ref<Eigen::VectorXd> dx) const {
  dx = frameDisplacement(from, to, frame_);
  return true;
}

void FollowSurface::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"key", &key_number_});
  columns.push_back({"keys_passed", &keys_passed_});
  columns.push_back({"keys_given_up", &keys_given_up_});
  columns.push_back({"pull", &pull_});
}

void FollowSurface::marks(std::vector<Mark>& marks) const {
  marks.push_back({"key", &key_W_});
  marks.push_back({"reference", &reference_W_});
}

void FollowSurface::metrics(std::vector<Metric>& metrics) const {
  if (towards_) return;
  metrics.push_back({"keys_passed", keys_passed_});
  metrics.push_back({"keys_given_up", keys_given_up_});
  metrics.push_back({"keys_given_up_s", given_up_s_});
  metrics.push_back({"keys_total", static_cast<double>(keys_W_.size())});
  metrics.push_back({"last_key_time_s", last_key_time_});
}

}  // namespace tactus::tasks
