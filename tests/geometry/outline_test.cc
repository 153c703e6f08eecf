#include "framework/geometry/outline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tactus::geometry {
namespace {

using Eigen::Vector2d;
using testing::HasSubstr;
using Corners = std::vector<Vector2d>;

const Corners ell{{0, 0}, {0.3, 0}, {0.3, 0.1}, {0.1, 0.1}, {0.1, 0.3}, {0, 0.3}};

TEST(Outline, ByHandEitherWayRound) {
  Corners clockwise(ell.rbegin(), ell.rend());
  for (const Outline& outline : {Outline(ell), Outline(clockwise)}) {
    EXPECT_NEAR(outline.distance({0.2, 0.15}).distance, 0.05, 1e-16);
    EXPECT_NEAR(outline.distance({0.2, 0.06}).distance, -0.04, 1e-16);
    EXPECT_NEAR(outline.distance({0.05, 0.05}).distance, -0.05, 1e-16);
    EXPECT_NEAR(outline.distance({0.07, 0.06}).distance, -0.05, 1e-15);  // to the corner that points inwards
    EXPECT_LT((outline.distance({0.07, 0.06}).gradient - Vector2d(0.6, 0.8)).norm(), 1e-14);
    EXPECT_NEAR(outline.distance({0.33, -0.04}).distance, 0.05, 1e-15);
    EXPECT_EQ(outline.distance({0.3, 0}).distance, 0);
    EXPECT_NEAR(outline.distance({0.3, 0}).gradient.norm(), 1, 1e-15);
    EXPECT_FALSE(outline.isConvex());
  }
  EXPECT_TRUE(Outline({{0, 0}, {1, 0}, {1, 1}}).isConvex());
  EXPECT_TRUE(Outline({{0, 0}, {1, 0}, {2, 0}, {2, 1}}).isConvex()) << "corners of a straight edge";
  EXPECT_LT((Outline({{0, 0}, {3, 0}, {0, 3}}).centroid() - Vector2d(1, 1)).norm(), 1e-15);
}

TEST(Outline, OfARightHalfTheAxisIsNoBorder) {
  const Outline half = Outline::rightHalf({{0, 0}, {0.1, 0}, {0.1, 0.4}, {0, 0.4}});
  EXPECT_NEAR(half.distance({0, 0.2}).distance, -0.1, 1e-16);
  EXPECT_NEAR(half.distance({0, 0.45}).distance, 0.05, 1e-16);
  EXPECT_TRUE(half.isConvex());
  EXPECT_FALSE(Outline::rightHalf({{0.1, 0}, {0.2, 0}, {0.2, 0.1}}).isConvex()) << "a ring";
  // A tip on the axis: straight above it the whole's normal is the axis.
  const Outline tip = Outline::rightHalf({{0, 0}, {0.1, 0}, {0, 0.2}});
  EXPECT_NEAR(tip.distance({0, 0.25}).distance, 0.05, 1e-16);
  EXPECT_EQ(tip.distance({0, 0.25}).gradient, Vector2d(0, 1));
}

template <class Make>
std::string refusal(Make make) {
  try {
    make();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Outline, SaysWhatIsWrong) {
  const auto said = [](const Corners& corners) { return refusal([&] { Outline made(corners); }); };
  EXPECT_EQ(said({{0, 0}, {1, 0}}), "an outline has three corners or more, not 2");
  EXPECT_EQ(said({{0, 0}, {1, 0}, {NAN, 1}}), "the corners of an outline are finite");
  EXPECT_EQ(said({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), "corners 2 and 3 of the outline are the same");
  EXPECT_EQ(said({{0, 0}, {1, 0}, {0, 1}, {0, 0}}), "corners 4 and 1 of the outline are the same");
  EXPECT_EQ(said({{0, 0}, {2, 0}, {1, 0}, {1, 1}}), "the outline turns back on itself at corner 2");
  EXPECT_EQ(said({{0, 0}, {1, 1}, {1, 0}, {0, 1}}),
            "the outline meets itself: its edge between corners 1 and 2 and that between corners 3 and 4 have a point "
            "in common");
  EXPECT_THAT(said({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}), HasSubstr("meets itself"));  // touches an edge
  EXPECT_THAT(said({{0, 0}, {1, 0}, {2, 0}}), HasSubstr("turns back"));                    // no area
  EXPECT_EQ(refusal([] { Outline::rightHalf({{-0.1, 0}, {1, 0}, {1, 1}}); }),
            "corner 1 of the outline lies across the axis");
  EXPECT_EQ(said(ell), "accepted");
}

}  // namespace
}  // namespace tactus::geometry
