#include "framework/runtime/recorder.h"

#include <algorithm>
#include <cmath>

namespace tactus::runtime {

namespace {

constexpr double most_ticks_per_row = 1e15;                        // a slower rate writes the first row alone

}  // namespace

Recorder::Recorder(const RecorderOptions& options)
    : options_(options),
      timing_(options.folder + "/timing.csv", {"time", "tick_us"}),
      touched_(options.folder + "/touched_points.csv",
               {"time", "link", "x", "y", "z", "normal_x", "normal_y", "normal_z", "force_N"}),
      ticks_(options.first_tick) {}

void Recorder::observe(const control::ObservedTick& tick) {
  if (!columns_) {
    columns_.emplace(tick.controller, options_.columns, options_.contacts, options_.objects,
                     options_.faults, options_.measures);
    log_.emplace(options_.folder + "/log.csv", columns_->names());
    const double ticks = 1 / (options_.row_rate * tick.controller.period());
    ticks_per_row_ = std::lround(std::clamp(ticks, 1.0, most_ticks_per_row));
  }
  if (ticks_ % ticks_per_row_ == 0) {
    for (size_t column = 0; column < columns_->size(); ++column) *log_ << columns_->value(column, tick);
    log_->endRow();
  }
  ++ticks_;
  timing_ << tick.sensed.time << tick.tick_us;
  timing_.endRow();
  if (options_.touched_points) recordTouchedPoints(tick.controller.model());
  log_->flushWhenDue();
  touched_.flushWhenDue();
}

void Recorder::recordTouchedPoints(const dynamics::Model& model) {
  const auto& points = options_.touched_points->points;
  for (; points_written_ < points.size(); ++points_written_) {
    const control::TouchedPoint& point = points[points_written_];
    touched_ << point.time << model.frames()[static_cast<size_t>(point.frame)].name;
    for (int axis = 0; axis < 3; ++axis) touched_ << point.point_W[axis];
    for (int axis = 0; axis < 3; ++axis) touched_ << point.normal_W[axis];
    touched_ << point.force_N;
    touched_.endRow();
  }
}

void Recorder::close() {
  if (log_) log_->close();
  timing_.close();
  touched_.close();
}

}  // namespace tactus::runtime
