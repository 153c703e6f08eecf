// A pendulum's replay: which columns and frames there are, that poses are those of the kinematics, and contacts.

#include "framework/runtime/replay_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/runtime/csv_table.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/loop.h"
#include "tests/runtime/pendulum.h"
#include "tests/runtime/temporary_folder.h"

namespace tactus::runtime {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using tactus::testing::contentOf;
using tactus::testing::pendulum;
using tactus::testing::pendulumController;
using tactus::testing::PendulumPlant;
using tactus::testing::TemporaryFolder;

description::Robot pendulumWithShapes() {
  description::Robot robot = pendulum();
  for (description::Link& link : robot.links)
    link.shapes.push_back(description::CapsuleShape{Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0, -0.5), 0.02});
  return robot;
}

/// A wall that the bob leans on, and a ball in free flight.
description::Scene wallAndBall() {
  description::Scene scene;
  scene.objects.resize(2);
  scene.objects[0].name = "wall";
  scene.objects[1].name = "ball";
  scene.objects[1].mobility = description::Mobility::free;
  return scene;
}

/// The pendulum, which says that it touches the wall from the second frame on.
class TouchingPlant final : public Plant {
 public:
  TouchingPlant() : objects_(2) {}
  const control::Sensed& sense() const override { return sensed_; }
  std::span<const control::ObjectMotion> objects() const override { return objects_; }
  void advance(const Eigen::VectorXd& torque, double duration) override {
    pendulum_.advance(torque, duration);
    sensed_ = pendulum_.sense();
    objects_[1].pose.translation() = Eigen::Vector3d(0, 0, -sensed_.time);
    if (sensed_.time < 0.01) return;
    control::ContactRecord touch;
    touch.link = 1;
    touch.object = 0;
    touch.point_W = Eigen::Vector3d(0.1, 0, -0.4);
    touch.normal_W = Eigen::Vector3d::UnitX();
    touch.force_N = 2;
    touch.friction_W = Eigen::Vector3d(0, 0, 0.5);
    sensed_.contacts = {touch};
    touch.force_N = 0;                                             // apart: no touch
    sensed_.contacts.push_back(touch);
  }

 private:
  PendulumPlant pendulum_;
  control::Sensed sensed_ = pendulum_.sense();
  std::vector<control::ObjectMotion> objects_;
};

void record(const std::string& folder, double duration, long first_tick = 0) {
  const description::Robot robot = pendulumWithShapes();
  const description::Scene scene = wallAndBall();
  TouchingPlant plant;
  ReplayRecorder recorder(folder, robot, scene, first_tick);
  const std::atomic<bool> stop{false};
  const LoopResult result =
      runLoop(plant, *pendulumController(0.5, false, -1, robot), duration, {&recorder}, stop);
  if (result.error) std::rethrow_exception(result.error);
  recorder.close();
}

TEST(ReplayRecorder, HoldsLinksAndObjectsThatMove) {
  const TemporaryFolder folder;
  record(folder.path(), 0.02);
  EXPECT_THAT(CsvTable::read(folder.file("replay.csv")).columns(),
              ElementsAre("time", "link/bob/x", "link/bob/y", "link/bob/z", "link/bob/qw", "link/bob/qx", "link/bob/qy",
                          "link/bob/qz", "object/ball/x", "object/ball/y", "object/ball/z", "object/ball/qw",
                          "object/ball/qx", "object/ball/qy", "object/ball/qz"));
}

TEST(ReplayRecorder, FramesComeEvery20MsAndTurnAsTheJointDoes) {
  const TemporaryFolder folder;
  record(folder.path(), 0.2);
  const CsvTable replay = CsvTable::read(folder.file("replay.csv"));
  ASSERT_EQ(replay.rows(), 10u);
  PendulumPlant alone;
  const std::vector<double> time = replay.numbers("time"), qw = replay.numbers("link/bob/qw"),
                            qy = replay.numbers("link/bob/qy"), z = replay.numbers("object/ball/z");
  for (size_t row = 0; row < replay.rows(); ++row) {
    EXPECT_NEAR(time[row], 0.02 * static_cast<double>(row), 1e-12);
    EXPECT_NEAR(qw[row] * qw[row] + qy[row] * qy[row], 1, 1e-4);   // about y, as the hinge
    EXPECT_NEAR(z[row], -time[row], 1e-5);
  }
  EXPECT_GT(qy.back(), qy.front());
}

TEST(ReplayRecorder, AForceIsWhatTheLinkDoesFrictionIncluded) {
  const TemporaryFolder folder;
  record(folder.path(), 0.05);
  const CsvTable contacts = CsvTable::read(folder.file("replay_contacts.csv"));
  ASSERT_EQ(contacts.rows(), 2u);                                  // frames 0.02 and 0.04
  EXPECT_EQ(contacts.cell(0, contacts.column("link")), "bob");
  EXPECT_EQ(contacts.cell(0, contacts.column("on")), "wall");
  EXPECT_EQ(contacts.numbers("force_x")[0], 2);
  EXPECT_EQ(contacts.numbers("force_z")[0], 0.5);
  EXPECT_EQ(contacts.numbers("z")[0], -0.4);
}

TEST(ReplayRecorder, FramesOfARunThatGoesOnKeepTheirTimes) {
  const TemporaryFolder folder;
  record(folder.path(), 0.05, 10);
  EXPECT_THAT(CsvTable::read(folder.file("replay.csv")).numbers("time"), ElementsAre(DoubleNear(0.01, 1e-12), DoubleNear(0.03, 1e-12)));
}

TEST(ReplayRecorder, RepeatsToTheByte) {
  const TemporaryFolder one, other;
  record(one.path(), 0.3);
  record(other.path(), 0.3);
  for (const char* file : {"replay.csv", "replay_contacts.csv"})
    EXPECT_EQ(contentOf(one.file(file)), contentOf(other.file(file))) << file;
}

TEST(ReplayRecorder, TellsOfAFolderThatThereIsNot) {
  EXPECT_THROW(record("/nonexistent", 0.1), FileError);
}

}  // namespace
}  // namespace tactus::runtime
