#include "plane_fit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

using namespace tactus::control;

void PlaneFit::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "plane.fit";
  row.description = "The plane nearest to all points touched so far.";
  row.source = "Pearson 1901; Welford 1962";
  row.attributes = {
      {.name = "from", .type = ValueType::port, .required = true, .description = "Touched points, e.g. touch.points.",
       .port_type = "touched-points"},
      {.name = "min-points", .type = ValueType::integer, .default_text = "6",
       .description = "Fewer points make no plane.", .lower = 3},
      {.name = "spread", .type = ValueType::real, .unit = "m", .default_text = "0.005",
       .description = "Points whose second direction spreads less are a line, not a plane.", .lower = 0},
  };
  row.ports = {{"known", "scalar", "1", "1 once there is a plane, else 0."},
               {"tilt", "scalar", "rad", "Angle between its normal and the vertical."},
               {"height", "scalar", "m", "Of the mean of the points, world axes."},
               {"rms", "scalar", "m", "Root mean square distance of the points."}};
  registry.addSignal(row, [](const BuildContext& context) { return std::make_unique<PlaneFit>(context); });
}

PlaneFit::PlaneFit(const BuildContext& context)
    : points_(context.port<TouchedPoints>("from")),
      min_points_(context.values.integer("min-points")),
      spread_(context.values.real("spread")) {}

void PlaneFit::doUpdate(const Tick&) {
  if (seen_ == points_.points.size()) return;
  while (seen_ < points_.points.size()) add(points_.points[seen_++]);
  fit();
}

void PlaneFit::add(const TouchedPoint& touched) {
  const Eigen::Vector3d before = touched.point_W - mean_;
  mean_ += before / static_cast<double>(seen_);
  const Eigen::Vector3d after = touched.point_W - mean_;
  scatter_ += before * after.transpose();
  normals_ += touched.normal_W;
}

void PlaneFit::fit() {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (scatter_ + scatter_.transpose()));
  const double count = static_cast<double>(seen_);
  known_ = seen_ >= min_points_ && solver.eigenvalues()[1] > spread_ * spread_ * count;
  if (known_ == 0) return;
  Eigen::Vector3d normal = solver.eigenvectors().col(0);           // eigenvalues rise
  if (normal.dot(normals_) > 0) normal = -normal;
  tilt_ = std::acos(std::clamp(normal.z(), -1.0, 1.0));
  height_ = mean_.z();
  rms_ = std::sqrt(std::max(solver.eigenvalues()[0], 0.0) / count);
}

void PlaneFit::doArchive(Archive& archive) {
  archive("seen", seen_);
  archive("mean", mean_);
  archive("scatter", scatter_);
  archive("normals", normals_);
  archive("known", known_);
  archive("tilt", tilt_);
  archive("height", height_);
  archive("rms", rms_);
}

const void* PlaneFit::doPort(std::string_view name) const {
  if (name == "known") return &known_;
  if (name == "tilt") return &tilt_;
  if (name == "height") return &height_;
  if (name == "rms") return &rms_;
  return nullptr;
}

void PlaneFit::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"known", &known_});
  columns.push_back({"tilt_rad", &tilt_});
  columns.push_back({"height_m", &height_});
  columns.push_back({"rms_m", &rms_});
}
