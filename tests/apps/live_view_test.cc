// What the live view shows of a run, line by line.

#include "apps/tactus/live_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/tactus/text.h"

namespace tactus::app {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

LiveState aState(size_t links) {
  LiveState state;
  state.time = 12.34;
  state.duration = 100;
  state.rate = 2.5;
  state.now.links = static_cast<int>(links);
  state.now.mean_N = 0.5;
  state.now.max_N = 1.25;
  state.now.undesired_max_N = 0.125;
  for (size_t i = 0; i < links; ++i) state.links.push_back({"link_" + std::to_string(i), i != 1, 0.5, 0.4, 1.25});
  return state;
}

TEST(LiveView, SaysHowFarTheRunIs) {
  LiveState state = aState(1);
  EXPECT_EQ(liveProgress(state), "12.3 of 100.0 s, 2.5 × real time, 0:35 left");
  EXPECT_EQ(liveForces(state), "1 link, mean 0.50, largest 1.25, undesired 0.12 N");
  state.rate = 0;
  EXPECT_EQ(liveProgress(state), "12.3 of 100.0 s");
  state.rate = 0.001;
  EXPECT_EQ(liveProgress(state), "12.3 of 100.0 s, 0.0 × real time, 24:21:00 left");
}

TEST(LiveView, ARowForEachLinkWithABarOfItsForce) {
  LiveState state = aState(2);
  state.links[1].force_N = 0;
  EXPECT_THAT(liveTable(state, 79, 23),
              ElementsAre("12.3 of 100.0 s, 2.5 × real time, 0:35 left",
                          "2 links, mean 0.50, largest 1.25, undesired 0.12 N",
                          "link (! undesired)          now (N)     mean  largest  0                    2 N",
                          "link_0                         0.50     0.40     1.25  ██████",
                          "! link_1                          –     0.40     1.25"));
}

TEST(LiveView, NothingHasTouchedYet) { EXPECT_THAT(liveTable(aState(0), 79, 23), SizeIs(2)); }

TEST(LiveView, FitsIntoAnyTerminal) {
  LiveState state = aState(40);
  state.links[3].name = std::string(60, 'x') + "ö";
  state.links[4].force_N = state.links[4].largest_N = 1e12;
  state.links[5].force_N = state.links[5].largest_N = INFINITY;
  state.now.max_N = 1e300;
  for (const size_t width : {1u, 10u, 40u, 79u, 200u})
    for (const size_t height : {0u, 1u, 2u, 3u, 5u, 23u, 60u}) {
      const std::vector<std::string> lines = liveTable(state, width, height);
      EXPECT_LE(lines.size(), height);
      for (const std::string& line : lines) EXPECT_LE(app::width(line), width) << line;
    }
  EXPECT_EQ(liveTable(state, 79, 23).back(), "and 21 more");
}

}  // namespace
}  // namespace tactus::app
