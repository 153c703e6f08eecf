#include "plugins/exploration/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "framework/control/random.h"
#include "framework/dynamics/inverse_kinematics.h"
#include "framework/dynamics/kinematics.h"

namespace tactus::exploration {
namespace {

using Eigen::Vector3d;

constexpr double inside = 1e-6;                                    // m: what is deeper is no surface
constexpr int tries_per_sample = 200;

/// Signed distance from a point of the world; the shape `but` of object `object` is left out.
double distanceToScene(const description::Scene& scene, const Vector3d& p_W, int object = -1, int but = -1) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(scene.objects.size()); ++i) {
    const description::Object& other = scene.objects[static_cast<std::size_t>(i)];
    for (int k = 0; k < static_cast<int>(other.primitives.size()); ++k) {
      if (i == object && k == but) continue;
      const description::Primitive& primitive = other.primitives[static_cast<std::size_t>(k)];
      const Vector3d p = (other.pose * primitive.pose).inverse() * p_W;
      least = std::min(least, primitive.shape->distance(p).distance);
    }
  }
  return least;
}

/// A rotation whose first column is `axis`.
Eigen::Matrix3d frameAlong(const Vector3d& axis) {
  const Vector3d other = (std::abs(axis.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY()).cross(axis).normalized();
  Eigen::Matrix3d R;
  R << axis, other, axis.cross(other);
  return R;
}

/// The point of a link's shapes that is farthest along `axis`, above the middle of the shapes.
Vector3d padOf(const description::Link& link, const Vector3d& axis) {
  Vector3d middle = Vector3d::Zero();
  double farthest = 0;
  for (const description::LinkShape& shape : link.shapes) {
    if (const auto* capsule = std::get_if<description::CapsuleShape>(&shape)) {
      middle += 0.5 * (capsule->from + capsule->to) / static_cast<double>(link.shapes.size());
    } else {
      middle += std::get<description::BoxShape>(shape).pose.translation() / static_cast<double>(link.shapes.size());
    }
  }
  for (const description::LinkShape& shape : link.shapes) {
    if (const auto* capsule = std::get_if<description::CapsuleShape>(&shape)) {
      const Vector3d centre = 0.5 * (capsule->from + capsule->to);
      farthest = std::max(farthest, axis.dot(centre - middle) + capsule->radius);
    } else {
      const auto& box = std::get<description::BoxShape>(shape);
      const Vector3d half = 0.5 * box.size.cwiseProduct((box.pose.linear().transpose() * axis).cwiseAbs());
      farthest = std::max(farthest, axis.dot(box.pose.translation() - middle) + half.sum());
    }
  }
  return middle + farthest * axis;
}

}  // namespace

std::vector<SurfaceSample> sampleSurface(const description::Scene& scene, int object, int count) {
  const description::Object& described = scene.objects.at(static_cast<std::size_t>(object));
  struct Triangle {
    Vector3d a, b, c;                                              // in the shape's frame
    int primitive;
  };
  std::vector<Triangle> triangles;
  std::vector<double> area_until;
  double area = 0;
  for (int k = 0; k < static_cast<int>(described.primitives.size()); ++k) {
    const geometry::TriangleMesh mesh = described.primitives[static_cast<std::size_t>(k)].shape->surface();
    if (!std::isfinite(described.primitives[static_cast<std::size_t>(k)].shape->boundingRadius())) continue;
    for (const auto& corners : mesh.triangles) {
      const auto vertex = [&](int i) { return mesh.vertices[static_cast<std::size_t>(corners[static_cast<std::size_t>(i)])]; };
      const Triangle triangle{vertex(0), vertex(1), vertex(2), k};
      area += 0.5 * (triangle.b - triangle.a).cross(triangle.c - triangle.a).norm();
      triangles.push_back(triangle);
      area_until.push_back(area);
    }
  }
  std::vector<SurfaceSample> samples;
  if (triangles.empty()) return samples;
  control::SplitMix64 random(1);
  for (int tries = 0; tries < tries_per_sample * count && static_cast<int>(samples.size()) < count; ++tries) {
    const auto at = std::upper_bound(area_until.begin(), area_until.end(), area * random.uniform()) - area_until.begin();
    const Triangle& triangle = triangles[std::min(static_cast<std::size_t>(at), triangles.size() - 1)];
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    Vector3d p = triangle.a + u * (triangle.b - triangle.a) + v * (triangle.c - triangle.a);
    const description::Primitive& primitive = described.primitives[static_cast<std::size_t>(triangle.primitive)];
    const geometry::SignedDistance distance = primitive.shape->distance(p);
    p -= distance.distance * distance.gradient;                    // triangles of round things cut corners
    const Eigen::Isometry3d X_WS = described.pose * primitive.pose;
    const SurfaceSample sample{X_WS * p, X_WS.linear() * primitive.shape->distance(p).gradient};
    if (distanceToScene(scene, sample.point_W, object, triangle.primitive) > -inside) samples.push_back(sample);
  }
  return samples;
}

Reach::Reach(const description::Robot& robot, const description::Scene& scene, const dynamics::Model& model,
             const Eigen::VectorXd& start_q, ReachOptions options)
    : robot_(robot), scene_(scene), model_(model), start_q_(start_q), found_q_(start_q), options_(std::move(options)) {
  for (int link : options_.links) pads_.push_back(padOf(robot.links[static_cast<std::size_t>(link)], options_.pad_axis));
}

bool Reach::operator()(const SurfaceSample& sample) {
  for (int turn = 0; turn < options_.turns; ++turn)
    for (int i = 0; i < static_cast<int>(options_.links.size()); ++i) {
      const double angle = 2 * std::numbers::pi * turn / options_.turns;
      if (tryFrom(found_q_, sample, i, angle) || tryFrom(start_q_, sample, i, angle)) return true;
    }
  return false;
}

bool Reach::tryFrom(const Eigen::VectorXd& start, const SurfaceSample& sample, int link, double turn) {
  const Eigen::Matrix3d R_WP = Eigen::AngleAxisd(turn, sample.normal_W) * frameAlong(-sample.normal_W);
  const Eigen::Matrix3d R_WL = R_WP * frameAlong(options_.pad_axis).transpose();
  dynamics::FrameTarget target;
  target.frame = options_.links[static_cast<std::size_t>(link)];
  target.orientation_W = R_WL;
  target.position_W = sample.point_W - R_WL * pads_[static_cast<std::size_t>(link)];
  dynamics::InverseKinematicsOptions how;
  how.max_iterations = 40;
  how.tolerance = options_.tolerance;
  how.angle_weight = options_.angle_weight;
  const auto result = dynamics::inverseKinematics(model_, {target}, start, how);
  if (!result.reached || !isClear(result.q)) return false;
  found_q_ = result.q;
  return true;
}

bool Reach::isClear(const Eigen::VectorXd& q) const {
  dynamics::Workspace workspace(model_);
  dynamics::forwardKinematics(model_, q, workspace);
  for (int link : options_.clear) {
    const Eigen::Isometry3d X_WL = dynamics::framePose(model_, workspace, link);
    for (const description::LinkShape& shape : robot_.links[static_cast<std::size_t>(link)].shapes) {
      constexpr int steps = 8;
      if (const auto* capsule = std::get_if<description::CapsuleShape>(&shape)) {
        for (int k = 0; k <= steps; ++k) {
          const Vector3d p = capsule->from + (capsule->to - capsule->from) * k / steps;
          if (distanceToScene(scene_, X_WL * p) < capsule->radius) return false;
        }
      } else {
        const auto& box = std::get<description::BoxShape>(shape);
        for (int k = 0; k < 27; ++k) {
          const Vector3d corner(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
          if (distanceToScene(scene_, X_WL * (box.pose * (0.5 * corner.cwiseProduct(box.size)))) < 0) return false;
        }
      }
    }
  }
  return true;
}

}  // namespace tactus::exploration
