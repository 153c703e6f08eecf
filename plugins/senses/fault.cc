#include "plugins/senses/fault.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "framework/control/sensing_guard.h"

namespace tactus::plugins {

using namespace control;

namespace {

const double kNaN = std::nan("");

/// What a controller gets of it, into memory that is there.
void copy(const Sensed& from, Eigen::Index readings, Sensed& to) {
  to.q = from.q;
  to.qd = from.qd;
  to.contacts.assign(from.contacts.begin(), from.contacts.end());
  to.readings.head(readings) = from.readings.head(readings);
}

}  // namespace

void Fault::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "fault";
  row.description = "What the sensors before it tell goes wrong, from one time until another.";
  row.attributes = {
      {.name = "kind", .type = ValueType::choice, .required = true,
       .description = "`late`: all that is felt is `delay` old. `dropped`: contacts vanish, readings are 0. `stuck`: the "
                      "last values stay. `nan`: no numbers. `jump`: joints are off by `offset`.",
       .choices = {"late", "dropped", "stuck", "nan", "jump"}},
      {.name = "from", .type = ValueType::real, .unit = "s", .default_text = "0", .description = "When it begins.",
       .lower = 0},
      {.name = "until", .type = ValueType::real, .unit = "s", .description = "When it is over; without it never.",
       .lower = 0},
      {.name = "links", .type = ValueType::links, .description = "Contacts of these links go wrong."},
      {.name = "joints", .type = ValueType::joints, .description = "Positions and velocities of these go wrong."},
      {.name = "of", .type = ValueType::text, .description = "Names of sensors before it, whose readings go wrong."},
      {.name = "offset", .type = ValueType::real, .unit = "rad or m", .default_text = "0.1",
       .description = "How far a `jump` is."},
      {.name = "delay", .type = ValueType::real, .unit = "s", .default_text = "0.01",
       .description = "How old it is when `late`.", .lower = 0, .upper = 0.2},
  };
  row.ports = {{.name = "active", .type = "scalar", .unit = "1", .description = "1 while it strikes.", .dimension = 1}};
  registry.addSensor(row, [](const SensorContext& context) { return std::make_unique<Fault>(context); });
}

Fault::Fault(const SensorContext& context)
    : from_(context.values.real("from")),
      until_(context.values.has("until") ? context.values.real("until") : INFINITY),
      offset_(context.values.real("offset")),
      tolerance_(1e-6 * context.control_period),
      links_(context.robot.links.size(), false),
      model_(context.model),
      workspace_(model_) {
  const ElementValues& values = context.values;
  const std::string& kind = values.text("kind");
  kind_ = kind == "dropped" ? Kind::dropped
          : kind == "stuck" ? Kind::stuck
          : kind == "nan"   ? Kind::nan
          : kind == "jump"  ? Kind::jump
                            : Kind::late;
  told_.kind = kind;
  if (until_ <= from_) throw ElementError("until", "it is over before it begins");
  if (values.has("links"))
    for (const int link : context.frames("links")) links_[static_cast<std::size_t>(link)] = true;
  if (values.has("joints")) joints_ = context.joints("joints");
  Eigen::Index before = 0;
  for (const ReadingRow& row : context.before) before += row.count;
  if (values.has("of")) {
    std::istringstream names(values.text("of"));
    for (std::string name; names >> name;) {
      Eigen::Index first = 0;
      bool found = false;
      std::vector<std::string> candidates;
      for (const ReadingRow& row : context.before) {
        candidates.push_back(row.sensor);
        if (row.sensor == name) reaches_.push_back({first, row.count});
        found = found || row.sensor == name;
        first += row.count;
      }
      if (!found) throw ElementError("of", "no sensor '" + name + "' stands before it", candidates);
    }
  }
  const bool hits_links = values.has("links"), hits_joints = !joints_.empty(), hits_readings = !reaches_.empty();
  if (kind_ == Kind::jump && (!hits_joints || hits_links || hits_readings))
    throw ElementError("kind", "a jump is one of joints: give these alone");
  if (kind_ == Kind::late && (hits_links || hits_joints || hits_readings))
    throw ElementError("kind", "all that is felt comes late: leave out links, joints and of");
  if (kind_ == Kind::dropped && (hits_joints || (!hits_links && !hits_readings)))
    throw ElementError("kind", "what drops are contacts of links, or readings of a sensor: give links, or of, or both");
  if ((kind_ == Kind::stuck || kind_ == Kind::nan) && !hits_links && !hits_joints && !hits_readings)
    throw ElementError("kind", "say of what: links, joints or of");
  if (hits_joints && model_.hasQuaternions())
    throw ElementError("joints", "the robot has joints that turn freely, which no single number tells");

  held_.reserve(kind_ == Kind::stuck ? SensingGuard::contact_capacity : 0);
  held_q_.setZero(static_cast<Eigen::Index>(joints_.size()));
  held_readings_.setZero(before);
  if (kind_ != Kind::late) return;
  past_.resize(static_cast<std::size_t>(std::lround(values.real("delay") / context.control_period)) + 1);
  for (Sensed& entry : past_) {
    entry.q.setZero(model_.positionCount());
    entry.qd.setZero(model_.dof());
    entry.contacts.reserve(SensingGuard::contact_capacity);
    entry.readings.setZero(before);
  }
}

bool Fault::strikes(const ContactRecord& contact) const {
  const auto isHit = [this](int link) {
    return link >= 0 && link < static_cast<int>(links_.size()) && links_[static_cast<std::size_t>(link)];
  };
  return isHit(contact.link) || isHit(contact.other_link);
}

void Fault::doSense(const Sensed& truth, Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) {
  const bool active = truth.time >= from_ - tolerance_ && truth.time < until_ - tolerance_;
  readings[0] = told_.strikes = active;
  if (kind_ == Kind::stuck && (!active || !started_)) remember(felt);
  if (kind_ == Kind::late) {
    copy(felt, held_readings_.size(), past_[ticks_ % past_.size()]);
    ++ticks_;
  }
  started_ = true;
  if (!active) return;
  switch (kind_) {
    case Kind::dropped: drop(felt); break;
    case Kind::stuck: stick(felt); break;
    case Kind::nan: loseNumbers(felt); break;
    case Kind::jump: jump(felt); break;
    case Kind::late: tellLate(felt); break;
  }
}

void Fault::doArchive(Archive& archive) {
  archive("started", started_);
  archive.growing("held", held_);
  for (const Held& held : held_)
    if (!strikes(held.record)) throw StateError("a contact that is stuck in the state is of a link that is not");
  archive("held-q", held_q_);
  archive("held-readings", held_readings_);
  archive("past", past_);
  archive("ticks", ticks_);
}

void Fault::drop(Sensed& felt) const {
  std::erase_if(felt.contacts, [this](const ContactRecord& contact) { return strikes(contact); });
  for (const Reach& reach : reaches_) felt.readings.segment(reach.first, reach.count).setZero();
}

void Fault::remember(const Sensed& felt) {
  held_.clear();
  bool placed = false;
  for (const ContactRecord& contact : felt.contacts) {
    if (!strikes(contact) || held_.size() >= SensingGuard::contact_capacity) continue;
    if (!placed) dynamics::forwardKinematics(model_, felt.q, workspace_);
    placed = true;
    const Eigen::Isometry3d X_WL = dynamics::framePose(model_, workspace_, contact.link);
    held_.push_back({contact, X_WL.linear().transpose() * (contact.point_W - X_WL.translation()),
                     X_WL.linear().transpose() * contact.normal_W});
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) held_q_[static_cast<Eigen::Index>(i)] = felt.q[joints_[i]];
  held_readings_ = felt.readings.head(held_readings_.size());
}

void Fault::stick(Sensed& felt) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    felt.q[joints_[i]] = held_q_[static_cast<Eigen::Index>(i)];
    felt.qd[joints_[i]] = 0;
  }
  for (const Reach& reach : reaches_)
    felt.readings.segment(reach.first, reach.count) = held_readings_.segment(reach.first, reach.count);
  std::erase_if(felt.contacts, [this](const ContactRecord& contact) { return strikes(contact); });
  if (held_.empty()) return;
  dynamics::forwardKinematics(model_, felt.q, workspace_);
  for (const Held& held : held_) {
    if (felt.contacts.size() >= SensingGuard::contact_capacity) return;
    const Eigen::Isometry3d X_WL = dynamics::framePose(model_, workspace_, held.record.link);
    felt.contacts.push_back(held.record);
    felt.contacts.back().point_W = X_WL * held.point_L;
    felt.contacts.back().normal_W = X_WL.linear() * held.normal_L;
  }
}

void Fault::loseNumbers(Sensed& felt) const {
  for (const int joint : joints_) felt.q[joint] = felt.qd[joint] = kNaN;
  for (const Reach& reach : reaches_) felt.readings.segment(reach.first, reach.count).setConstant(kNaN);
  for (ContactRecord& contact : felt.contacts) {
    if (!strikes(contact)) continue;
    contact.point_W.setConstant(kNaN);
    contact.normal_W.setConstant(kNaN);
    contact.force_N = kNaN;
  }
}

void Fault::jump(Sensed& felt) const {
  for (const int joint : joints_) felt.q[joint] += offset_;
}

void Fault::tellLate(Sensed& felt) {
  const std::size_t oldest = ticks_ > past_.size() ? ticks_ % past_.size() : 0;
  copy(past_[oldest], held_readings_.size(), felt);
}

}  // namespace tactus::plugins
