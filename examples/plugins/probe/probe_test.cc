#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "conformance/bench.h"
#include "conformance/conformance.h"
#include "lens.h"

namespace {

using probe::Lens;

// The lens stands for all points that lie in both balls, and on its surface as far as the distance says.
TEST(Lens, IsWhatTwoBallsHaveInCommon) {
  const double a = 0.1, t = 0.03, R = (a * a + t * t / 4) / t, c = R - t / 2;
  const Lens lens(a, t);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> along(-0.15, 0.15);
  for (int k = 0; k < 2000; ++k) {
    const Eigen::Vector3d p(along(random), along(random), 0.3 * along(random));
    const Eigen::Vector3d centre(0, 0, c);
    const double outside = std::max((p - centre).norm(), (p + centre).norm()) - R;
    EXPECT_EQ(lens.distance(p).distance < 0, outside < 0);
    const auto nearest = lens.distance(p);
    const Eigen::Vector3d foot = p - nearest.distance * nearest.gradient;
    EXPECT_NEAR(std::max((foot - centre).norm(), (foot + centre).norm()), R, 1e-12);
  }
}

TEST(Lens, EndsAtItsRimAndItsThickness) {
  const Lens lens(0.1, 0.03);
  EXPECT_NEAR(lens.distance({0, 0, 0.02}).distance, 0.005, 1e-15);
  EXPECT_NEAR(lens.distance({0.13, 0, 0.04}).distance, 0.05, 1e-15);  // 3, 4, 5 from the rim
  EXPECT_THROW(Lens(0.1, 0.21), std::invalid_argument);
}

TEST(Plugin, KeepsTheLaws) {
  const auto report = tactus::conformance::checkPlugin(PLUGIN, STACK);
  EXPECT_TRUE(report.conforms()) << report.text();
}

}  // namespace
