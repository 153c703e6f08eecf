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
  row.description = "What the skin feels, sorted into held, undesired and missing contacts; one contact a link, or more.";
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
      {.name = "per-link", .type = ValueType::integer, .unit = "1", .default_text = "1",
       .description = "Contacts of one link at most; 1: one in the middle of all its touches, as in the thesis.",
       .lower = 1, .upper = 8},
      {.name = "apart", .type = ValueType::real, .unit = "m", .default_text = "0.01",
       .description = "Where per-link is above 1: touches of a link that are nearer to each other are one contact.",
       .lower = 0},
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
      spacing_(context.values.real("spacing")),
      apart_(context.values.real("apart")) {
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
  const int per_link = context.values.integer("per-link");
  int feeling = 0;
  for (LinkTouch& link : links_) {
    if (!link.feels) continue;
    link.touches.resize(static_cast<std::size_t>(per_link));
    link.recent.assign(kRecentPoints, Eigen::Vector3d::Constant(1e9));
    ++feeling;
  }
  const int desired = static_cast<int>(desired_.frames.size());
  held_.per_link = undesired_.per_link = all_.per_link = per_link;
  held_.capacity = per_link * desired;
  undesired_.capacity = per_link * (feeling - desired);
  all_.capacity = per_link * feeling;
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
    for (Touch& touch : link.touches) applyHysteresis(touch, tick.time);
  }
  publish(tick);
}

// Without what every tick makes anew.
void Contacts::Touch::archive(Archive& archive) {
  archive("on", on);
  archive("pending-since", pending_since);
  archive("point", point_L);
  archive("normal", normal_L);
}

void Contacts::LinkTouch::archive(Archive& archive) {
  archive("touches", touches);
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
    for (Touch& touch : link.touches) {
      touch.force_N = 0;
      touch.point_W.setZero();
      touch.normal_W.setZero();
    }
  }
  n_self_ = 0;
  for (const ContactRecord& record : tick.sensed.contacts) {
    if (record.isOfSelf()) {
      n_self_ += record.force_N > on_force_;
      continue;
    }
    LinkTouch& link = links_[record.link];
    if (!link.feels || !(record.force_N > 0)) continue;
    Touch& touch = link.touches.size() == 1
                       ? link.touches.front()
                       : touchOf(link, tick.robot.framePose(record.link).inverse() * record.point_W);
    touch.force_N += record.force_N;
    touch.point_W += record.force_N * record.point_W;
    touch.normal_W += record.force_N * record.normal_W;
    if (record.force_N > on_force_) rememberPoint(link, record.link, record, tick.time);
  }
  for (std::size_t frame = 0; frame < links_.size(); ++frame)
    for (Touch& touch : links_[frame].touches)
      if (touch.force_N > 0) average(touch, tick.robot.framePose(static_cast<int>(frame)));
}

Contacts::Touch& Contacts::touchOf(LinkTouch& link, const Eigen::Vector3d& point_L) const {
  Touch *nearest = nullptr, *free = nullptr;
  double least = 0;
  for (Touch& touch : link.touches) {
    if (!touch.isTaken()) {
      if (!free) free = &touch;
      continue;
    }
    const double distance = (touch.point_L - point_L).norm();
    if (nearest && distance >= least) continue;
    nearest = &touch;
    least = distance;
  }
  if (nearest && (least <= apart_ || !free)) return *nearest;
  free->point_L = point_L;
  return *free;
}

void Contacts::average(Touch& touch, const Eigen::Isometry3d& X_WL) const {
  touch.point_W /= touch.force_N;
  // Opposed normals (a link pinched from both sides) cancel: keep the last direction then.
  const double length = touch.normal_W.norm();
  if (length > 1e-6 * touch.force_N) {
    touch.normal_W /= length;
    touch.normal_L = X_WL.linear().transpose() * touch.normal_W;
  } else {
    touch.normal_W = X_WL.linear() * touch.normal_L;
  }
  touch.point_L = X_WL.inverse() * touch.point_W;
}

void Contacts::applyHysteresis(Touch& touch, double time) const {
  const bool change = touch.on ? touch.force_N < off_force_ : touch.force_N > on_force_;
  if (!change) {
    touch.pending_since = -1;
    return;
  }
  if (touch.pending_since < 0) touch.pending_since = time;
  if (time - touch.pending_since >= hold_ - 1e-9) {
    touch.on = !touch.on;
    touch.pending_since = -1;
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
  n_touching_ = 0;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const LinkTouch& link = links_[i];
    const int frame = static_cast<int>(i);
    bool on = false;
    for (std::size_t number = 0; number < link.touches.size(); ++number) {
      const Touch& touch = link.touches[number];
      if (!touch.on) continue;
      on = true;
      const Eigen::Isometry3d X_WL = tick.robot.framePose(frame);
      const Contact contact{frame, X_WL * touch.point_L, X_WL.linear() * touch.normal_L, touch.force_N,
                            static_cast<int>(number)};
      all_.contacts.push_back(contact);
      (link.desired ? held_ : undesired_).contacts.push_back(contact);
    }
    n_touching_ += link.desired && on;
    if (link.desired && !on) missing_.points.push_back({frame, link.slot, tick.robot.framePose(frame) * link.centre_L});
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
  if (name == "touching") return &n_touching_;
  if (name == "self") return &n_self_;
  return nullptr;
}

void Contacts::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"held", &n_held_});
  columns.push_back({"undesired", &n_undesired_});
  columns.push_back({"points", &n_points_});
}

}  // namespace tactus::tasks
