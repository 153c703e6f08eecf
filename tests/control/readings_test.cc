// What sensors read reaches ports at fixed addresses; what is no number leaves the last good one.

#include "framework/control/readings.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::control {
namespace {

Readings two() { return Readings({{"ft", "force", 1, true}, {"ft", "wrench", 3, false}, {"skin", "taxels", 1, false}}); }

double scalar(const Readings& readings) { return *static_cast<const double*>(readings.port("ft", "force")); }
const Eigen::VectorXd& vector(const Readings& readings) {
  return *static_cast<const Eigen::VectorXd*>(readings.port("ft", "wrench"));
}

TEST(Readings, StandBehindTheirPortsInOrder) {
  Readings readings = two();
  EXPECT_EQ(readings.size(), 5);
  Eigen::VectorXd numbers(5);
  numbers << 1, 2, 3, 4, 5;
  const void* address = readings.port("ft", "wrench");
  readings.take(numbers);
  EXPECT_EQ(readings.port("ft", "wrench"), address);
  EXPECT_EQ(scalar(readings), 1);
  EXPECT_EQ(vector(readings), Eigen::Vector3d(2, 3, 4));
  EXPECT_EQ(*static_cast<const Eigen::VectorXd*>(readings.port("skin", "taxels")), Eigen::VectorXd::Constant(1, 5));
}

TEST(Readings, OfNoSuchPortAreNull) {
  const Readings readings = two();
  EXPECT_EQ(readings.port("ft", "torque"), nullptr);
  EXPECT_EQ(readings.port("skin", "force"), nullptr);
}

TEST(Readings, WithoutANumberKeepTheLastOne) {
  Readings readings = two();
  Eigen::VectorXd numbers = Eigen::VectorXd::Constant(5, 2);
  readings.take(numbers);
  numbers << NAN, 3, NAN, INFINITY, 3;
  readings.take(numbers);
  EXPECT_EQ(scalar(readings), 2);
  EXPECT_EQ(vector(readings), Eigen::Vector3d(3, 2, 2));
  readings.take(Eigen::VectorXd());                                // a plant without sensors
  EXPECT_EQ(vector(readings), Eigen::Vector3d(3, 2, 2));
}

}  // namespace
}  // namespace tactus::control
