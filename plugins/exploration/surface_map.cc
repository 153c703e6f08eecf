#include "plugins/exploration/surface_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::exploration {

using namespace control;
using Eigen::Vector3d;

namespace {

constexpr int directions = 8;
constexpr int newton_steps = 4;
constexpr std::size_t most_met = 20000;
constexpr int check_every = 16;                                    // looks, at how well the goal is known
constexpr double on_surface = 0.2;                                 // of the mean, where a place counts as on it
const Vector3d nowhere = Vector3d::Constant(1e9);

}  // namespace

void SurfaceMap::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "surface-map";
  row.description = "What is known of a surface from touched points, and the place that is known least, to go there.";
  row.source = "Williams, Fitzgibbon 2007; Dragiev, Toussaint, Gienger 2011; Rasmussen, Williams 2006, 2.25-2.26";
  row.attributes = {
      {.name = "from", .type = ValueType::port, .required = true, .description = "Touched points, e.g. touch.points.",
       .port_type = "touched-points"},
      {.name = "on", .type = ValueType::port, .required = true,
       .description = "Contacts whose middle is brought to the place, e.g. touch.held.", .port_type = "contact-set"},
      {.name = "frame", .type = ValueType::link, .required = true, .description = "The link for which `next` is a goal."},
      {.name = "length", .type = ValueType::real, .unit = "m", .default_text = "0.06",
       .description = "Length scale of the covariance.", .lower = 0, .lower_open = true},
      {.name = "noise", .type = ValueType::real, .unit = "1", .default_text = "0.05",
       .description = "Standard deviation of the noise on an observation; the prior one is 1.", .lower = 1e-6},
      {.name = "spacing", .type = ValueType::real, .unit = "m", .default_text = "0.02",
       .description = "A touched point nearer than this to one that is kept is passed over.", .lower = 0,
       .lower_open = true},
      {.name = "capacity", .type = ValueType::integer, .default_text = "200", .description = "Points that are kept.",
       .lower = 1, .upper = 2000},
      {.name = "depth", .type = ValueType::real, .unit = "m", .default_text = "0.03",
       .description = "How far behind a touched point its inside is observed.", .lower = 0, .lower_open = true},
      {.name = "step", .type = ValueType::real, .unit = "m", .default_text = "0.06",
       .description = "How far around what is known places are looked for.", .lower = 0, .lower_open = true},
      {.name = "within", .type = ValueType::reals, .unit = "m", .default_text = "-9 -9 -9 9 9 9",
       .description = "Lower and upper corner of the box in which places lie, world axes.", .count = 6},
      {.name = "facing", .type = ValueType::reals, .unit = "1", .default_text = "0 0 1",
       .description = "Direction to which the surface must face for the hand to touch it, world axes.", .count = 3,
       .in_world = InWorld::directions},
      {.name = "first", .type = ValueType::reals, .unit = "1", .default_text = "1 0 0",
       .description = "Direction across `facing` from which the directions around a point are counted, world axes.",
       .count = 3, .in_world = InWorld::directions},
      {.name = "facing-angle", .type = ValueType::real, .unit = "rad", .default_text = "1.6",
       .description = "And by how much its outward normal may differ.", .lower = 0, .upper = 3.15},
      {.name = "known", .type = ValueType::real, .unit = "1", .default_text = "0.4",
       .description = "A place is known when its standard deviation, over the prior one, is below this.", .lower = 0,
       .upper = 1},
      {.name = "met-within", .type = ValueType::real, .unit = "m",
       .description = "And when a touched point is as near as this; not given: however far they are.", .lower = 0,
       .lower_open = true},
      {.name = "nearness", .type = ValueType::real, .unit = "1/m", .default_text = "2",
       .description = "What a metre of way counts against standard deviation.", .lower = 0},
      {.name = "heading", .type = ValueType::choice, .default_text = "any",
       .description = "How the frame shall point when it gets to a place: anyhow, or away from the middle of what is known.",
       .choices = {"any", "outwards"}},
      {.name = "forward-axis", .type = ValueType::reals, .unit = "1", .default_text = "0 0 1",
       .description = "Axis of the frame that then points there.", .count = 3},
      {.name = "clearance", .type = ValueType::real, .unit = "m", .default_text = "0.06",
       .description = "Places this near to one that was given up are left out for a while.", .lower = 0},
      {.name = "patience", .type = ValueType::real, .unit = "s", .default_text = "2",
       .description = "A place is given up after so long without progress.", .lower = 0, .lower_open = true},
      {.name = "progress", .type = ValueType::real, .unit = "m", .default_text = "0.005",
       .description = "What counts as progress towards a place.", .lower = 0},
      {.name = "every", .type = ValueType::integer, .default_text = "2",
       .description = "Ticks between two pieces of work, an observation or a look at a place.", .lower = 1},
  };
  row.ports = {{"next", "place", "m", "Where `frame` should go."},
               {"uncertainty", "scalar", "1", "Largest standard deviation of the last round's places, over the prior one."},
               {"points", "scalar", "1", "Points that are kept."}};
  registry.addSignal(row, [](const BuildContext& context) { return std::make_unique<SurfaceMap>(context); });
}

SurfaceMap::SurfaceMap(const BuildContext& context)
    : touched_(context.port<TouchedPoints>("from")),
      contacts_(context.port<ContactSet>("on")),
      frame_(context.frame("frame")),
      spacing_(context.values.real("spacing")),
      depth_(context.values.real("depth")),
      step_(context.values.real("step")),
      facing_cosine_(std::cos(context.values.real("facing-angle"))),
      known_(context.values.real("known")),
      nearness_(context.values.real("nearness")),
      patience_(context.values.real("patience")),
      progress_(context.values.real("progress")),
      every_(context.values.integer("every")),
      clearance_(context.values.real("clearance")),
      outwards_(context.values.text("heading") == "outwards"),
      facing_W_(context.values.vector3("facing")),
      first_W_(context.values.vector3("first")),
      forward_F_(context.values.vector3("forward-axis")),
      capacity_(context.values.integer("capacity")),
      process_({context.values.real("length"), 1, context.values.real("noise")}, 1, 2 * capacity_) {
  const std::vector<double>& within = context.values.numbers("within");
  for (int i = 0; i < 3; ++i) {
    box_W_[0][i] = within[static_cast<std::size_t>(i)];
    box_W_[1][i] = within[static_cast<std::size_t>(i) + 3];
    if (!(box_W_[0][i] < box_W_[1][i])) throw ElementError("within", "within names a lower and an upper corner of a box");
  }
  if (forward_F_.norm() < 1e-9) throw ElementError("forward-axis", "forward-axis must not be a zero vector");
  if (facing_W_.norm() < 1e-9) throw ElementError("facing", "facing must not be a zero vector");
  facing_W_.normalize();
  if (first_W_.norm() < 1e-9 || std::abs(first_W_.normalized().dot(facing_W_)) > 1e-6)
    throw ElementError("first", "first must be perpendicular to facing");
  first_W_.normalize();
  points_W_.reserve(static_cast<std::size_t>(capacity_));
  normals_W_.reserve(static_cast<std::size_t>(capacity_));
  left_W_.fill(nowhere);
  if (context.values.has("met-within")) {
    met_within_ = context.values.real("met-within");
    met_W_.reserve(most_met);
  }
}

void SurfaceMap::doUpdate(const Tick& tick) {
  if (!contacts_.contacts.empty()) {
    middle_W_.setZero();
    for (const Contact& contact : contacts_.contacts) middle_W_ += contact.point_W;
    middle_W_ /= static_cast<double>(contacts_.contacts.size());
    has_middle_ = true;
  }
  if (++tick_ >= every_) {
    tick_ = 0;
    if (!learn()) look();
    if (has_goal_ && looked_ % check_every == 0) {
      goal_uncertainty_ = uncertaintyAt(goal_W_);
      goal_met_ = isMet(goal_W_);
    }
  }
  followGoal(tick.time);
  next_.known = has_goal_;
  next_.heading_W = heading_W_;
  if (has_goal_) {
    const Eigen::Isometry3d X_WF = tick.robot.framePose(frame_);
    Vector3d ahead_W = Vector3d::Zero();
    if (has_middle_ && !contacts_.contacts.empty()) ahead_W = middle_W_ - X_WF.translation();
    if (outwards_ && !heading_W_.isZero()) ahead_W = turnTo(X_WF.linear() * forward_F_) * ahead_W;
    next_.position_W = goal_W_ - ahead_W;
  }
  n_points_ = static_cast<double>(points_W_.size());
}

// One observation; false when there is none to make.
bool SurfaceMap::learn() {
  if (owes_depth_) {
    owes_depth_ = false;
    process_.observe(points_W_.back() - depth_ * normals_W_.back(), -1);
    return true;
  }
  while (read_ < touched_.points.size()) {
    const TouchedPoint& touched = touched_.points[read_++];
    meet(touched.point_W);
    if (static_cast<int>(points_W_.size()) == capacity_) continue;
    const auto isNear = [&](const Vector3d& kept) {
      return (kept - touched.point_W).squaredNorm() < spacing_ * spacing_;
    };
    if (std::any_of(points_W_.begin(), points_W_.end(), isNear)) continue;
    if (!process_.observe(touched.point_W, 0)) continue;
    points_W_.push_back(touched.point_W);
    normals_W_.push_back(-touched.normal_W);
    owes_depth_ = true;
    return true;
  }
  return false;
}

double SurfaceMap::uncertaintyAt(const Vector3d& p_W) {
  return std::sqrt(process_.variance(p_W)) / process_.covariance().deviation;
}

void SurfaceMap::meet(const Vector3d& p_W) {
  if (met_within_ <= 0 || met_W_.size() >= most_met) return;
  const double apart = 0.5 * met_within_;
  const auto isNear = [&](const Vector3d& met) { return (met - p_W).squaredNorm() < apart * apart; };
  if (std::none_of(met_W_.begin(), met_W_.end(), isNear)) met_W_.push_back(p_W);
}

bool SurfaceMap::isMet(const Vector3d& p_W) const {
  if (met_within_ <= 0) return true;
  return std::any_of(met_W_.begin(), met_W_.end(),
                     [&](const Vector3d& met) { return (met - p_W).squaredNorm() < met_within_ * met_within_; });
}

bool SurfaceMap::placeAround(int point, int direction, Vector3d& place_W) const {
  const Vector3d& normal = normals_W_[static_cast<std::size_t>(point)];
  const bool along_first = std::abs(normal.dot(first_W_)) >= 0.9;
  const Vector3d first = normal.cross(along_first ? Vector3d(facing_W_.cross(first_W_)) : first_W_).normalized();
  const double angle = 2 * std::numbers::pi * direction / directions;
  place_W = points_W_[static_cast<std::size_t>(point)] + step_ * (std::cos(angle) * first + std::sin(angle) * normal.cross(first));
  Vector3d gradient;
  double mean = 0;
  for (int k = 0; k <= newton_steps; ++k) {
    mean = process_.mean(place_W, gradient);
    const double square = gradient.squaredNorm();
    if (k == newton_steps || square < 1e-6) break;
    Vector3d move = -mean / square * gradient;
    const double most = 0.5 * step_;
    if (move.norm() > most) move *= most / move.norm();
    place_W += move;
  }
  if (std::abs(mean) > on_surface || gradient.norm() < 1e-6) return false;
  if ((place_W.array() < box_W_[0].array()).any() || (place_W.array() > box_W_[1].array()).any()) return false;
  if (gradient.normalized().dot(facing_W_) < facing_cosine_) return false;
  return std::none_of(left_W_.begin(), left_W_.end(),
                      [&](const Vector3d& left) { return (left - place_W).squaredNorm() < clearance_ * clearance_; });
}

void SurfaceMap::look() {
  if (points_W_.empty()) return;
  // Who waits for a goal takes the best so far, once each point has been looked around in some direction.
  if (!has_goal_ && best_.found && looked_ >= static_cast<int>(points_W_.size())) choose();
  if (looked_ >= directions * static_cast<int>(points_W_.size())) {
    most_uncertain_ = best_.found ? best_.uncertainty : 0;
    if (!has_goal_) choose();
    best_ = {};
    looked_ = 0;
    return;
  }
  // Points in turn, so that a round sees all sides early.
  const int count = static_cast<int>(points_W_.size());
  Vector3d place_W;
  const int now = looked_++;
  if (!placeAround(now % count, now / count % directions, place_W)) return;
  const double uncertainty = uncertaintyAt(place_W);
  if (uncertainty < known_ && isMet(place_W)) return;
  const double score = uncertainty - (has_middle_ ? nearness_ * (place_W - middle_W_).norm() : 0);
  if (score > best_.score) best_ = {true, score, uncertainty, place_W};
}

void SurfaceMap::choose() {
  if (!best_.found) {
    left_W_.fill(nowhere);                                         // what was given up may be tried again
    return;
  }
  has_goal_ = true;
  goal_W_ = best_.point_W;
  goal_uncertainty_ = best_.uncertainty;
  goal_met_ = false;
  best_ = {};
  looked_ = 0;
  nearest_ = 1e9;
  goal_time_ = -1;
  if (outwards_) headOutwards();
  ++next_.number;
}

void SurfaceMap::headOutwards() {
  Vector3d middle_W = Vector3d::Zero();
  for (const Vector3d& point_W : points_W_) middle_W += point_W / static_cast<double>(points_W_.size());
  Vector3d out_W = goal_W_ - middle_W;
  out_W -= out_W.dot(facing_W_) * facing_W_;
  if (out_W.norm() > 0.5 * step_) heading_W_ = out_W.normalized();
}

// The rotation about `facing` that takes a direction to the heading.
Eigen::Matrix3d SurfaceMap::turnTo(const Vector3d& forward_W) const {
  const double angle = std::atan2(facing_W_.dot(forward_W.cross(heading_W_)), forward_W.dot(heading_W_));
  return Eigen::AngleAxisd(angle, facing_W_).toRotationMatrix();
}

void SurfaceMap::followGoal(double time) {
  if (!has_goal_) return;
  if (goal_time_ < 0) goal_time_ = time;
  const double distance = (goal_W_ - middle_W_).norm();
  if (distance < nearest_ - progress_ || contacts_.contacts.empty()) {
    if (!contacts_.contacts.empty()) nearest_ = distance;
    progress_time_ = time;
  }
  if (goal_uncertainty_ < known_ && goal_met_) return leaveGoal(true, time);
  if (time - progress_time_ > patience_) leaveGoal(false, time);
}

void SurfaceMap::leaveGoal(bool reached, double time) {
  has_goal_ = false;
  ++(reached ? reached_ : given_up_);
  if (reached) return;
  given_up_s_ += time - goal_time_;
  left_W_[static_cast<std::size_t>(left_next_)] = goal_W_;
  left_next_ = (left_next_ + 1) % static_cast<int>(left_W_.size());
}

void SurfaceMap::Candidate::archive(control::Archive& archive) {
  archive("found", found);
  archive("score", score);
  archive("uncertainty", uncertainty);
  archive("point", point_W);
}

void SurfaceMap::doArchive(Archive& archive) {
  archive("process", process_);
  archive.growing("points", points_W_);
  archive.growing("normals", normals_W_);
  archive("read", read_);
  archive.growing("met", met_W_);
  archive("goal-met", goal_met_);
  archive("owes-depth", owes_depth_);
  archive("tick", tick_);
  archive("looked", looked_);
  archive("best", best_);
  archive("middle", middle_W_);
  archive("has-middle", has_middle_);
  archive("goal", goal_W_);
  archive("has-goal", has_goal_);
  archive("heading", heading_W_);
  archive("goal-time", goal_time_);
  archive("given-up-s", given_up_s_);
  archive("nearest", nearest_);
  archive("progress-time", progress_time_);
  archive("goal-uncertainty", goal_uncertainty_);
  archive("left", left_W_);
  archive.whole("left-next", left_next_, 0, static_cast<std::int64_t>(left_W_.size()) - 1);
  archive("next", next_);
  archive("most-uncertain", most_uncertain_);
  archive("reached", reached_);
  archive("given-up", given_up_);
  if (points_W_.size() != normals_W_.size() || static_cast<int>(points_W_.size()) > capacity_)
    throw StateError("the state's map has " + std::to_string(points_W_.size()) + " points and " +
                     std::to_string(normals_W_.size()) + " normals; here as many of both, up to " + std::to_string(capacity_));
}

const void* SurfaceMap::doPort(std::string_view name) const {
  if (name == "next") return &next_;
  if (name == "uncertainty") return &most_uncertain_;
  if (name == "points") return &n_points_;
  return nullptr;
}

void SurfaceMap::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"points", &n_points_});
  columns.push_back({"uncertainty", &most_uncertain_});
  columns.push_back({"reached", &reached_});
  columns.push_back({"given_up", &given_up_});
}

void SurfaceMap::metrics(std::vector<Metric>& metrics) const {
  metrics.push_back({"map_points", n_points_});
  metrics.push_back({"places_reached", reached_});
  metrics.push_back({"places_given_up", given_up_});
  metrics.push_back({"places_given_up_s", given_up_s_});
}

}  // namespace tactus::exploration
