// Torques on their way to a plant that keeps what it was given: a ramp of one unit a tick, so that every torque tells
// the tick in which it was wanted.

#include "framework/runtime/faulty_drives.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tactus::runtime {
namespace {

using description::TorqueFault;
using description::TorqueFaultKind;
using description::Window;
using ::testing::ElementsAre;

constexpr double kTick = 0.001;

class Keeper final : public Plant {
 public:
  explicit Keeper(std::vector<Eigen::Vector2d>& given) : given_(given) {
    sensed_.q = sensed_.qd = Eigen::VectorXd::Zero(2);
    record_ = {"own", "shove"};
  }
  const control::Sensed& sense() const override { return sensed_; }
  void faults(std::vector<const control::FaultRecord*>& records) const override { records.push_back(&record_); }
  void advance(const Eigen::VectorXd& torque, double duration) override {
    if (torque[0] > 1000) throw PlantError("too much");
    given_.emplace_back(torque);
    sensed_.time += duration;
  }

 private:
  std::vector<Eigen::Vector2d>& given_;
  control::Sensed sensed_;
  control::FaultRecord record_;
};

struct Driven {
  explicit Driven(std::vector<TorqueFault> faults)
      : plant(std::make_unique<Keeper>(given), std::move(faults), kTick) {
    plant.faults(records);
  }
  /// In tick k joint 0 is asked for k + 1, joint 1 for −10 (k + 1).
  Driven& run(int ticks) {
    for (int i = 0; i < ticks; ++i, ++asked) plant.advance(Eigen::Vector2d(asked + 1, -10 * (asked + 1)), kTick);
    return *this;
  }
  std::vector<double> of(int joint) const {
    std::vector<double> torques;
    for (const Eigen::Vector2d& torque : given) torques.push_back(torque[joint]);
    return torques;
  }
  std::vector<Eigen::Vector2d> given;
  FaultyDrives plant;
  std::vector<const control::FaultRecord*> records;
  int asked = 0;
};

TorqueFault fault(TorqueFaultKind kind, double from, double until, double number = 0) {
  return {.name = "fault", .kind = kind, .window = {from, until}, .joints = {0}, .factor = number, .delay = number};
}

TEST(FaultyDrives, WithoutFaultsAreThePlant) {
  EXPECT_THAT(Driven({}).run(3).of(1), ElementsAre(-10, -20, -30));
}

TEST(FaultyDrives, LoseAFactorOfTheTorqueOfTheirJoints) {
  Driven driven({fault(TorqueFaultKind::loss, 0.002, 0.004, 0.5)});
  driven.run(6);
  EXPECT_THAT(driven.of(0), ElementsAre(1, 2, 1.5, 2, 5, 6));
  EXPECT_THAT(driven.of(1), ElementsAre(-10, -20, -30, -40, -50, -60));
}

TEST(FaultyDrives, StickAtTheLastGoodTorque) {
  EXPECT_THAT(Driven({fault(TorqueFaultKind::stuck, 0.002, 0.004)}).run(6).of(0), ElementsAre(1, 2, 2, 2, 5, 6));
  EXPECT_THAT(Driven({fault(TorqueFaultKind::stuck, 0, INFINITY)}).run(3).of(0), ElementsAre(1, 1, 1));
}

TEST(FaultyDrives, AreLateByTheDelayAndAtFirstByAsMuchAsThereIs) {
  EXPECT_THAT(Driven({fault(TorqueFaultKind::delay, 0, INFINITY, 0.002)}).run(6).of(0), ElementsAre(1, 1, 1, 2, 3, 4));
  EXPECT_THAT(Driven({fault(TorqueFaultKind::delay, 0.003, 0.005, 0.002)}).run(7).of(0),
              ElementsAre(1, 2, 3, 2, 3, 6, 7)) << "it goes back as it comes, and jumps forward when it is over";
}

TEST(FaultyDrives, GoThroughTheirFaultsInOrder) {
  const TorqueFault late = fault(TorqueFaultKind::delay, 0, INFINITY, 0.001);
  const TorqueFault weak = fault(TorqueFaultKind::loss, 0.002, INFINITY, 0.5);
  EXPECT_THAT(Driven({late, weak}).run(4).of(0), ElementsAre(1, 1, 1, 1.5));
  EXPECT_THAT(Driven({weak, late}).run(4).of(0), ElementsAre(1, 1, 2, 1.5)) << "what was weakened comes late";
}

TEST(FaultyDrives, TellWhenEachFaultStruck) {
  Driven driven({fault(TorqueFaultKind::loss, 0.002, 0.004), fault(TorqueFaultKind::stuck, 0, INFINITY),
                 fault(TorqueFaultKind::delay, 1, 2, 0.001)});
  ASSERT_EQ(driven.records.size(), 4u);
  EXPECT_EQ(driven.records[3]->name, "own") << "those of the plant last";
  const control::FaultRecord &loss = *driven.records[0], &stuck = *driven.records[1], &delay = *driven.records[2];
  EXPECT_EQ(loss.kind, "torque-loss");
  EXPECT_FALSE(loss.strikes);
  EXPECT_TRUE(stuck.strikes) << "from the start";
  driven.run(2);
  EXPECT_TRUE(loss.strikes) << "in the tick that comes";
  driven.run(4);
  EXPECT_FALSE(loss.strikes);
  EXPECT_DOUBLE_EQ(loss.began, 0.002);
  EXPECT_DOUBLE_EQ(loss.ended, 0.004);
  EXPECT_EQ(stuck.began, 0);
  EXPECT_TRUE(std::isnan(stuck.ended));
  EXPECT_TRUE(std::isnan(delay.began));
}

TEST(FaultyDrives, LetThePlantsErrorsThrough) {
  Driven driven({fault(TorqueFaultKind::loss, 0, INFINITY, 1)});
  driven.asked = 2000;
  EXPECT_THROW(driven.run(1), PlantError);
  EXPECT_TRUE(driven.records[0]->strikes);
}

}  // namespace
}  // namespace tactus::runtime
