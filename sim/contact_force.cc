#include "sim/contact_force.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim {
namespace {

/// 1 for x ≤ 0, 0 for x ≥ 1, with zero slope at both.
double smoothFall(double x) {
  const double s = std::clamp(x, 0.0, 1.0);
  return 1 - s * s * (3 - 2 * s);
}

/// The t in (0, 1) that makes 4t(1−t) δ(t)² greatest, δ(t) = r − d(a + t (b − a)) concave, and the distance there.
/// A stationary point solves F(t) = (1−2t) δ + 2t(1−t) δ' = 0, where F falls through zero; false position
/// (Illinois) between points that touch, bisection towards the touching part otherwise.  False: nothing touches.
bool findInteriorPoint(const geometry::Shape& shape, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
                       double depth_a, double depth_b, double& t, geometry::SignedDistance& nearest) {
  constexpr int max_iterations = 60;
  constexpr double t_tolerance = 1e-9;
  const Eigen::Vector3d axis = b - a;
  double low = 0, high = 1;
  double F_low = std::max(depth_a, 0.0), F_high = std::min(-depth_b, 0.0);  // zero: not known, bisect
  int last_side = 0;
  for (int i = 0; i < max_iterations; ++i) {
    t = F_low > 0 && F_high < 0 ? (low * F_high - high * F_low) / (F_high - F_low) : 0.5 * (low + high);
    nearest = shape.distance(a + t * axis);
    const double depth = radius - nearest.distance;
    const double slope = -nearest.steepness * nearest.gradient.dot(axis);
    if (depth <= 0) {
      const double end = slope > 0 ? high : low;
      if (depth + slope * (end - t) <= 0) return false;            // concave: the tangent bounds δ from above
      (slope > 0 ? low : high) = t;
      (slope > 0 ? F_low : F_high) = 0;
      last_side = 0;
    } else {
      const double F = (1 - 2 * t) * depth + 2 * t * (1 - t) * slope;
      if (F > 0) {
        low = t;
        F_low = F;
        if (last_side > 0) F_high *= 0.5;
        last_side = 1;
      } else if (F < 0) {
        high = t;
        F_high = F;
        if (last_side < 0) F_low *= 0.5;
        last_side = -1;
      } else {
        return true;
      }
      if (std::abs(F) < t_tolerance * depth) return true;
    }
    if (high - low < t_tolerance) return depth > 0;
  }
  return radius - nearest.distance > 0;
}

constexpr int most_maxima = 3;

/// Maxima of f(t) = 4t(1−t) δ(t)², δ > 0, and the minima between them, from a to b.
struct Extrema {
  struct Place {
    double t;
    bool is_pass;                                                  // a minimum, of the maxima before and after it
  };
  int count = 0;
  Place places[2 * most_maxima - 1];
};

void findExtrema(const geometry::Shape& shape, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
                 Extrema& extrema) {
  constexpr int samples = 65;
  constexpr double spacing = 1.0 / (samples - 1);
  const Eigen::Vector3d axis = b - a;
  const double stride = spacing * axis.norm();
  double f[samples] = {};
  for (int i = 0; i < samples; ++i) {
    const double t = i * spacing;
    const double depth = radius - shape.distance(a + t * axis).distance;
    if (depth > 0) f[i] = 4 * t * (1 - t) * depth * depth;
    else i += static_cast<int>(std::min(-depth / stride, 1.0 * samples));  // nothing touches before
  }
  int peaks[samples / 2];
  int count = 0;
  for (int i = 1; i + 1 < samples; ++i)
    if (f[i] > 0 && f[i] > f[i - 1] && f[i] >= f[i + 1]) peaks[count++] = i;
  while (count > most_maxima) {                                    // keep the greatest
    int* least = std::min_element(peaks, peaks + count, [&](int i, int j) { return f[i] < f[j]; });
    std::copy(least + 1, peaks + count, least);
    --count;
  }
  /// Where the derivative of f over 4 δ goes through zero next to sample i, falling or rising.
  const auto refine = [&](int i, bool rising) {
    double low = (i - 1) * spacing, high = (i + 1) * spacing;
    for (int k = 0; k < 40 && high - low > 1e-9; ++k) {
      const double t = 0.5 * (low + high);
      const geometry::SignedDistance nearest = shape.distance(a + t * axis);
      const double depth = radius - nearest.distance, slope = -nearest.steepness * nearest.gradient.dot(axis);
      const double F = depth > 0 ? (1 - 2 * t) * depth + 2 * t * (1 - t) * slope : slope;
      ((F > 0) != rising ? low : high) = t;
    }
    return 0.5 * (low + high);
  };
  extrema.count = 0;
  for (int k = 0; k < count; ++k) {
    if (k > 0) {
      const int lowest = static_cast<int>(std::min_element(f + peaks[k - 1], f + peaks[k]) - f);
      if (f[lowest] > 0) extrema.places[extrema.count++] = {refine(lowest, true), true};
    }
    extrema.places[extrema.count++] = {refine(peaks[k], false), false};
  }
}

std::vector<Collider> collidersOf(const description::Scene& scene) {
  std::vector<Collider> colliders;
  for (int i = 0; i < static_cast<int>(scene.objects.size()); ++i)
    for (Collider& collider : objectColliders(scene.objects[i], i)) {
      collider.pose = scene.objects[i].pose * collider.pose;
      colliders.push_back(std::move(collider));
    }
  return colliders;
}

std::vector<SurfacePair> everyPair(const std::vector<Feature>& features, const std::vector<Collider>& colliders,
                                   const description::Scene& scene) {
  std::vector<SurfacePair> pairs;
  for (int f = 0; f < static_cast<int>(features.size()); ++f)
    for (int c = 0; c < static_cast<int>(colliders.size()); ++c)
      pairs.push_back({f, c, description::materialOf(scene, partyOf(features[f].owner), partyOf(colliders[c].owner),
                                                     scene.objects[colliders[c].owner.object].material)});
  return pairs;
}

}  // namespace

ContactForce::ContactForce(const std::vector<Feature>& features, const description::Scene& scene, int bodies,
                           const ContactOptions& options)
    : ContactForce(features, collidersOf(scene), everyPair(features, collidersOf(scene), scene), bodies, options) {}

ContactForce::ContactForce(std::vector<Feature> features, std::vector<Collider> colliders, std::vector<SurfacePair> pairs,
                           int bodies, const ContactOptions& options)
    : options_(options),
      features_(std::move(features)),
      colliders_(std::move(colliders)),
      pairs_(std::move(pairs)),
      burying_(colliders_.size()),
      posed_(colliders_.size()),
      wrenches_(bodies) {
  for (size_t i = 0; i < colliders_.size(); ++i) {
    const Collider& one = colliders_[i];
    posed_[i] = {one.pose.linear(), one.pose.translation()};
    for (size_t j = 0; j < colliders_.size(); ++j) {
      const Collider& other = colliders_[j];
      const double reach = one.shape->boundingRadius() + other.shape->boundingRadius();
      const bool near = (other.pose.translation() - one.pose.translation()).norm() <= reach;
      if (i != j && one.body == other.body && near) burying_[i].push_back(static_cast<int>(j));
    }
  }
  size_t most_pieces = 1;
  for (const Collider& collider : colliders_) {
    wholes_.push_back({{collider.shape}});
    pieces_.push_back(collider.shape->pieces());
    if (pieces_.back().empty()) pieces_.back() = wholes_.back();
    most_pieces = std::max(most_pieces, pieces_.back().size());
  }
  first_bristle_.push_back(0);
  for (const SurfacePair& pair : pairs_)
    first_bristle_.push_back(first_bristle_.back() + slots * static_cast<int>(piecesFor(pair).size()));
  bristles_.resize(static_cast<size_t>(first_bristle_.back()));
  next_bristles_.resize(bristles_.size());
  points_.reserve(most_pieces * (2 + 2 * most_interior - 1));
  bent_.reserve(pairs_.size());
  touches_.reserve(pairs_.size());
}

/// An edge or a corner (r = 0) reaches no farther than its nearest point.
const ContactForce::Pieces& ContactForce::piecesFor(const SurfacePair& pair) const {
  return features_[pair.feature].feeler.radius > 0 ? pieces_[pair.collider] : wholes_[pair.collider];
}

const BodyMotion& ContactForce::motionOf(int body, const std::vector<BodyMotion>& bodies) const {
  static const BodyMotion at_rest;
  return body == world_body ? at_rest : bodies[static_cast<size_t>(body)];
}

void ContactForce::pose(const std::vector<BodyMotion>& bodies) {
  for (size_t i = 0; i < colliders_.size(); ++i) {
    const Collider& collider = colliders_[i];
    if (collider.body == world_body) continue;
    const BodyMotion& body = bodies[static_cast<size_t>(collider.body)];
    posed_[i] = {body.R_WB * collider.pose.linear(), body.p_WB + body.R_WB * collider.pose.translation()};
  }
}

void ContactForce::evaluate(const std::vector<BodyMotion>& bodies, double h) {
  touches_.clear();
  elastic_energy_ = 0;
  std::fill(wrenches_.begin(), wrenches_.end(), BodyWrench());
  pose(bodies);
  for (int i = 0; i < static_cast<int>(pairs_.size()); ++i) {
    const Feature& feature = features_[pairs_[i].feature];
    const Collider& collider = colliders_[pairs_[i].collider];
    const BodyMotion& body = motionOf(feature.body, bodies);
    const geometry::Feeler& feeler = feature.feeler;
    const Eigen::Vector3d middle_W = body.p_WB + body.R_WB * (0.5 * (feeler.from + feeler.to));
    const double reach = feeler.radius + 0.5 * (feeler.to - feeler.from).norm() + collider.shape->boundingRadius();
    if ((middle_W - posed_[pairs_[i].collider].p_WP).squaredNorm() > reach * reach) continue;
    touchPair(i, body, motionOf(collider.body, bodies), h);
  }
}

void ContactForce::touchPair(int pair, const BodyMotion& of_feature, const BodyMotion& of_collider, double h) {
  const geometry::Feeler& feeler = features_[pairs_[pair].feature].feeler;
  const Posed& posed = posed_[pairs_[pair].collider];
  const Eigen::Vector3d a =
      posed.R_WP.transpose() * (of_feature.p_WB + of_feature.R_WB * feeler.from - posed.p_WP);
  const Eigen::Vector3d b = a + posed.R_WP.transpose() * (of_feature.R_WB * (feeler.to - feeler.from));
  const double reach = feeler.radius + 0.5 * (b - a).norm();
  const Eigen::Vector3d middle = 0.5 * (a + b);
  if (colliders_[pairs_[pair].collider].shape->distance(middle).distance > reach) return;

  points_.clear();
  const Pieces& pieces = piecesFor(pairs_[pair]);
  for (int i = 0; i < static_cast<int>(pieces.size()); ++i)
    if (pieces.size() == 1 || pieces[i].shape->distance(middle).distance <= reach)
      findPoints(pair, i, {a, b, feeler.radius, feeler.ends});
  if (points_.empty()) return;
  if (pieces.size() > 1) findNeighbours(pair);
  for (Point& point : points_) measure(point, pair, of_feature, of_collider);
  relieve();

  std::fill(next_bristles_.begin() + first_bristle_[pair], next_bristles_.begin() + first_bristle_[pair + 1], Bristle());
  touches_.push_back(Touch{.pair = pair});
  for (const Point& point : points_) press(point, pair, of_feature, of_collider, h, touches_.back());
  if (touches_.back().depth == 0) touches_.pop_back();             // wholly buried
}

void ContactForce::findPoints(int pair, int number, const Axis& axis) {
  const geometry::Piece& piece = piecesFor(pairs_[pair])[number];
  const bool is_ball = axis.a == axis.b;
  const bool bears_friction = piece.between[0] < 0;
  double depth[2];
  for (int i = 0; i < (is_ball ? 1 : 2); ++i) {
    const Eigen::Vector3d& p = i == 0 ? axis.a : axis.b;
    const geometry::SignedDistance nearest = piece.shape->distance(p);
    depth[i] = axis.radius - nearest.distance;
    if (!axis.ends || !(depth[i] > 0)) continue;
    points_.push_back({.piece = number, .slot = bears_friction ? i : -1, .sign = 1.0 * piece.sign, .weight = 1,
                       .t = 1.0 * i, .depth = depth[i], .p_P = p, .nearest = nearest});
  }
  if (is_ball) return;
  const int first = static_cast<int>(points_.size());
  findInterior(piece, number, axis, depth[0], depth[1]);
  if (bears_friction) assignSlots(pair, number, first);
}

void ContactForce::findInterior(const geometry::Piece& piece, int number, const Axis& axis, double depth_a,
                                double depth_b) {
  const geometry::Shape& shape = *piece.shape;
  const auto add = [&](double t, const geometry::SignedDistance& nearest, double sign) {
    points_.push_back({.piece = number, .slot = -1, .sign = sign, .weight = 4 * t * (1 - t), .t = t,
                       .depth = axis.radius - nearest.distance, .p_P = axis.a + t * (axis.b - axis.a),
                       .nearest = nearest});
  };
  if (shape.isConvex()) {
    double t = 0;
    geometry::SignedDistance nearest;
    if (findInteriorPoint(shape, axis.a, axis.b, axis.radius, depth_a, depth_b, t, nearest)) add(t, nearest, piece.sign);
    return;
  }
  Extrema extrema;
  findExtrema(shape, axis.a, axis.b, axis.radius, extrema);
  for (int i = 0; i < extrema.count; ++i) {
    const auto& [t, is_pass] = extrema.places[i];
    const geometry::SignedDistance nearest = shape.distance(axis.a + t * (axis.b - axis.a));
    if (!(axis.radius > nearest.distance)) continue;
    add(t, nearest, is_pass ? -piece.sign : piece.sign);
    if (!is_pass) continue;
    const int here = static_cast<int>(points_.size()) - 1;
    points_.back().between[0] = here - 1;
    points_.back().between[1] = here + 1;
  }
}

/// Each maximum keeps the bristle of the last one nearest to it along the axis.
void ContactForce::assignSlots(int pair, int piece, int first_point) {
  const Bristle* committed = &bristles_[first_bristle_[pair] + slots * piece];
  bool taken[slots] = {};
  for (size_t i = first_point; i < points_.size(); ++i) {
    if (points_[i].between[0] >= 0) continue;
    int best = -1;
    double nearest = 0.1;                                          // of the axis: farther away it is another point
    for (int s = 2; s < slots; ++s) {
      const double apart = std::abs(points_[i].t - committed[s].t);  // NaN: nothing stands there
      if (taken[s] || !(apart < nearest)) continue;
      nearest = apart;
      best = s;
    }
    for (int s = 2; s < slots && best < 0; ++s)
      if (!taken[s] && std::isnan(committed[s].t)) best = s;
    for (int s = 2; s < slots && best < 0; ++s)
      if (!taken[s]) best = s;
    taken[best] = true;
    points_[i].slot = best;
  }
}

/// Of passes between pieces: on either piece the same end, or the interior point nearest along the axis.
void ContactForce::findNeighbours(int pair) {
  const Pieces& pieces = piecesFor(pairs_[pair]);
  for (Point& pass : points_) {
    const geometry::Piece& piece = pieces[pass.piece];
    if (piece.between[0] < 0 || pass.between[0] >= 0) continue;
    const bool is_end = pass.t == 0 || pass.t == 1;
    for (int side = 0; side < 2; ++side) {
      double nearest = 2;
      for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
        const Point& point = points_[i];
        if (point.piece != piece.between[side] || point.slot < 0 || (point.slot < 2) != is_end) continue;
        const double apart = std::abs(point.t - pass.t);
        if ((is_end && apart > 0) || apart >= nearest) continue;
        nearest = apart;
        pass.between[side] = i;
      }
    }
  }
}

void ContactForce::measure(Point& point, int pair, const BodyMotion& of_feature, const BodyMotion& of_collider) const {
  const Posed& posed = posed_[pairs_[pair].collider];
  const description::ContactMaterial& material = pairs_[pair].material;
  point.surface_W = posed.p_WP + posed.R_WP * (point.p_P - point.nearest.distance * point.nearest.gradient);
  point.normal_W = -(posed.R_WP * point.nearest.gradient);
  point.velocity_W = of_feature.linear_W + of_feature.angular_W.cross(point.surface_W - of_feature.p_WB) -
                     of_collider.linear_W - of_collider.angular_W.cross(point.surface_W - of_collider.p_WB);
  const double share = features_[pairs_[pair].feature].feeler.share * exposure(pairs_[pair].collider, point.surface_W);
  point.stiffness = point.weight * share * material.stiffness;
  const double depth_rate = point.velocity_W.dot(point.normal_W);
  point.normal_N = std::clamp(point.stiffness * point.depth * point.nearest.steepness *
                                  (1 + material.dissipation * depth_rate), 0.0, options_.force_limit);
}

void ContactForce::relieve() {
  for (const Point& pass : points_) {
    if (pass.sign > 0 || pass.normal_N == 0) continue;
    double above[2] = {0, 0};
    for (int side = 0; side < 2; ++side)
      if (pass.between[side] >= 0) above[side] = std::max(0.0, points_[pass.between[side]].height() - pass.height());
    const double sum = above[0] + above[1];
    for (int side = 0; side < 2; ++side)
      if (pass.between[side] >= 0)
        points_[pass.between[side]].relief_N += pass.normal_N * (sum > 0 ? above[1 - side] / sum : 0.5);
  }
}

/// What a bristle of this stiffness answers, at most `limit`; its bend is cut to what the limit allows.
Eigen::Vector3d ContactForce::bent(double stiffness, const Eigen::Vector3d& rate, double limit,
                                   Eigen::Vector3d& bend) const {
  const double elastic = stiffness * bend.norm();
  if (elastic > limit) bend *= limit / elastic;
  const Eigen::Vector3d answer = stiffness * (bend + options_.bristle_relaxation * rate);
  const double asked = answer.norm();
  return asked > limit ? Eigen::Vector3d(limit / asked * answer) : answer;
}

void ContactForce::press(const Point& point, int pair, const BodyMotion& of_feature, const BodyMotion& of_collider,
                         double h, Touch& touch) {
  if (point.stiffness <= 0) return;                                // buried
  const Feature& feature = features_[pairs_[pair].feature];
  const int c = pairs_[pair].collider;
  const description::ContactMaterial& material = pairs_[pair].material;
  Eigen::Vector3d force_W = point.sign * point.normal_N * point.normal_W;
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();              // of the feature's body on the collider's
  elastic_energy_ += 0.5 * point.sign * point.stiffness * point.depth * point.depth;

  if (point.slot >= 0) {
    const int at = first_bristle_[pair] + slots * point.piece + point.slot;
    const bool stays = point.slot < 2 || std::abs(point.t - bristles_[at].t) < 0.1;
    Bristle bristle = stays ? bristles_[at] : Bristle();
    if (point.slot >= 2) bristle.t = point.t;
    const double pressing_N = std::max(0.0, point.normal_N - point.relief_N);
    const double part = point.normal_N > 0 ? pressing_N / point.normal_N : 1;
    const double stiffness = part * options_.bristle_stiffness_ratio * point.stiffness;
    // What is new of the contact is not bent yet: it takes no part of the force.
    const double kept = stiffness > bristle.stiffness ? bristle.stiffness / stiffness : 1;
    bristle.stiffness = stiffness;

    const Eigen::Vector3d slip_W = point.velocity_W - point.velocity_W.dot(point.normal_W) * point.normal_W;
    const double friction_N = material.friction * pressing_N;
    Eigen::Vector3d& bend_W = bristle.bend_W;
    bend_W *= kept;
    bend_W += h * (slip_W + of_collider.angular_W.cross(bend_W));
    bend_W -= bend_W.dot(point.normal_W) * point.normal_W;         // the normal turns as the point moves
    const Eigen::Vector3d friction_W = bent(stiffness, slip_W, friction_N, bend_W);
    force_W += friction_W;
    touch.friction_force_W += friction_W;
    elastic_energy_ += 0.5 * stiffness * bend_W.squaredNorm();

    const double radius = feature.feeler.radius;
    if (material.rolling > 0 && radius > 0) {
      const Eigen::Vector3d turning_W = of_feature.angular_W - of_collider.angular_W;
      Eigen::Vector3d& twist_W = bristle.twist_W;
      twist_W *= kept;
      twist_W += h * (turning_W + of_collider.angular_W.cross(twist_W));
      torque_W = bent(stiffness * radius * radius, turning_W, material.rolling * pressing_N, twist_W);
      elastic_energy_ += 0.5 * stiffness * radius * radius * twist_W.squaredNorm();
    }
    next_bristles_[at] = bristle;
  }

  if (feature.body != world_body) {
    BodyWrench& wrench = wrenches_[feature.body];
    wrench.force_W -= force_W;
    wrench.torque_W -= (point.surface_W - of_feature.p_WB).cross(force_W) + torque_W;
  }
  if (colliders_[c].body != world_body) {
    BodyWrench& wrench = wrenches_[colliders_[c].body];
    wrench.force_W += force_W;
    wrench.torque_W += (point.surface_W - of_collider.p_WB).cross(force_W) + torque_W;
  }
  touch.weight_N += point.sign * point.normal_N;
  touch.weighted_point_W += point.sign * point.normal_N * point.surface_W;
  touch.normal_force_W += point.sign * point.normal_N * point.normal_W;
  if (point.sign > 0 && point.depth > touch.depth) {
    touch.depth = point.depth;
    touch.deepest_point_W = point.surface_W;
    touch.deepest_normal_W = point.normal_W;
  }
}

double ContactForce::exposure(int collider, const Eigen::Vector3d& surface_point_W) const {
  double exposure = 1;
  for (int j : burying_[collider]) {
    const geometry::Shape& other = *colliders_[j].shape;
    const Eigen::Vector3d offset_W = surface_point_W - posed_[j].p_WP;
    if (offset_W.squaredNorm() > other.boundingRadius() * other.boundingRadius()) continue;
    const double burial = -other.distance(posed_[j].R_WP.transpose() * offset_W).distance;
    exposure *= smoothFall(burial / options_.burial_fade);
  }
  return exposure;
}

void ContactForce::clear() {
  for (int pair : bent_)
    std::fill(bristles_.begin() + first_bristle_[pair], bristles_.begin() + first_bristle_[pair + 1], Bristle());
  bent_.clear();
}

void ContactForce::commit() {
  clear();
  for (const Touch& touch : touches_) {
    const int first = first_bristle_[touch.pair], end = first_bristle_[touch.pair + 1];
    std::copy(next_bristles_.begin() + first, next_bristles_.begin() + end, bristles_.begin() + first);
    bent_.push_back(touch.pair);
  }
}

void ContactForce::archive(control::Archive& archive) {
  std::size_t pairs = pairs_.size(), bristles = bristles_.size();
  archive("pairs", pairs);
  archive("bristles", bristles);
  if (pairs != pairs_.size() || bristles != bristles_.size())
    throw control::StateError("the state is of " + std::to_string(pairs) + " pairs of surfaces with " +
                              std::to_string(bristles) + " bristles, and this robot and scene have " +
                              std::to_string(pairs_.size()) + " with " + std::to_string(bristles_.size()));
  std::vector<int> bent = bent_;
  archive.growing("bent", bent);
  for (const int pair : bent)
    if (pair < 0 || pair >= static_cast<int>(pairs_.size()))
      throw control::StateError("the state has bristles of a pair of surfaces that there is not");
  if (archive.restores()) {
    clear();
    bent_ = bent;
  }
  for (const int pair : bent_)
    archive.within("pair/" + std::to_string(pair), [&] {
      for (int i = first_bristle_[pair]; i < first_bristle_[pair + 1]; ++i)
        archive(std::to_string(i - first_bristle_[pair]), bristles_[i]);
    });
}

void ContactForce::read(std::vector<control::ContactRecord>& records) const {
  records.clear();
  for (const Touch& touch : touches_) {
    const SurfacePair& pair = pairs_[touch.pair];
    const Owner &by = features_[pair.feature].owner, &on = colliders_[pair.collider].owner;
    if (by.link < 0 && on.link < 0) continue;                      // objects among themselves
    control::ContactRecord record;
    record.depth = touch.depth;
    record.point_W = touch.deepest_point_W;
    record.normal_W = touch.deepest_normal_W;
    const double normal_norm_N = touch.normal_force_W.norm();
    if (touch.weight_N > 0 && normal_norm_N > 0) {
      // The mean of several points of a curved surface lies under it: bring it back up.
      const Posed& posed = posed_[pair.collider];
      const Eigen::Vector3d mean_P = posed.R_WP.transpose() * (touch.weighted_point_W / touch.weight_N - posed.p_WP);
      const geometry::SignedDistance nearest = colliders_[pair.collider].shape->distance(mean_P);
      record.point_W = posed.p_WP + posed.R_WP * (mean_P - nearest.distance * nearest.gradient);
      record.normal_W = touch.normal_force_W / normal_norm_N;
    }
    const Eigen::Vector3d force_W = touch.normal_force_W + touch.friction_force_W;
    record.force_N = force_W.dot(record.normal_W);
    record.friction_W = force_W - record.force_N * record.normal_W;
    record.link = by.link;
    record.object = on.object;
    record.other_link = on.link;
    if (by.link < 0) {                                             // an object's feature on a link: seen from the link
      record.link = on.link;
      record.object = by.object;
      record.other_link = -1;
      record.normal_W = -record.normal_W;
      record.friction_W = -record.friction_W;
    }
    records.push_back(record);
  }
}

}  // namespace tactus::sim
