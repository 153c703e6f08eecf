// Taxels by themselves: where they lie, what contacts do to them, what is read out of them.
//
// Strategy: laws over random contacts on capsules, balls and boxes; Hertz's spread against its formula.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "framework/control/registry.h"
#include "plugins/senses/skin.h"
#include "plugins/senses/taxel_patch.h"

namespace tactus::plugins {
namespace {

using std::numbers::pi;

constexpr double kSpread = 0.0015, kAdjacency = 1.6;

description::Link link(const description::LinkShape& shape) {
  description::Link link;
  link.name = "it";
  link.shapes = {shape};
  return link;
}
description::Link capsule() { return link(description::CapsuleShape{{0.01, 0, 0}, {0.11, 0, 0}, 0.01}); }
description::Link ball() { return link(description::CapsuleShape{{0, 0.01, 0}, {0, 0.01, 0}, 0.015}); }
description::Link box() {
  description::BoxShape shape;
  shape.pose = Eigen::Translation3d(0, 0, 0.1) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY());
  shape.size = {0.1, 0.06, 0.04};
  return link(shape);
}

Layout layout(std::map<std::string, std::string> attributes = {}, int links = 1) {
  control::Registry registry;
  Skin::registerIn(registry);
  attributes["name"] = "skin";
  attributes["links"] = "it";
  return Layout(control::makeValues(*registry.elements().find("skin"), attributes), links);
}

TaxelPatch patch(const description::Link& on, const std::map<std::string, std::string>& attributes = {},
                 double spread = kSpread) {
  return TaxelPatch(on, layout(attributes).plan(on), spread, kAdjacency);
}

class Random {
 public:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  /// A place on the surface, anywhere.
  SurfacePoint place(const description::Link& on) {
    const std::vector<SurfaceCell> cells = Surface(on).cells(0.001);
    const SurfaceCell& cell = cells[static_cast<std::size_t>(uniform(0, static_cast<double>(cells.size()) - 1e-9))];
    Eigen::Vector3d near = cell.position_L;
    for (double& x : near) x += uniform(-5e-4, 5e-4);
    return Surface(on).nearest(near);
  }

 private:
  std::mt19937 random_{1};
};

TEST(Surface, HasTheAreaOfItsShape) {
  const auto area = [](const description::Link& on, double pitch) {
    double sum = 0;
    for (const SurfaceCell& cell : Surface(on).cells(pitch)) sum += cell.area;
    return sum;
  };
  for (const double pitch : {0.004, 0.0013}) {
    EXPECT_NEAR(area(capsule(), pitch), 2 * pi * 0.01 * 0.1 + 4 * pi * 1e-4, 1e-12);
    EXPECT_NEAR(area(ball(), pitch), 4 * pi * 0.015 * 0.015, 1e-12);
    EXPECT_NEAR(area(box(), pitch), 2 * (0.1 * 0.06 + 0.1 * 0.04 + 0.06 * 0.04), 1e-12);
  }
}

TEST(Surface, CellsLieOnItAndFaceOutwards) {
  for (const description::Link& on : {capsule(), ball(), box()})
    for (const SurfaceCell& cell : Surface(on).cells(0.003)) {
      const SurfacePoint nearest = Surface(on).nearest(cell.position_L + 1e-5 * cell.normal_L);
      EXPECT_LT((nearest.position_L - cell.position_L).norm(), 1e-12);
      EXPECT_GT(nearest.normal_L.dot(cell.normal_L), 1 - 1e-9);
    }
}

TEST(Taxels, OfAGridFeelAllOfAContactTogether) {
  Random random;
  for (const description::Link& on : {capsule(), ball(), box()}) {
    TaxelPatch taxels = patch(on);
    for (int k = 0; k < 300; ++k) {
      Eigen::VectorXd forces = Eigen::VectorXd::Zero(taxels.count());
      const double force = random.uniform(0.05, 5);
      taxels.press(random.place(on).position_L, force, random.uniform(0, 1e-3), forces);
      EXPECT_NEAR(forces.sum(), force, 1e-12 * force);
      EXPECT_GE(forces.minCoeff(), 0);
    }
  }
}

TEST(Taxels, FeelTheSameWhateverElsePresses) {
  Random random;
  TaxelPatch taxels = patch(capsule());
  const Eigen::Vector3d a = random.place(capsule()).position_L, b = random.place(capsule()).position_L;
  Eigen::VectorXd both = Eigen::VectorXd::Zero(taxels.count()), first = both, second = both;
  taxels.press(a, 1, 2e-4, first);
  taxels.press(b, 2, 4e-4, second);
  taxels.press(b, 2, 4e-4, both);
  taxels.press(a, 1, 2e-4, both);
  EXPECT_LT((both - first - second).norm(), 1e-12);
}

TEST(Taxels, TellTheCoveredShareAtTheEdge) {
  TaxelPatch taxels = patch(capsule(), {{"facing", "0 0 1"}});
  const auto felt = [&](double angle) {
    Eigen::VectorXd forces = Eigen::VectorXd::Zero(taxels.count());
    taxels.press({0.06, 0.01 * std::sin(angle), 0.01 * std::cos(angle)}, 1, 1e-4, forces);
    return forces.sum();
  };
  EXPECT_NEAR(felt(0), 1, 1e-12);
  EXPECT_NEAR(felt(pi / 2), 0.5, 0.05);
  EXPECT_EQ(felt(pi), 0);
  double last = 1 + 1e-12;
  for (double angle = 0; angle < pi; angle += 0.2) {
    EXPECT_LE(felt(angle), last + 1e-9);
    last = felt(angle);
  }
}

// Of the Gaussian cut at 3σ the variance is σ² (1 − 4.5 e^−4.5/(1 − e^−4.5)) along each axis.
TEST(Taxels, SpreadAPressureAsHertzAndTheCoverDo) {
  description::BoxShape shape;
  shape.size = {0.04, 0.05, 0.04};
  const description::Link on = link(shape);
  const double depth = 4e-4, radius = Surface(on).radiusNear({0, 0, 0.02});
  TaxelPatch taxels = patch(on, {{"pitch", "0.001"}, {"facing", "0 0 1"}, {"arc", "0.1"}}, 0.002);
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(taxels.count());
  taxels.press({0.003, 0.002, 0.02}, 1, depth, forces);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), square = Eigen::Vector3d::Zero();
  for (int i = 0; i < taxels.count(); ++i) {
    const Eigen::Vector3d& p = taxels.taxels()[static_cast<std::size_t>(i)].position_L;
    mean += forces[i] * p;
    square += forces[i] * p.cwiseAbs2();
  }
  const double variance = 0.002 * 0.002 + radius * depth / 5, tail = std::exp(-4.5);
  EXPECT_NEAR(mean.x(), 0.003, 1e-5);
  EXPECT_NEAR(mean.y(), 0.002, 1e-5);
  EXPECT_NEAR(square.x() - mean.x() * mean.x(), variance * (1 - 4.5 * tail / (1 - tail)), 0.02 * variance);
}

std::vector<TaxelContact> read(TaxelPatch& taxels, const Eigen::VectorXd& forces, int min_taxels = 1,
                               double min_force = 0) {
  std::vector<TaxelContact> contacts;
  taxels.read(forces, min_taxels, min_force, contacts);
  return contacts;
}

TEST(Contacts, OfOneTouchAreOneNearerThanHalfAPitch) {
  Random random;
  for (const description::Link& on : {capsule(), ball()}) {
    TaxelPatch taxels = patch(on);
    double worst = 0, worst_angle = 0, sum = 0;
    for (int k = 0; k < 1000; ++k) {
      const SurfacePoint place = random.place(on);
      Eigen::VectorXd forces = Eigen::VectorXd::Zero(taxels.count());
      taxels.press(place.position_L, 0.5, 2.5e-4, forces);
      const auto contacts = read(taxels, forces);
      ASSERT_EQ(contacts.size(), 1u);
      EXPECT_NEAR(contacts[0].force_N, 0.5, 1e-12);
      const double error = (contacts[0].place.position_L - place.position_L).norm();
      worst = std::max(worst, error);
      const double along = contacts[0].place.normal_L.dot(place.normal_L);
      worst_angle = std::max(worst_angle, std::acos(std::min(1.0, along)));
      sum += error;
    }
    EXPECT_LT(worst, 0.5 * taxels.pitch());
    EXPECT_LT(worst_angle, 0.5 * taxels.pitch() / 0.01);
    std::printf("position error: mean %.2f mm, worst %.2f mm; of the normal: worst %.2f rad\n", sum, 1e3 * worst,
                worst_angle);
  }
}

TEST(Contacts, FartherApartThanTheirFootprintsAreTwo) {
  Random random;
  const description::Link on = capsule();
  TaxelPatch taxels = patch(on);
  const double depth = 2.5e-4, sigma = std::sqrt(kSpread * kSpread + 0.01 * depth / 5);
  const double apart = 6 * sigma + (kAdjacency + 1.6) * taxels.pitch();
  int pairs = 0;
  for (int k = 0; k < 1000; ++k) {
    const SurfacePoint a = random.place(on), b = random.place(on);
    if ((a.position_L - b.position_L).norm() < apart) continue;
    ++pairs;
    Eigen::VectorXd forces = Eigen::VectorXd::Zero(taxels.count());
    taxels.press(a.position_L, 1, depth, forces);
    taxels.press(b.position_L, 2, depth, forces);
    const auto contacts = read(taxels, forces);
    ASSERT_EQ(contacts.size(), 2u);
    const bool swapped = contacts[0].force_N > 1.5;
    EXPECT_LT((contacts[swapped].place.position_L - a.position_L).norm(), 0.5 * taxels.pitch());
    EXPECT_LT((contacts[!swapped].place.position_L - b.position_L).norm(), 0.5 * taxels.pitch());
    EXPECT_NEAR(contacts[swapped].force_N, 1, 1e-9);
  }
  EXPECT_GT(pairs, 300);
}

TEST(Contacts, AsNearAsAPitchAreOne) {
  TaxelPatch taxels = patch(capsule());
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(taxels.count());
  taxels.press({0.05, 0, 0.01}, 1, 1e-4, forces);
  taxels.press({0.054, 0, 0.01}, 1, 1e-4, forces);
  const auto contacts = read(taxels, forces);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].force_N, 2, 1e-12);
  EXPECT_NEAR(contacts[0].place.position_L.x(), 0.052, 0.001);
}

TEST(Contacts, OfTooFewTaxelsOrTooWeakAreNone) {
  TaxelPatch taxels = patch(capsule());
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(taxels.count());
  forces[7] = 0.3;
  EXPECT_EQ(read(taxels, forces).size(), 1u);
  EXPECT_EQ(read(taxels, forces, 2).size(), 0u);
  EXPECT_EQ(read(taxels, forces, 1, 0.31).size(), 0u);
}

double areaOf(const TaxelPlan& plan, const Taxel& taxel) {
  double sum = 0;
  for (const int cell : taxel.cells) sum += plan.cells[static_cast<std::size_t>(cell)].area;
  return sum;
}

TEST(Layouts, TekscanIsAGridOfFourMillimetres) {
  const TaxelPlan plan = layout().plan(capsule());
  double area = 0;
  for (const Taxel& taxel : plan.taxels) {
    EXPECT_NEAR(areaOf(plan, taxel), 16e-6, 8e-6);
    area += areaOf(plan, taxel);
  }
  EXPECT_NEAR(area, 2 * pi * 0.01 * 0.1 + 4 * pi * 1e-4, 1e-12);
}

TEST(Layouts, AFingertipHasTwelveTaxelsOfAboutOneSizeOnItsEnd) {
  const TaxelPlan plan = layout({{"layout", "icub-fingertip"}}).plan(capsule());
  ASSERT_EQ(plan.taxels.size(), 12u);
  double area = 0;
  for (const Taxel& taxel : plan.taxels) {
    EXPECT_GT(taxel.position_L.x(), 0.11);
    EXPECT_NEAR(areaOf(plan, taxel), 2 * pi * 1e-4 / 12, 0.4 * 2 * pi * 1e-4 / 12);
    area += areaOf(plan, taxel);
  }
  EXPECT_NEAR(area, 2 * pi * 1e-4, 0.06 * 2 * pi * 1e-4);
}

TEST(Layouts, SixNodesAreSharedByTheLinks) {
  const std::map<std::string, std::string> nodes = {{"layout", "six-node"}, {"facing", "0 0 -1"}};
  EXPECT_EQ(layout(nodes, 1).plan(capsule()).taxels.size(), 6u);
  const TaxelPlan plan = layout(nodes, 3).plan(capsule());
  ASSERT_EQ(plan.taxels.size(), 2u);
  EXPECT_LT((plan.taxels[0].position_L - Eigen::Vector3d(0.035, 0, -0.01)).norm(), 1e-12);
  EXPECT_LT((plan.taxels[1].position_L - Eigen::Vector3d(0.085, 0, -0.01)).norm(), 1e-12);
  for (const Taxel& taxel : plan.taxels) EXPECT_NEAR(areaOf(plan, taxel), 45e-6, 10e-6);
  EXPECT_THROW(layout(nodes, 4), control::ElementError);
  EXPECT_THROW(layout({{"layout", "six-node"}}), control::ElementError);
}

TEST(Layouts, CountsAndPositions) {
  const TaxelPlan counted = layout({{"counts", "3 4"}, {"facing", "0 1 0"}, {"arc", "0.8"}}).plan(capsule());
  ASSERT_EQ(counted.taxels.size(), 12u);
  for (const Taxel& taxel : counted.taxels) {
    EXPECT_GT(taxel.normal_L.y(), std::cos(0.8));
    EXPECT_NEAR(areaOf(counted, taxel), 0.1 * 1.6 * 0.01 / 12, 0.15 * 0.1 * 1.6 * 0.01 / 12);
  }
  EXPECT_THROW(layout({{"counts", "3 4"}}).plan(ball()), control::ElementError);
  EXPECT_THROW(layout({{"counts", "3.5 4"}}), control::ElementError);
  const TaxelPlan placed = layout({{"positions", "0.05 0 0.02; 0.06 0.02 0"}, {"pitch", "0.006"}}).plan(capsule());
  ASSERT_EQ(placed.taxels.size(), 2u);
  EXPECT_LT((placed.taxels[0].position_L - Eigen::Vector3d(0.05, 0, 0.01)).norm(), 1e-12);
  EXPECT_NEAR(areaOf(placed, placed.taxels[0]), pi * 9e-6, 4e-6);
}

}  // namespace
}  // namespace tactus::plugins
