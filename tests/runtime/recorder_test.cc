// A pendulum's run, recorded: which columns there are, which rows, and that files repeat to the byte.

#include "framework/runtime/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/runtime/csv_table.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/loop.h"
#include "tests/runtime/pendulum.h"
#include "tests/runtime/temporary_folder.h"

namespace tactus::runtime {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tactus::testing::contentOf;
using tactus::testing::pendulumController;
using tactus::testing::PendulumPlant;
using tactus::testing::TemporaryFolder;

void record(const RecorderOptions& options, double duration, bool with_kkt = false) {
  PendulumPlant plant;
  ContactMetrics contacts(2, 1, {1});
  RecorderOptions with_contacts = options;
  with_contacts.contacts = &contacts;
  Recorder recorder(with_contacts);
  const std::atomic<bool> stop{false};
  const LoopResult result = runLoop(plant, *pendulumController(0.5, with_kkt), duration, {&contacts, &recorder}, stop);
  if (result.error) std::rethrow_exception(result.error);
  recorder.close();
}

RecorderOptions into(const TemporaryFolder& folder, ColumnSet columns = ColumnSet::standard, double rate = 100) {
  RecorderOptions options;
  options.folder = folder.path();
  options.columns = columns;
  options.row_rate = rate;
  return options;
}

TEST(Recorder, DefaultColumns) {
  const TemporaryFolder folder;
  record(into(folder), 0.01);
  EXPECT_THAT(
      CsvTable::read(folder.file("log.csv")).columns(),
      ElementsAre("time", "level/1/rank", "level/1/nullity", "level/1/active", "level/1/residual", "task/lift/error",
                  "task/lift/speed", "signal/clock/count", "contact/contacts", "contact/links", "contact/mean_N",
                  "contact/max_N", "contact/undesired_max_N", "controller/torque_norm", "controller/scale",
                  "controller/status", "controller/fallback", "controller/limited"));
}

TEST(Recorder, AllColumnsAddTheJoints) {
  const TemporaryFolder folder;
  record(into(folder, ColumnSet::all), 0.01, true);
  const CsvTable log = CsvTable::read(folder.file("log.csv"));
  for (const char* column : {"q/hinge", "qd/hinge", "tau/hinge", "kkt/stationarity", "kkt/primal",
                             "sensing/joints_held", "sensing/contacts_ignored"}) {
    EXPECT_GE(log.column(column), 0) << column;
  }
}

TEST(Recorder, RowsComeAtTheRowRate) {
  const TemporaryFolder folder;
  record(into(folder, ColumnSet::standard, 200), 0.1);
  const CsvTable log = CsvTable::read(folder.file("log.csv"));
  ASSERT_EQ(log.rows(), 20u);
  const std::vector<double> time = log.numbers(log.column("time")),
                            count = log.numbers(log.column("signal/clock/count"));
  for (size_t row = 0; row < log.rows(); ++row) {
    EXPECT_NEAR(time[row], 0.005 * static_cast<double>(row), 1e-12);
    EXPECT_EQ(count[row], 5.0 * static_cast<double>(row) + 1);
  }
}

TEST(Recorder, RowRateAboveTheControlRateMeansEveryTick) {
  const TemporaryFolder folder;
  record(into(folder, ColumnSet::standard, 1e6), 0.05);
  EXPECT_EQ(CsvTable::read(folder.file("log.csv")).rows(), 50u);
}

TEST(Recorder, EveryTickHasItsTime) {
  const TemporaryFolder folder;
  record(into(folder), 0.05);
  const CsvTable timing = CsvTable::read(folder.file("timing.csv"));
  EXPECT_EQ(timing.rows(), 50u);
  for (const double us : timing.numbers(timing.column("tick_us"))) EXPECT_GT(us, 0);
}

TEST(Recorder, LogRepeatsToTheByte) {
  const TemporaryFolder first, second;
  record(into(first, ColumnSet::all), 2);
  record(into(second, ColumnSet::all), 2);
  const std::string log = contentOf(first.file("log.csv"));
  EXPECT_GT(log.size(), 10000u);
  EXPECT_EQ(log, contentOf(second.file("log.csv")));
}

TEST(Recorder, TouchedPointsAreWrittenOnce) {
  const TemporaryFolder folder;
  control::TouchedPoints points;
  RecorderOptions options = into(folder);
  options.touched_points = &points;
  const auto controller = pendulumController(0.5);
  PendulumPlant plant;
  {
    Recorder recorder(options);
    const Eigen::VectorXd& torque = controller->tick(plant.sense());
    recorder.observe({plant.sense(), plant.sense(), *controller, torque, 1});
    points.points.push_back({0.25, 1, {1, 2, 3}, {0, 0, -1}, 0.5});
    recorder.observe({plant.sense(), plant.sense(), *controller, torque, 1});
    recorder.observe({plant.sense(), plant.sense(), *controller, torque, 1});
    recorder.close();
  }
  EXPECT_EQ(contentOf(folder.file("touched_points.csv")),
            "time,link,x,y,z,normal_x,normal_y,normal_z,force_N\n0.25,bob,1,2,3,0,0,-1,0.5\n");
}

TEST(Recorder, FullDiskIsTold) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder.file("log.csv") + unfinished_suffix);
  try {
    record(into(folder), 0.01);
    FAIL() << "a full disk went unnoticed";
  } catch (const FileError& error) {
    EXPECT_EQ(error.path, folder.file("log.csv"));
    EXPECT_THAT(error.what(), HasSubstr("cannot be written: No space left on device"));
  }
}

TEST(Recorder, MissingFolderIsTold) {
  RecorderOptions options;
  options.folder = "/nowhere";
  EXPECT_THROW(Recorder{options}, FileError);
}

}  // namespace
}  // namespace tactus::runtime
