#include "plugins/bump-estimate/bump_estimate.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace tactus::plugins {

using namespace control;

namespace {

constexpr int kPlaneSamples = 64;
constexpr int kPlanePoints = 1000;                                 // more are thinned out evenly
constexpr int kMaxFeaturePoints = 20000;
constexpr int kGaussNewtonSteps = 10;

/// SplitMix64 (Steele et al. 2014).
std::uint64_t nextRandom(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace

void BumpEstimate::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "bump-estimate";
  row.kind = ElementKind::signal;
  row.description = "Finds a round bump on a flat surface from touched points alone.";
  row.source = "thesis 4.4.1, experiment 1 (search for the bump); Fischler & Bolles 1981";
  row.attributes = {
      {.name = "from", .type = ValueType::port, .required = true, .description = "Touched points, e.g. touch.points.",
       .port_type = "touched-points"},
      {.name = "min-height", .type = ValueType::real, .unit = "m", .default_text = "0.002",
       .description = "A touched point higher than this above the surface belongs to a bump.", .lower = 0,
       .lower_open = true},
      {.name = "min-points", .type = ValueType::integer, .default_text = "12",
       .description = "Fewer points make no bump.", .lower = 4},
      {.name = "tolerance", .type = ValueType::real, .unit = "m", .default_text = "0.001",
       .description = "Distance from the plane within which a point supports it.", .lower = 0, .lower_open = true},
      {.name = "interval", .type = ValueType::real, .unit = "s", .default_text = "0.5",
       .description = "Time between estimates.", .lower = 0, .lower_open = true},
  };
  row.ports = {{"estimate", "feature", "m", "The bump's top and height."}};
  registry.addSignal(row, [](const BuildContext& context) { return std::make_unique<BumpEstimate>(context); });
}

BumpEstimate::BumpEstimate(const BuildContext& context)
    : touched_(context.port<TouchedPoints>("from")),
      min_height_(context.values.real("min-height")),
      tolerance_(context.values.real("tolerance")),
      interval_(context.values.real("interval")),
      min_points_(context.values.integer("min-points")) {
  feature_.reserve(kMaxFeaturePoints);
}

void BumpEstimate::doUpdate(const Tick& tick) {
  if (tick.time < next_time_ - 1e-9) return;
  next_time_ += interval_;
  estimate();
  found_ = result_.found ? 1 : 0;
  x_ = result_.position_W.x();
  y_ = result_.position_W.y();
  z_ = result_.position_W.z();
}

void BumpEstimate::doArchive(Archive& archive) {
  archive("next-time", next_time_);
  archive("random", random_);
  archive("result", result_);
  archive("found", found_);
  archive("x", x_);
  archive("y", y_);
  archive("z", z_);
}

void BumpEstimate::estimate() {
  result_ = FeatureEstimate{};
  Plane plane;
  if (!fitPlane(plane)) return;

  feature_.clear();
  double highest = 0;
  Eigen::Vector3d highest_point = Eigen::Vector3d::Zero();
  for (const TouchedPoint& touched : touched_.points) {
    const double height = plane.normal.dot(touched.point_W) - plane.offset;
    if (height <= min_height_ || feature_.size() >= kMaxFeaturePoints) continue;
    feature_.push_back(touched.point_W);
    if (height > highest) {
      highest = height;
      highest_point = touched.point_W;
    }
  }
  if (static_cast<int>(feature_.size()) < min_points_) return;

  result_.found = true;
  result_.points = static_cast<int>(feature_.size());
  result_.position_W = highest_point;
  result_.height = highest;
  Sphere sphere;
  if (!fitSphere(sphere)) return;
  const Eigen::Vector3d top = sphere.centre + sphere.radius * plane.normal;
  const double height = plane.normal.dot(top) - plane.offset;
  const bool sensible = height >= highest - tolerance_ && height <= 2 * highest && (top - highest_point).norm() <= sphere.radius;
  if (!sensible) return;
  result_.position_W = top;
  result_.height = height;
}

bool BumpEstimate::fitPlane(Plane& plane) {
  const std::size_t n = touched_.points.size();
  if (static_cast<int>(n) < min_points_) return false;
  const std::size_t stride = n / kPlanePoints + 1;
  std::size_t most = 0;
  random_ = 1;
  for (int sample = 0; sample < kPlaneSamples; ++sample) {
    const Eigen::Vector3d& a = touched_.points[nextRandom(random_) % n].point_W;
    const Eigen::Vector3d& b = touched_.points[nextRandom(random_) % n].point_W;
    const Eigen::Vector3d& c = touched_.points[nextRandom(random_) % n].point_W;
    const Eigen::Vector3d across = (b - a).cross(c - a);
    if (across.norm() < 1e-8) continue;
    const Plane candidate{across.normalized(), across.normalized().dot(a)};
    std::size_t support = 0;
    for (std::size_t i = 0; i < n; i += stride) {
      support += std::abs(candidate.normal.dot(touched_.points[i].point_W) - candidate.offset) < tolerance_;
    }
    if (support > most) {
      most = support;
      plane = candidate;
    }
  }
  if (most < 3) return false;

  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d contact_normal = Eigen::Vector3d::Zero();
  double count = 0;
  const Plane rough = plane;
  const auto supports = [&](const TouchedPoint& t) {
    return std::abs(rough.normal.dot(t.point_W) - rough.offset) < 2 * tolerance_;
  };
  for (const TouchedPoint& t : touched_.points) {
    if (!supports(t)) continue;
    mean += t.point_W;
    contact_normal += t.normal_W;
    ++count;
  }
  mean /= count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const TouchedPoint& t : touched_.points) {
    if (supports(t)) spread += (t.point_W - mean) * (t.point_W - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  plane.normal = axes.eigenvectors().col(0);
  if (plane.normal.dot(contact_normal) > 0) plane.normal = -plane.normal;
  plane.offset = plane.normal.dot(mean);
  return true;
}

bool BumpEstimate::fitSphere(Sphere& sphere) {
  // ‖p − c‖² = r² is linear in (c, r² − ‖c‖²); points are taken from their mean, for a well-conditioned system.
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : feature_) mean += p;
  mean /= static_cast<double>(feature_.size());
  Eigen::Matrix4d normal_matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right_side = Eigen::Vector4d::Zero();
  for (const Eigen::Vector3d& p : feature_) {
    Eigen::Vector4d row;
    row << 2 * (p - mean), 1;
    normal_matrix += row * row.transpose();
    right_side += row * (p - mean).squaredNorm();
  }
  const Eigen::Vector4d solution = normal_matrix.ldlt().solve(right_side);
  const Eigen::Vector3d c = solution.head<3>();
  const double r2 = solution[3] + c.squaredNorm();
  if (!solution.allFinite() || !(r2 > 0)) return false;
  sphere = {mean + c, std::sqrt(r2)};

  for (int step = 0; step < kGaussNewtonSteps; ++step) {
    double squares = 0;
    for (const Eigen::Vector3d& p : feature_) squares += std::pow((p - sphere.centre).norm() - sphere.radius, 2);
    const double outlier = std::max(2.5 * std::sqrt(squares / static_cast<double>(feature_.size())), 1e-5);
    Eigen::Matrix4d JtJ = Eigen::Matrix4d::Zero();
    Eigen::Vector4d Jte = Eigen::Vector4d::Zero();
    for (const Eigen::Vector3d& p : feature_) {
      const Eigen::Vector3d away = p - sphere.centre;
      const double distance = away.norm();
      const double error = distance - sphere.radius;
      if (distance < 1e-9 || std::abs(error) > outlier) continue;
      Eigen::Vector4d row;
      row << -away / distance, -1;
      JtJ += row * row.transpose();
      Jte += row * error;
    }
    const Eigen::Vector4d change = -JtJ.ldlt().solve(Jte);
    if (!change.allFinite()) return false;
    sphere.centre += change.head<3>();
    sphere.radius += change[3];
    if (change.norm() < 1e-9) break;
  }
  return sphere.radius > 0 && sphere.radius < 1;
}

const void* BumpEstimate::doPort(std::string_view name) const { return name == "estimate" ? &result_ : nullptr; }

void BumpEstimate::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"found", &found_});
  columns.push_back({"x", &x_});
  columns.push_back({"y", &y_});
  columns.push_back({"z", &z_});
}

}  // namespace tactus::plugins
