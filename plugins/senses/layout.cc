#include "plugins/senses/layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "framework/control/registry.h"

namespace tactus::plugins {

using control::ElementError;
using description::CapsuleShape;
using description::Link;
using std::numbers::pi;

namespace {

constexpr int kFingertipTaxels = 12;
constexpr int kNodes = 6;
constexpr double kNodeLength = 0.009, kNodeWidth = 0.005;          // m
constexpr int kGridCuts = 2;                                       // of a taxel's piece, along and across
constexpr double kFineCell = 0.001;                                // m, where taxels are not a grid
constexpr std::size_t kMostTaxels = 4096;                          // of one link
constexpr double kRounding = 1e-9;

struct Axial {
  double along;                                                    // m, from the capsule's `from`
  Eigen::Vector3d out;                                             // unit, across the axis; zero on it
};

Axial axialOf(const CapsuleShape& capsule, const Eigen::Vector3d& point_L) {
  const Eigen::Vector3d axis = capsuleAxes(capsule).col(2);
  const double along = (point_L - capsule.from).dot(axis);
  const Eigen::Vector3d across = point_L - capsule.from - along * axis;
  return {along, across.norm() > kRounding ? Eigen::Vector3d(across.normalized()) : Eigen::Vector3d::Zero()};
}

double lengthOf(const CapsuleShape& capsule) { return (capsule.to - capsule.from).norm(); }

[[noreturn]] void throwNoSide(const Link& link) {
  throw ElementError("facing", "it points along link '" + link.name + "', to none of its sides");
}

/// Points from the capsule outwards at the end that is farther from the link's origin.
Eigen::Vector3d tipDirection(const CapsuleShape& capsule) {
  const Eigen::Vector3d axis = capsuleAxes(capsule).col(2);
  return capsule.to.norm() >= capsule.from.norm() ? axis : Eigen::Vector3d(-axis);
}
const Eigen::Vector3d& tipOf(const CapsuleShape& capsule) {
  return capsule.to.norm() >= capsule.from.norm() ? capsule.to : capsule.from;
}

}  // namespace

Layout::Layout(const control::ElementValues& values, int links)
    : links_(links), pitch_(values.has("pitch") ? values.real("pitch") : 0.004), arc_(values.real("arc")) {
  const std::string& name = values.text("layout");
  kind_ = name == "icub-fingertip" ? Kind::fingertip : name == "six-node" ? Kind::six_node : Kind::tekscan;
  const bool has_counts = values.has("counts"), has_positions = values.has("positions");
  if (kind_ != Kind::tekscan && (has_counts || has_positions || values.has("pitch")))
    throw ElementError("layout", "the layout '" + name + "' has its own taxels: leave out pitch, counts and positions");
  if (values.has("facing")) {
    const Eigen::Vector3d facing = values.vector3("facing");
    if (facing.norm() < kRounding) throw ElementError("facing", "it has no direction");
    facing_ = facing.normalized();
  }
  if (has_counts) {
    kind_ = Kind::counts;
    rows_ = static_cast<int>(std::lround(values.numbers("counts")[0]));
    columns_ = static_cast<int>(std::lround(values.numbers("counts")[1]));
    if (values.numbers("counts")[0] * values.numbers("counts")[1] > static_cast<double>(kMostTaxels))
      throw ElementError("counts", "a link carries at most " + std::to_string(kMostTaxels) + " taxels");
    if (rows_ != values.numbers("counts")[0] || columns_ != values.numbers("counts")[1] || rows_ < 1 || columns_ < 1)
      throw ElementError("counts", "rows and columns are whole numbers of at least 1");
  }
  if (has_positions) {
    kind_ = Kind::positions;
    const std::vector<double>& numbers = values.numbers("positions");
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
      positions_.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }
  if (kind_ == Kind::six_node && !facing_)
    throw ElementError("facing", "six nodes lie on one side of a finger: say which one, in the axes of its links");
  if (kind_ == Kind::six_node && kNodes % links_ != 0)
    throw ElementError("links", "six nodes are shared by 1, 2, 3 or 6 links, these are " + std::to_string(links_));
}

Layout::Electronics Layout::electronics() const {
  if (kind_ == Kind::fingertip) return {.range_N = 2, .levels = 255, .rate_Hz = 0, .counts = true};
  if (kind_ == Kind::six_node) return {.range_N = 0, .levels = 0, .rate_Hz = 20, .counts = false};
  return {};
}

bool Layout::faces(const Eigen::Vector3d& normal_L) const {
  return !facing_ || normal_L.dot(*facing_) >= std::cos(arc_) - kRounding;
}

const CapsuleShape& Layout::capsuleOf(const Link& link) const {
  for (const description::LinkShape& shape : link.shapes)
    if (const auto* capsule = std::get_if<CapsuleShape>(&shape)) return *capsule;
  throw ElementError("links", "link '" + link.name + "' has no capsule to lay these taxels on");
}

void Layout::addGrid(const Surface& surface, TaxelPlan& plan) const {
  plan.cells = surface.cells(pitch_, kGridCuts);
  std::map<int, std::vector<int>> cells_of;                        // by piece
  for (int i = 0; i < static_cast<int>(plan.cells.size()); ++i)
    cells_of[plan.cells[static_cast<std::size_t>(i)].piece].push_back(i);
  for (const SurfaceCell& piece : surface.cells(pitch_))
    if (faces(piece.normal_L)) plan.taxels.push_back({{piece.position_L, piece.normal_L}, cells_of[piece.piece]});
}

void Layout::addCounts(const Link& link, TaxelPlan& plan) const {
  const CapsuleShape& capsule = capsuleOf(link);
  const double length = lengthOf(capsule);
  if (length < kRounding)
    throw ElementError("counts", "link '" + link.name + "' is a ball, without a straight part for rows");
  const Eigen::Matrix3d axes = capsuleAxes(capsule);
  Eigen::Vector3d first = axes.col(0);
  if (facing_) first = *facing_ - axes.col(2) * axes.col(2).dot(*facing_);
  if (first.norm() < kRounding) throwNoSide(link);
  first.normalize();
  const Eigen::Vector3d second = axes.col(2).cross(first);
  const double spread = facing_ ? 2 * arc_ : 2 * pi;
  for (int i = 0; i < rows_; ++i)
    for (int j = 0; j < columns_; ++j) {
      const double angle = spread * ((j + 0.5) / columns_ - 0.5);
      const Eigen::Vector3d normal = std::cos(angle) * first + std::sin(angle) * second;
      const Eigen::Vector3d middle = capsule.from + length * (i + 0.5) / rows_ * axes.col(2);
      plan.taxels.push_back({{middle + capsule.radius * normal, normal}});
    }
  plan.pitch = std::max(length / rows_, capsule.radius * spread / columns_);
}

void Layout::addPositions(const Surface& surface, TaxelPlan& plan) const {
  for (const Eigen::Vector3d& position : positions_) plan.taxels.push_back({surface.nearest(position)});
}

void Layout::addFingertip(const Link& link, TaxelPlan& plan) const {
  const CapsuleShape& capsule = capsuleOf(link);
  const Eigen::Vector3d pole = tipDirection(capsule);
  const Eigen::Matrix3d axes = description::planeFrame(pole);
  for (int i = 0; i < kFingertipTaxels; ++i) {
    const double height = 1 - (i + 0.5) / kFingertipTaxels, across = std::sqrt(1 - height * height);
    const double angle = i * pi * (3 - std::sqrt(5.0));
    const Eigen::Vector3d normal = axes * Eigen::Vector3d(across * std::cos(angle), across * std::sin(angle), height);
    plan.taxels.push_back({{tipOf(capsule) + capsule.radius * normal, normal}});
  }
  plan.pitch = capsule.radius * std::sqrt(2 * pi / kFingertipTaxels);
}

void Layout::addNodes(const Link& link, TaxelPlan& plan) const {
  const CapsuleShape& capsule = capsuleOf(link);
  const Eigen::Vector3d axis = capsuleAxes(capsule).col(2);
  const Eigen::Vector3d side = *facing_ - axis * axis.dot(*facing_);
  if (side.norm() < kRounding) throwNoSide(link);
  const int nodes = kNodes / links_;
  for (int j = 0; j < nodes; ++j) {
    const Eigen::Vector3d middle = capsule.from + lengthOf(capsule) * (j + 0.5) / nodes * axis;
    plan.taxels.push_back({{middle + capsule.radius * side.normalized(), side.normalized()}});
  }
  plan.pitch = std::max(kNodeLength, lengthOf(capsule) / nodes);
}

bool Layout::collects(const Taxel& taxel, const SurfaceCell& cell, const Link& link) const {
  const Eigen::Vector3d apart = cell.position_L - taxel.position_L;
  switch (kind_) {
    case Kind::tekscan: return false;                              // has the cells of its piece
    case Kind::positions: return apart.norm() <= 0.5 * pitch_ && cell.normal_L.dot(taxel.normal_L) > 0;
    case Kind::counts: {
      const CapsuleShape& capsule = capsuleOf(link);
      const Axial at = axialOf(capsule, cell.position_L);
      return at.along >= 0 && at.along <= lengthOf(capsule) && faces(cell.normal_L);
    }
    case Kind::fingertip: {
      const CapsuleShape& capsule = capsuleOf(link);
      return (cell.position_L - tipOf(capsule)).dot(tipDirection(capsule)) >= 0;
    }
    case Kind::six_node: {
      const CapsuleShape& capsule = capsuleOf(link);
      const double turn = std::acos(std::clamp(axialOf(capsule, cell.position_L).out.dot(taxel.normal_L), -1.0, 1.0));
      return std::abs(apart.dot(capsuleAxes(capsule).col(2))) <= 0.5 * kNodeLength &&
             capsule.radius * turn <= 0.5 * kNodeWidth;
    }
  }
  return false;
}

TaxelPlan Layout::plan(const Link& link) const {
  const Surface surface(link);
  TaxelPlan plan;
  plan.pitch = pitch_;
  switch (kind_) {
    case Kind::tekscan: addGrid(surface, plan); break;
    case Kind::counts: addCounts(link, plan); break;
    case Kind::positions: addPositions(surface, plan); break;
    case Kind::fingertip: addFingertip(link, plan); break;
    case Kind::six_node: addNodes(link, plan); break;
  }
  if (plan.taxels.size() > kMostTaxels)
    throw ElementError("pitch", "link '" + link.name + "' would have " + std::to_string(plan.taxels.size()) +
                                    " taxels, and can have " + std::to_string(kMostTaxels) + ": take a larger pitch");
  if (kind_ == Kind::tekscan) return plan;
  plan.cells = surface.cells(std::min(kFineCell, 0.25 * plan.pitch));
  assignCells(link, plan);
  return plan;
}

void Layout::assignCells(const Link& link, TaxelPlan& plan) const {
  for (int i = 0; i < static_cast<int>(plan.cells.size()); ++i) {
    const SurfaceCell& cell = plan.cells[static_cast<std::size_t>(i)];
    Taxel* nearest = nullptr;
    double least = INFINITY;
    for (Taxel& taxel : plan.taxels) {
      const double distance = (cell.position_L - taxel.position_L).squaredNorm();
      if (distance >= least || cell.normal_L.dot(taxel.normal_L) <= 0) continue;
      least = distance;
      nearest = &taxel;
    }
    if (nearest && collects(*nearest, cell, link)) nearest->cells.push_back(i);
  }
}

}  // namespace tactus::plugins
