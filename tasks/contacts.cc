#include "tasks/contacts.h"

#include <algorithm>

#include "framework/description/link_shape.h"

namespace tactus::tasks {

using namespace control;

namespace {

constexpr int kRecentPoints = 16;
constexpr int kMaxTouchedPoints = 50000;

}  // namespace

void Contacts::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "contacts";
  row.kind = ElementKind::signal;
  row.description = "What the skin feels, sorted into held, undesired and missing contacts; one contact a link.";
  row.source = "thesis 4.2, table 4.1";
  row.attributes = {
      {.name = "desired", .type = ValueType::links, .required = true,
       .description = "Links that should touch (D); a group or link names."},
      {.name = "on-force", .type = ValueType::real, .unit = "N", .default_text = "0.05",
       .description = "A link comes into contact above this force.", .lower = 0},
      {.name = "off-force", .type = ValueType::real, .unit = "N", .default_text = "0.02",
       .description = "A link leaves contact below this force.", .lower = 0},
      {.name = "hold", .type = ValueType::real, .unit = "s", .default_text = "0.005",
       .description = "Time that a change must last before it counts.", .lower = 0},
      {.name = "spacing", .type = ValueType::real, .unit = "m", .default_text = "0.002",
       .description = "A touched point is recorded when it lies this far from the link's last ones.", .lower = 0},
  };
  row.ports = {{"held", "contact-set", "", "Contacts on desired links, C∩D."},
               {"undesired", "contact-set", "", "Contacts on all other links, C\\D."},
               {"all", "contact-set", "", "Every contact, C."},
               {"missing", "missing-set", "", "Desired links without contact, D\\C."},
               {"points", "touched-points", "m", "Every point touched so far."},
               {"desired", "frame-set", "", "The desired links, D."},
               {"touching", "scalar", "1", "How many desired links touch."},
               {"self", "scalar", "1",
                "Touches of the robot on itself, now, above `on-force`; they are in no other port."}};
  registry.addSignal(row, [](const BuildContext& context) { return std::make_unique<Contacts>(context); });
}

Contacts::Contacts(const BuildContext& context)
    : on_force_(context.values.real("on-force")),
      off_force_(context.values.real("off-force")),
      hold_(context.values.real("hold")),
      spacing_(context.values.real("spacing")) {
  if (off_force_ > on_force_) throw ElementError("off-force", "off-force must not be greater than on-force");
  const description::Robot& robot = context.robot;
  links_.resize(robot.links.size());
  for (const std::string& name : robot.skin) links_[robot.linkIndex(name)].feels = true;
  desired_.frames = context.frames("desired");
  for (int slot = 0; slot < static_cast<int>(desired_.frames.size()); ++slot) {
    LinkTouch& link = links_[desired_.frames[slot]];
    const description::Link& described = robot.links[desired_.frames[slot]];
    if (!link.feels) throw ElementError("desired", "link '" + described.name + "' has no skin, so it cannot be desired to touch");
    link.desired = true;
    link.slot = slot;
    link.centre_L = description::middleOf(described);
  }
  int feeling = 0;
  for (LinkTouch& link : links_) {
    link.point_L.setZero();
    link.normal_L.setZero();
    if (link.feels) {
      link.recent.assign(kRecentPoints, Eigen::Vector3d::Constant(1e9));
      ++feeling;
    }
  }
  const int desired = static_cast<int>(desired_.frames.size());
  held_.capacity = desired;
  undesired_.capacity = feeling - desired;
  all_.capacity = feeling;
  missing_.capacity = desired;
  held_.contacts.reserve(held_.capacity);
  undesired_.contacts.reserve(undesired_.capacity);
  all_.contacts.reserve(all_.capacity);
  missing_.points.reserve(missing_.capacity);
  missing_.all_contacts = &all_.contacts;
  points_.points.reserve(kMaxTouchedPoints);
}

void Contacts::doUpdate(const Tick& tick) {
  accumulateRecords(tick);
  for (LinkTouch& link : links_) {
    if (link.feels) applyHysteresis(link, tick.time);
  }
  publish(tick);
}

// Without what every tick makes anew.
void Contacts::LinkTouch::archive(Archive& archive) {
  archive("on", on);
  archive("pending-since", pending_since);
  archive("point", point_L);
  archive("normal", normal_L);
  archive("recent", recent);
  archive.whole("recent-next", recent_next, 0, kRecentPoints - 1);
}

void Contacts::doArchive(Archive& archive) {
  archive("links", links_);
  archive("points", points_);
  for (const TouchedPoint& point : points_.points)
    if (point.frame < 0 || point.frame >= static_cast<int>(links_.size()))
      throw StateError("a touched point of the state is of link " + std::to_string(point.frame) + ", which is not there");
}

void Contacts::accumulateRecords(const Tick& tick) {
  for (LinkTouch& link : links_) {
    link.force_N = 0;
    link.point_W.setZero();
    link.normal_W.setZero();
  }
  n_self_ = 0;
  for (const ContactRecord& record : tick.sensed.contacts) {
    if (record.isOfSelf()) {
      n_self_ += record.force_N > on_force_;
      continue;
    }
    LinkTouch& link = links_[record.link];
    if (!link.feels || !(record.force_N > 0)) continue;
    link.force_N += record.force_N;
    link.point_W += record.force_N * record.point_W;
    link.normal_W += record.force_N * record.normal_W;
    if (record.force_N > on_force_) rememberPoint(link, record.link, record, tick.time);
  }
  for (std::size_t frame = 0; frame < links_.size(); ++frame) {
    LinkTouch& link = links_[frame];
    if (!(link.force_N > 0)) continue;
    link.point_W /= link.force_N;
    // Opposed normals (a link pinched from both sides) cancel: keep the last direction then.
    const Eigen::Isometry3d X_WL = tick.robot.framePose(static_cast<int>(frame));
    const double length = link.normal_W.norm();
    if (length > 1e-6 * link.force_N) {
      link.normal_W /= length;
      link.normal_L = X_WL.linear().transpose() * link.normal_W;
    } else {
      link.normal_W = X_WL.linear() * link.normal_L;
    }
    link.point_L = X_WL.inverse() * link.point_W;
  }
}

void Contacts::applyHysteresis(LinkTouch& link, double time) const {
  const bool change = link.on ? link.force_N < off_force_ : link.force_N > on_force_;
  if (!change) {
    link.pending_since = -1;
    return;
  }
  if (link.pending_since < 0) link.pending_since = time;
  if (time - link.pending_since >= hold_ - 1e-9) {
    link.on = !link.on;
    link.pending_since = -1;
  }
}

void Contacts::rememberPoint(LinkTouch& link, int frame, const ContactRecord& record, double time) {
  if (points_.points.size() >= kMaxTouchedPoints) return;
  for (const Eigen::Vector3d& last : link.recent) {
    if ((last - record.point_W).squaredNorm() < spacing_ * spacing_) return;
  }
  link.recent[link.recent_next] = record.point_W;
  link.recent_next = (link.recent_next + 1) % kRecentPoints;
  points_.points.push_back({time, frame, record.point_W, record.normal_W, record.force_N});
}

void Contacts::publish(const Tick& tick) {
  held_.contacts.clear();
  undesired_.contacts.clear();
  all_.contacts.clear();
  missing_.points.clear();
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const LinkTouch& link = links_[i];
    const int frame = static_cast<int>(i);
    if (link.on) {
      const Eigen::Isometry3d X_WL = tick.robot.framePose(frame);
      const Contact contact{frame, X_WL * link.point_L, X_WL.linear() * link.normal_L, link.force_N};
      all_.contacts.push_back(contact);
      (link.desired ? held_ : undesired_).contacts.push_back(contact);
    } else if (link.desired) {
      missing_.points.push_back({frame, link.slot, tick.robot.framePose(frame) * link.centre_L});
    }
  }
  n_held_ = static_cast<double>(held_.contacts.size());
  n_undesired_ = static_cast<double>(undesired_.contacts.size());
  n_points_ = static_cast<double>(points_.points.size());
}

const void* Contacts::doPort(std::string_view name) const {
  if (name == "held") return &held_;
  if (name == "undesired") return &undesired_;
  if (name == "all") return &all_;
  if (name == "missing") return &missing_;
  if (name == "points") return &points_;
  if (name == "desired") return &desired_;
  if (name == "touching") return &n_held_;
  if (name == "self") return &n_self_;
  return nullptr;
}

void Contacts::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"held", &n_held_});
  columns.push_back({"undesired", &n_undesired_});
  columns.push_back({"points", &n_points_});
}

}  // namespace tactus::tasks
