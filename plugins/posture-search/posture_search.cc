#include "plugins/posture-search/posture_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace tactus::plugins {

using Eigen::Vector3d;

namespace {

constexpr double kSpacing = 0.002;                                 // m, of the points where a capsule is first looked at
constexpr double kPositionError = 1e-8;                           // rad (m), of a touch
constexpr double kGapError = 1e-7;                                // m, of a touch: kPositionError on an arm of metres
constexpr double kRounding = 1e-9;

/// The least of a function that falls, then rises, between low and high.
template <class Function>
double placeOfLeast(Function&& f, double low, double high) {
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double f_a = f(a), f_b = f(b);
  while (high - low > 1e-6) {
    if (f_a < f_b) {
      high = b;
      b = a;
      f_b = f_a;
      f_a = f(a = high - ratio * (high - low));
    } else {
      low = a;
      a = b;
      f_a = f_b;
      f_b = f(b = low + ratio * (high - low));
    }
  }
  return 0.5 * (low + high);
}

/// Capsules as which a link is looked at; a box by its edges and the lines through the middles of its faces.
std::vector<description::CapsuleShape> linesOf(const description::Link& link) {
  std::vector<description::CapsuleShape> lines;
  for (const description::LinkShape& shape : link.shapes) {
    if (const auto* capsule = std::get_if<description::CapsuleShape>(&shape)) {
      lines.push_back(*capsule);
      continue;
    }
    const auto& box = std::get<description::BoxShape>(shape);
    for (int axis = 0; axis < 3; ++axis)
      for (const auto& [one, other] : {std::pair{-1, -1}, {-1, 1}, {1, -1}, {1, 1}, {0, 0}}) {
        Vector3d from;
        from[axis] = -1;
        from[(axis + 1) % 3] = one;
        from[(axis + 2) % 3] = other;
        Vector3d to = from;
        to[axis] = 1;
        lines.push_back({box.pose * (0.5 * from.cwiseProduct(box.size)), box.pose * (0.5 * to.cwiseProduct(box.size)), 0});
      }
  }
  return lines;
}

}  // namespace

bool FeelingSide::has(const Vector3d& normal_L) const {
  return !facing || normal_L.dot(*facing) >= std::cos(arc) - kRounding;
}

PostureSearch::PostureSearch(const description::Robot& robot, const dynamics::Model& model, PostureSearchOptions options)
    : robot_(robot), model_(model), workspace_(model), options_(std::move(options)) {
  for (const int joint : options_.joints) stages_.push_back({joint, {}});
  for (std::size_t i = 1; i < stages_.size(); ++i)
    for (int link = 0; link < static_cast<int>(robot.links.size()); ++link)
      if (model.supports(stages_[i].joint, link) && !model.supports(stages_[i - 1].joint, link))
        throw std::invalid_argument("the joints are no chain in this order");
  for (int link = 0; link < static_cast<int>(robot.links.size()); ++link) {
    const auto stage = std::find_if(stages_.rbegin(), stages_.rend(),
                                    [&](const Stage& other) { return model.supports(other.joint, link); });
    const std::string& name = robot.links[static_cast<std::size_t>(link)].name;
    const bool wanted = std::find(options_.links.begin(), options_.links.end(), link) != options_.links.end();
    const bool solid = !robot.links[static_cast<std::size_t>(link)].shapes.empty();
    if (wanted && !solid) throw std::invalid_argument("link '" + name + "' has no shape that could touch");
    if (wanted && stage == stages_.rend()) throw std::invalid_argument("no joint moves link '" + name + "'");
    if (stage != stages_.rend() && solid) stage->moved.push_back(link);
  }
}

PostureFound PostureSearch::operator()(const geometry::Shape& world, const Eigen::VectorXd& q) {
  world_ = &world;
  const int links = static_cast<int>(options_.links.size());
  for (int count = links; count >= 0; --count)
    for (unsigned wanted = 0; wanted < 1u << links; ++wanted) {
      if (std::popcount(wanted) != count) continue;
      q_ = q;
      if (visit(0, wanted)) return {count, q_};
    }
  return {};
}

bool PostureSearch::visit(std::size_t index, unsigned wanted) {
  if (index == stages_.size()) return true;
  const Stage& stage = stages_[index];
  const double lower = model_.lower()[stage.joint], upper = model_.upper()[stage.joint];
  const int steps = std::max(1, static_cast<int>(std::ceil((upper - lower) / options_.step)));
  const auto positionOf = [&](int i) { return lower + (upper - lower) * i / steps; };
  const auto touching = std::find_if(stage.moved.begin(), stage.moved.end(), [&](int link) { return isWanted(link, wanted); });
  if (touching != stage.moved.end()) {
    for (const double depth : {0.0, 0.5 * options_.give, options_.give})
      for (int i = 0; i < steps; ++i)
        if (touchesBetween(index, *touching, wanted, positionOf(i), positionOf(i + 1), depth)) return true;
    return false;
  }
  for (int i = 0; i <= steps; ++i) {
    q_[stage.joint] = positionOf(i);
    if (isAllowed(stage, wanted) && visit(index + 1, wanted)) return true;
  }
  return false;
}

bool PostureSearch::touchesBetween(std::size_t index, int link, unsigned wanted, double low, double high, double depth) {
  const Stage& stage = stages_[index];
  const auto isFree = [&](double position) {
    q_[stage.joint] = position;
    dynamics::forwardKinematics(model_, q_, workspace_);
    return touchOf(link).gap > -depth;
  };
  const bool free_low = isFree(low);
  if (isFree(high) == free_low) return false;
  while (high - low > kPositionError) {
    const double middle = 0.5 * (low + high);
    (isFree(middle) == free_low ? low : high) = middle;
  }
  q_[stage.joint] = 0.5 * (low + high);
  return isAllowed(stage, wanted) && visit(index + 1, wanted);
}

bool PostureSearch::isAllowed(const Stage& stage, unsigned wanted) {
  dynamics::forwardKinematics(model_, q_, workspace_);
  return std::all_of(stage.moved.begin(), stage.moved.end(), [&](int link) {
    const Touch touch = touchOf(link);
    if (touch.gap < -options_.give - kGapError) return false;
    return !isWanted(link, wanted) || (touch.gap <= kGapError && options_.side.has(touch.normal_L));
  });
}

bool PostureSearch::isWanted(int link, unsigned wanted) const {
  const auto at = std::find(options_.links.begin(), options_.links.end(), link);
  return at != options_.links.end() && (wanted & (1u << (at - options_.links.begin())));
}

PostureSearch::Touch PostureSearch::touchOf(int link) {
  const Eigen::Isometry3d X_WL = dynamics::framePose(model_, workspace_, link);
  Touch nearest{INFINITY, Vector3d::UnitZ()};
  for (const description::CapsuleShape& line : linesOf(robot_.links[static_cast<std::size_t>(link)])) {
    const Vector3d from = X_WL * line.from, along = X_WL.linear() * (line.to - line.from);
    const double length = along.norm();
    const auto gapAlong = [&](double t) { return world_->distance(from + t * along).distance - line.radius; };
    double at = 0.5, least = gapAlong(at);
    const double no_less = least - 0.5 * length;                   // a distance changes no faster than the place
    if (no_less >= nearest.gap) continue;
    if (no_less > 0) {                                             // far away: how far does not matter
      nearest = {no_less, Vector3d::UnitZ()};
      continue;
    }
    const int steps = std::max(1, static_cast<int>(std::ceil(length / kSpacing)));
    for (int i = 0; i <= steps && length > 0; ++i) {
      const double t = static_cast<double>(i) / steps, gap = gapAlong(t);
      if (gap >= least) continue;
      least = gap;
      at = t;
    }
    if (length > 0) at = placeOfLeast(gapAlong, std::max(0.0, at - 1.0 / steps), std::min(1.0, at + 1.0 / steps));
    const geometry::SignedDistance distance = world_->distance(from + at * along);
    if (distance.distance - line.radius >= nearest.gap) continue;
    nearest = {distance.distance - line.radius, -(X_WL.linear().transpose() * distance.gradient)};
  }
  return nearest;
}

}  // namespace tactus::plugins
