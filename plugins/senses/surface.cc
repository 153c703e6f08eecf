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

/// Appends cells, and counts on the pieces that they are of.
struct CellList {
  double pitch;
  int cuts;
  int shape = 0, pieces = 0;
  std::vector<SurfaceCell> cells = {};

  /// Pieces of `pitch` in `length`, at least one.
  int piecesIn(double length) const { return std::max(1, static_cast<int>(std::lround(length / pitch))); }
  void add(const Eigen::Vector3d& position_L, const Eigen::Vector3d& normal_L, double area, int piece) {
    cells.push_back({{position_L, normal_L}, area, shape, pieces + piece});
  }
};

void addCells(const CapsuleShape& capsule, CellList& list) {
  const double r = capsule.radius, length = (capsule.to - capsule.from).norm(), meridian = length + pi * r;
  const Eigen::Matrix3d axes = capsuleAxes(capsule);
  // Along the axis from `from`, at s along the meridian, and what of the radius is across the axis there.
  const auto height = [&](double s) {
    if (s < 0.5 * pi * r) return -r * std::cos(s / r);
    if (s < 0.5 * pi * r + length) return s - 0.5 * pi * r;
    return length + r * std::sin((s - 0.5 * pi * r - length) / r);
  };
  const auto across = [&](double z) {
    const double beyond = z - std::clamp(z, 0.0, length);
    return std::sqrt(std::max(0.0, r * r - beyond * beyond));
  };
  const int rings = list.piecesIn(meridian);
  for (int ring = 0; ring < rings; ++ring) {
    const int pieces = list.piecesIn(2 * pi * across(height(meridian * (ring + 0.5) / rings)));
    for (int k = ring * list.cuts; k < (ring + 1) * list.cuts; ++k) {
      const double step = meridian / (rings * list.cuts);
      const double z = height(step * (k + 0.5)), on_axis = std::clamp(z, 0.0, length);
      const double area = 2 * pi * r * (height(step * (k + 1)) - height(step * k)) / (pieces * list.cuts);
      for (int j = 0; j < pieces * list.cuts; ++j) {
        const double angle = 2 * pi * (j + 0.5) / (pieces * list.cuts);
        const Eigen::Vector3d normal =
            axes * Eigen::Vector3d(across(z) * std::cos(angle), across(z) * std::sin(angle), z - on_axis) / r;
        list.add(capsule.from + on_axis * axes.col(2) + r * normal, normal, area, j / list.cuts);
      }
    }
    list.pieces += pieces;
  }
}

void addCells(const BoxShape& box, CellList& list) {
  for (int face = 0; face < 6; ++face) {
    const int out = face / 2, u = (out + 1) % 3, v = (out + 2) % 3;
    const double side = face % 2 ? 1 : -1;
    const int rows = list.piecesIn(box.size[u]), columns = list.piecesIn(box.size[v]);
    const int fine_rows = rows * list.cuts, fine_columns = columns * list.cuts;
    for (int i = 0; i < fine_rows; ++i)
      for (int j = 0; j < fine_columns; ++j) {
        Eigen::Vector3d place;
        place[out] = 0.5 * side * box.size[out];
        place[u] = ((i + 0.5) / fine_rows - 0.5) * box.size[u];
        place[v] = ((j + 0.5) / fine_columns - 0.5) * box.size[v];
        list.add(box.pose * place, side * box.pose.linear().col(out),
                 box.size[u] * box.size[v] / (fine_rows * fine_columns), i / list.cuts * columns + j / list.cuts);
      }
    list.pieces += rows * columns;
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

std::vector<SurfaceCell> Surface::cells(double pitch, int cuts) const {
  CellList list{pitch, cuts};
  for (const description::LinkShape& shape : shapes_) {
    std::visit([&](const auto& s) { addCells(s, list); }, shape);
    ++list.shape;
  }
  std::erase_if(list.cells, [&](const SurfaceCell& cell) {
    for (int i = 0; i < static_cast<int>(shapes_.size()); ++i)
      if (i != cell.shape && nearestOf(shapes_[static_cast<std::size_t>(i)], cell.position_L).distance < 0) return true;
    return false;
  });
  return std::move(list.cells);
}

}  // namespace tactus::plugins
