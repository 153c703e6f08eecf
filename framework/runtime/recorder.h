#pragma once

#include <optional>
#include <string>

#include "framework/control/contact_set.h"
#include "framework/runtime/csv_writer.h"
#include "framework/runtime/log_columns.h"

namespace tactus::runtime {

struct RecorderOptions {
  std::string folder;                                              ///< exists already
  ColumnSet columns = ColumnSet::standard;
  double row_rate = 100;                                           ///< Hz, rows of log.csv; at most the control rate
  const ContactMetrics* contacts = nullptr;                        ///< observes before the recorder; null: no columns
  std::vector<MovingObject> objects = {};                          ///< whose motion goes into log.csv
  std::vector<const control::FaultRecord*> faults = {};            ///< that get columns of log.csv; they outlive it
  std::vector<control::LogColumn> measures = {};                   ///< that stand in log.csv; they outlive it
  const control::TouchedPoints* touched_points = nullptr;          ///< null: touched_points.csv keeps its header alone
  long first_tick = 0;                                             ///< of the run, counted from its start
};

/// Writes a run as it goes:
///   log.csv             LogColumns, one row every 1/row_rate seconds
///   timing.csv          time, tick_us: wall-clock time of every tick
///   touched_points.csv  time, link, x, y, z (m), normal_x, normal_y, normal_z (out of the robot), force_N
/// What is older than a second of the wall clock is in the files at every tick.
/// Throws FileError when a file cannot be written.
class Recorder final : public control::Observer {
 public:
  explicit Recorder(const RecorderOptions& options);

  void observe(const control::ObservedTick& tick) override;
  /// Without it errors of the last rows are lost.
  void close() override;

 private:
  void recordTouchedPoints(const dynamics::Model& model);

  RecorderOptions options_;
  std::optional<LogColumns> columns_;                              ///< from the first tick on
  std::optional<CsvWriter> log_;
  CsvWriter timing_;
  CsvWriter touched_;
  long ticks_ = 0;
  long ticks_per_row_ = 1;
  size_t points_written_ = 0;
};

}  // namespace tactus::runtime
