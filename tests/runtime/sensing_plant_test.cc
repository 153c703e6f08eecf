// What stands between the plant and the controller: each sensor in its order, on a copy of what there is.

#include "framework/runtime/sensing_plant.h"

#include <gtest/gtest.h>

#include "framework/runtime/part_error.h"
#include "tests/runtime/pendulum.h"

namespace tactus::runtime {
namespace {

/// Adds to the angle, and reads the angle that it was told.
class Shift final : public control::Sensor {
 public:
  explicit Shift(double by) : by_(by) {}

 private:
  void doSense(const control::Sensed& truth, control::Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) override {
    if (truth.time > 0.002) throw std::runtime_error("the cable broke");
    readings[0] = felt.q[0];
    felt.q[0] += by_;
  }
  double by_;
};

std::unique_ptr<SensingPlant> shifted() {
  std::vector<NamedSensor> sensors;
  sensors.push_back({"first", std::make_unique<Shift>(1), {{"first", "angle", 1, true}}});
  sensors.push_back({"second", std::make_unique<Shift>(10), {{"second", "angle", 1, true}}});
  return std::make_unique<SensingPlant>(std::make_unique<tactus::testing::PendulumPlant>(), std::move(sensors));
}

TEST(SensingPlant, GoesThroughItsSensorsInOrder) {
  const auto plant = shifted();
  EXPECT_EQ(plant->sense().q[0], 11);
  EXPECT_EQ(plant->sense().readings, Eigen::Vector2d(0, 1));
  EXPECT_EQ(plant->truth().q[0], 0);
}

TEST(SensingPlant, FeelsAnewAfterEveryStep) {
  const auto plant = shifted();
  plant->advance(Eigen::VectorXd::Constant(1, 5), 0.001);
  EXPECT_GT(plant->truth().q[0], 0);
  EXPECT_DOUBLE_EQ(plant->sense().q[0], plant->truth().q[0] + 11);
  EXPECT_EQ(plant->sense().time, plant->truth().time);
}

TEST(SensingPlant, WithoutSensorsIsThePlant) {
  const SensingPlant plant(std::make_unique<tactus::testing::PendulumPlant>(), {});
  EXPECT_EQ(&plant.sense(), &plant.truth());
}

/// Reads the wrenches of links.
class Wrist final : public control::Sensor {
 public:
  explicit Wrist(std::vector<int> links) : links_(std::move(links)) {}
  std::vector<int> wrenchLinks() const override { return links_; }

 private:
  void doSense(const control::Sensed&, control::Sensed&, Eigen::Ref<Eigen::VectorXd>) override {}
  std::vector<int> links_;
};

TEST(SensingPlant, AsksForEachWrenchOnce) {
  std::vector<NamedSensor> sensors;
  sensors.push_back({"left", std::make_unique<Wrist>(std::vector{7, 3}), {}});
  sensors.push_back({"shift", std::make_unique<Shift>(1), {}});
  sensors.push_back({"right", std::make_unique<Wrist>(std::vector{3, 5}), {}});
  EXPECT_EQ(wrenchLinks(sensors), (std::vector{3, 5, 7}));
}

TEST(SensingPlant, NamesTheSensorThatThrows) {
  const auto plant = shifted();
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(1);
  plant->advance(none, 0.002);
  try {
    plant->advance(none, 0.001);
    FAIL();
  } catch (const PartError& error) {
    EXPECT_STREQ(error.what(), "sensor 'first' failed at t = 0.003 s: the cable broke");
  }
}

}  // namespace
}  // namespace tactus::runtime
