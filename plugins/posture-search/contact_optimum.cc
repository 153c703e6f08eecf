#include "plugins/posture-search/contact_optimum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tactus::plugins {

using namespace control;

namespace {

constexpr std::size_t kMostLinks = 16;
constexpr double kMostPostures = 3e7;                              // about a minute's search

}  // namespace

void ContactOptimum::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "contact-optimum";
  row.description = "How many links touch at the end, and how many could in any posture.";
  row.source = "thesis 4.4.2, table 4.4";
  row.attributes = {
      {.name = "links", .type = ValueType::links, .required = true, .description = "Those that should touch."},
      {.name = "joints", .type = ValueType::joints, .required = true,
       .description = "Whose postures are searched: a chain, each moving all that the next one moves."},
      {.name = "facing", .type = ValueType::reals, .unit = "1",
       .description = "A direction in link axes: only touches of what faces it count; as of <skin>.", .count = 3},
      {.name = "arc", .type = ValueType::real, .unit = "rad", .default_text = "1.5707963267948966",
       .description = "How far the normal of a touch may be from `facing`.", .lower = 0, .upper = 3.141592653589793,
       .lower_open = true},
      {.name = "step", .type = ValueType::real, .unit = "rad", .default_text = "0.03",
       .description = "From one posture to the next.", .lower = 0.001, .upper = 0.5},
      {.name = "give", .type = ValueType::real, .unit = "m", .default_text = "0.0005",
       .description = "How deep links may be in things in such a posture, which give way under them.", .lower = 0},
      {.name = "window", .type = ValueType::real, .unit = "s", .default_text = "1",
       .description = "A link touches when it does so for more than half of the last so many seconds.", .lower = 0,
       .upper = 600, .lower_open = true},
  };
  registry.addMeasure(row, [](const MeasureContext& context) { return std::make_unique<ContactOptimum>(context); });
}

ContactOptimum::ContactOptimum(const MeasureContext& context)
    : robot_(context.robot), scene_(context.scene), model_(context.model), workspace_(model_),
      period_(context.control_period) {
  options_.links = context.frames("links");
  options_.joints = context.joints("joints");
  if (options_.links.size() > kMostLinks)
    throw ElementError("links", "at most " + std::to_string(kMostLinks) + " links can be searched for, not " +
                                    std::to_string(options_.links.size()));
  for (const int joint : options_.joints)
    if (!std::isfinite(model_.upper()[joint] - model_.lower()[joint]))
      throw ElementError("joints", "a joint without limits has no end of postures");
  if (context.values.has("facing")) {
    const std::vector<double> facing = context.values.numbers("facing");
    const Eigen::Vector3d direction(facing[0], facing[1], facing[2]);
    if (direction.norm() < 1e-9) throw ElementError("facing", "a direction is not 0 0 0");
    options_.side.facing = direction.normalized();
  }
  options_.side.arc = context.values.real("arc");
  options_.step = context.values.real("step");
  options_.give = context.values.real("give");
  double postures = 1;
  for (const int joint : options_.joints)
    postures *= 1 + std::ceil((model_.upper()[joint] - model_.lower()[joint]) / options_.step);
  if (!scene_.objects.empty() && postures > kMostPostures)
    throw ElementError("joints", "these have " + formatNumber(postures) + " postures, more than the " +
                                     formatNumber(kMostPostures) + " that are searched: take fewer joints or a larger step");
  try {
    PostureSearch(robot_, model_, options_);
  } catch (const std::invalid_argument& error) {
    throw ElementError("joints", error.what());
  }
  touches_.resize(options_.links.size());
  window_.resize(static_cast<std::size_t>(std::max(1L, std::lround(context.values.real("window") / period_))));
  for (const description::Object& object : scene_.objects) objects_.push_back(object.pose);
  q_.setZero(model_.dof());
}

void ContactOptimum::doObserve(const ObservedTick& tick) {
  q_ = tick.truth.q;
  for (std::size_t i = 0; i < std::min(objects_.size(), tick.objects.size()); ++i) objects_[i] = tick.objects[i].pose;
  dynamics::forwardKinematics(model_, q_, workspace_);
  for (Touch& touch : touches_) touch.force_N = 0;
  for (const ContactRecord& record : tick.truth.contacts) {
    const auto link = std::find(options_.links.begin(), options_.links.end(), record.link);
    if (link == options_.links.end() || record.isOfSelf()) continue;
    const Eigen::Isometry3d X_WL = dynamics::framePose(model_, workspace_, record.link);
    if (options_.side.has(X_WL.linear().transpose() * record.normal_W))
      touches_[static_cast<std::size_t>(link - options_.links.begin())].force_N += record.force_N;
  }
  std::uint32_t now = 0;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    touches_[i].on.update(touches_[i].force_N, period_);
    if (touches_[i].on.on()) now |= 1u << i;
  }
  window_[static_cast<std::size_t>(ticks_) % window_.size()] = now;
  touching_now_ = std::popcount(now);
  ++ticks_;
}

int ContactOptimum::reached() const {
  const auto count = std::min(static_cast<std::size_t>(ticks_), window_.size());
  int links = 0;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const auto on = std::count_if(window_.begin(), window_.begin() + static_cast<std::ptrdiff_t>(count),
                                  [&](std::uint32_t tick) { return tick & (1u << i); });
    links += 2 * static_cast<std::size_t>(on) > count;
  }
  return links;
}

geometry::Compound ContactOptimum::world() const {
  std::vector<geometry::PosedShape> parts;
  for (std::size_t i = 0; i < objects_.size(); ++i)
    for (const description::Primitive& primitive : scene_.objects[i].primitives)
      parts.push_back({primitive.shape, objects_[i] * primitive.pose});
  return geometry::Compound(std::move(parts));
}

void ContactOptimum::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"touching", &touching_now_});
}

void ContactOptimum::metrics(std::vector<Metric>& metrics) const {
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (searched_at_ != ticks_ && ticks_ > 0) {
    optimum_ = objects_.empty() ? PostureFound{0, q_} : PostureSearch(robot_, model_, options_)(world(), q_);
    searched_at_ = ticks_;
  }
  const bool found = ticks_ > 0 && optimum_.q.size() > 0;
  const int links = reached();
  metrics.push_back({"reached", ticks_ > 0 ? links : none});
  metrics.push_back({"optimum", found ? optimum_.touching : none});
  metrics.push_back({"missed", found ? optimum_.touching - links : none});
  const std::vector<int> moving = robot_.movingJoints();
  for (const int joint : options_.joints)
    metrics.push_back({"q_" + robot_.joints[static_cast<std::size_t>(moving[static_cast<std::size_t>(joint)])].name,
                       found ? optimum_.q[joint] : none});
}

void ContactOptimum::Touch::archive(Archive& archive) {
  archive("force", force_N);
  archive("on", on);
}

void ContactOptimum::doArchive(Archive& archive) {
  archive("touches", touches_);
  archive("window", window_);
  archive("ticks", ticks_);
  archive("touching-now", touching_now_);
  archive("q", q_);
  archive("objects", objects_);
  if (!(ticks_ >= 0)) throw StateError("measure: the number of ticks is negative");
  searched_at_ = -1;
}

}  // namespace tactus::plugins
