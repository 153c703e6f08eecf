#include "plugins/senses/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::plugins {
namespace {

using description::BoxShape;
using description::CapsuleShape;
using std::numbers::pi;

/// The nearest place of the surface, and the signed distance to it.
struct Nearest {
  SurfacePoint place;
  double distance;
};

Nearest nearestOf(const CapsuleShape& capsule, const Eigen::Vector3d& p) {
  const Eigen::Vector3d along = capsule.to - capsule.from;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - capsule.from).dot(along) / length2, 0.0, 1.0) : 0;
  const Eigen::Vector3d middle = capsule.from + t * along, away = p - middle;
  const double distance = away.norm();
  const Eigen::Vector3d normal = distance > 0 ? Eigen::Vector3d(away / distance) : capsuleAxes(capsule).col(0);
  return {{middle + capsule.radius * normal, normal}, distance - capsule.radius};
}

Nearest nearestOf(const BoxShape& box, const Eigen::Vector3d& p_L) {
  const Eigen::Vector3d half = 0.5 * box.size, p = box.pose.inverse() * p_L;
  const Eigen::Vector3d beyond = p.cwiseAbs() - half;
  Eigen::Index face = 0;
  const double most = beyond.maxCoeff(&face);
  Eigen::Vector3d place = p.cwiseMax(-half).cwiseMin(half);
  place[face] = std::copysign(half[face], p[face]);
  const Eigen::Vector3d normal = std::copysign(1.0, p[face]) * box.pose.linear().col(face);
  return {{box.pose * place, normal}, most > 0 ? beyond.cwiseMax(0).norm() : most};
}

Nearest nearestOf(const description::LinkShape& shape, const Eigen::Vector3d& p) {
  return std::visit([&](const auto& s) { return nearestOf(s, p); }, shape);
}

void addCells(const CapsuleShape& capsule, double pitch, int shape, std::vector<SurfaceCell>& cells) {
  const double r = capsule.radius, length = (capsule.to - capsule.from).norm(), meridian = length + pi * r;
  const Eigen::Matrix3d axes = capsuleAxes(capsule);
  // Height above the pole of `from`, and what of the radius is across the axis, at s along the meridian.
  const auto height = [&](double s) {
    if (s < 0.5 * pi * r) return r - r * std::cos(s / r);
    if (s < 0.5 * pi * r + length) return r + s - 0.5 * pi * r;
    return r + length + r * std::sin((s - 0.5 * pi * r - length) / r);
  };
  const int rings = std::max(1, static_cast<int>(std::lround(meridian / pitch)));
  for (int k = 0; k < rings; ++k) {
    const double low = height(meridian * k / rings), high = height(meridian * (k + 1) / rings);
    const double z = height(meridian * (k + 0.5) / rings) - r;     // from `from` along the axis
    const double on_axis = std::clamp(z, 0.0, length);
    const double across = std::sqrt(std::max(0.0, r * r - (z - on_axis) * (z - on_axis)));
    const int pieces = std::max(1, static_cast<int>(std::lround(2 * pi * across / pitch)));
    for (int j = 0; j < pieces; ++j) {
      const double angle = 2 * pi * (j + 0.5) / pieces;
      const Eigen::Vector3d normal =
          axes * Eigen::Vector3d(across * std::cos(angle), across * std::sin(angle), z - on_axis) / r;
      const Eigen::Vector3d position = capsule.from + on_axis * axes.col(2) + r * normal;
      cells.push_back({{position, normal}, 2 * pi * r * (high - low) / pieces, shape});
    }
  }
}

void addCells(const BoxShape& box, double pitch, int shape, std::vector<SurfaceCell>& cells) {
  for (int face = 0; face < 6; ++face) {
    const int out = face / 2, u = (out + 1) % 3, v = (out + 2) % 3;
    const double side = face % 2 ? 1 : -1;
    const int rows = std::max(1, static_cast<int>(std::lround(box.size[u] / pitch)));
    const int columns = std::max(1, static_cast<int>(std::lround(box.size[v] / pitch)));
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) {
        Eigen::Vector3d place;
        place[out] = 0.5 * side * box.size[out];
        place[u] = ((i + 0.5) / rows - 0.5) * box.size[u];
        place[v] = ((j + 0.5) / columns - 0.5) * box.size[v];
        cells.push_back({{box.pose * place, side * box.pose.linear().col(out)},
                         box.size[u] * box.size[v] / (rows * columns), shape});
      }
  }
}

}  // namespace

Eigen::Matrix3d capsuleAxes(const CapsuleShape& capsule) {
  const Eigen::Vector3d along = capsule.to - capsule.from;
  return description::planeFrame(along.norm() > 0 ? Eigen::Vector3d(along.normalized()) : Eigen::Vector3d::UnitZ());
}

int Surface::shapeNear(const Eigen::Vector3d& point_L) const {
  int best = 0;
  double least = INFINITY;
  for (int i = 0; i < static_cast<int>(shapes_.size()); ++i) {
    const double distance = std::abs(nearestOf(shapes_[static_cast<std::size_t>(i)], point_L).distance);
    if (distance >= least) continue;
    least = distance;
    best = i;
  }
  return best;
}

SurfacePoint Surface::nearest(const Eigen::Vector3d& point_L) const {
  return nearestOf(shapes_[static_cast<std::size_t>(shapeNear(point_L))], point_L).place;
}

double Surface::radiusNear(const Eigen::Vector3d& point_L) const {
  const description::LinkShape& shape = shapes_[static_cast<std::size_t>(shapeNear(point_L))];
  if (const auto* capsule = std::get_if<CapsuleShape>(&shape)) return capsule->radius;
  return 0.25 * std::get<BoxShape>(shape).size.minCoeff();
}

std::vector<SurfaceCell> Surface::cells(double pitch) const {
  std::vector<SurfaceCell> cells;
  for (int i = 0; i < static_cast<int>(shapes_.size()); ++i)
    std::visit([&](const auto& s) { addCells(s, pitch, i, cells); }, shapes_[static_cast<std::size_t>(i)]);
  std::erase_if(cells, [&](const SurfaceCell& cell) {
    for (int i = 0; i < static_cast<int>(shapes_.size()); ++i)
      if (i != cell.shape && nearestOf(shapes_[static_cast<std::size_t>(i)], cell.position_L).distance < 0) return true;
    return false;
  });
  return cells;
}

}  // namespace tactus::plugins
