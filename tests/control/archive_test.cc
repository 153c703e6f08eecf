// The archive: what goes in comes out, to the bit, and what does not fit is said.

#include "framework/control/archive.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "framework/control/contact_set.h"
#include "framework/control/random.h"
#include "framework/control/sensed.h"

namespace tactus::control {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

enum class Mode { slow, fast };

struct Inner {
  int count = 0;
  void archive(Archive& archive) { archive("count", count); }
};

/// One of everything.
struct Part {
  double real = 0;
  bool flag = false;
  Mode mode = Mode::slow;
  std::uint64_t bits = 0;
  std::string text;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2, 3);
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::optional<double> maybe, never;
  std::vector<double> list = std::vector<double>(3);
  std::vector<bool> flags = std::vector<bool>(2);
  std::vector<Eigen::Vector3d> points = std::vector<Eigen::Vector3d>(2, Eigen::Vector3d::Zero());
  std::vector<Inner> parts = std::vector<Inner>(2);
  std::vector<Inner> growing;
  double array[2] = {0, 0};
  SplitMix64 random{1};

  void archive(Archive& archive) {
    archive("real", real);
    archive("flag", flag);
    archive("mode", mode);
    archive("bits", bits);
    archive("text", text);
    archive("vector", vector);
    archive("matrix", matrix);
    archive("turn", turn);
    archive("pose", pose);
    archive("maybe", maybe);
    archive("never", never);
    archive("list", list);
    archive("flags", flags);
    archive("points", points);
    archive("parts", parts);
    archive.growing("growing", growing);
    archive("array", array);
    archive("random", random);
  }
};

Part filled() {
  Part part;
  part.real = 0.1 + 0.2;
  part.flag = true;
  part.mode = Mode::fast;
  part.bits = 0xFEDCBA9876543210u;
  part.text = "a \"b\"\n";
  part.vector << 1, -0.0, 1e-310;
  part.matrix << 1, 2, 3, 4, 5, 6;
  part.turn = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  part.pose.translation() << 1, 2, 3;
  part.maybe = 7;
  part.list = {1, std::nan(""), std::numeric_limits<double>::infinity()};
  part.flags = {false, true};
  part.points[1] << 4, 5, 6;
  part.parts[1].count = 9;
  part.growing = {{3}, {4}, {5}};
  part.array[1] = 2.5;
  part.random.next();
  return part;
}

template <class T>
State saved(T& value) {
  State state;
  Archive archive = Archive::saving(state);
  archive("it", value);
  return state;
}

template <class T>
std::vector<std::string> restore(const State& state, T& value) {
  Archive archive = Archive::restoring(state);
  archive("it", value);
  return archive.missing();
}

template <class T>
std::string refusal(const State& state, T& value) {
  try {
    restore(state, value);
  } catch (const StateError& error) {
    return error.what();
  }
  return "";
}

TEST(Archive, WhatGoesInComesOut) {
  Part whole = filled(), other;
  other.maybe.reset();
  other.never = 3;
  const State state = saved(whole);
  EXPECT_THAT(restore(state, other), IsEmpty());
  EXPECT_EQ(other.real, whole.real);
  EXPECT_TRUE(other.flag);
  EXPECT_EQ(other.mode, Mode::fast);
  EXPECT_EQ(other.bits, whole.bits);
  EXPECT_EQ(other.text, whole.text);
  EXPECT_EQ(other.vector, whole.vector);
  EXPECT_TRUE(std::signbit(other.vector.y()));
  EXPECT_EQ(other.matrix, whole.matrix);
  EXPECT_EQ(other.turn.coeffs(), whole.turn.coeffs());
  EXPECT_EQ(other.pose.matrix(), whole.pose.matrix());
  EXPECT_EQ(other.maybe, 7);
  EXPECT_FALSE(other.never);
  EXPECT_TRUE(std::isnan(other.list[1]));
  EXPECT_TRUE(std::isinf(other.list[2]));
  EXPECT_THAT(other.flags, ElementsAre(false, true));
  EXPECT_EQ(other.points[1], whole.points[1]);
  EXPECT_EQ(other.parts[1].count, 9);
  ASSERT_EQ(other.growing.size(), 3u);
  EXPECT_EQ(other.growing[2].count, 5);
  EXPECT_EQ(other.array[1], 2.5);
  EXPECT_EQ(other.random.next(), whole.random.next());
}

TEST(Archive, TouchedPointsAndRecordsToo) {
  TouchedPoints points, other;
  points.points.push_back({0.5, 3, {1, 2, 3}, {0, 0, -1}, 0.7});
  other.points.resize(4);
  restore(saved(points), other);
  ASSERT_EQ(other.points.size(), 1u);
  EXPECT_EQ(other.points[0].frame, 3);
  EXPECT_EQ(other.points[0].point_W.z(), 3);
  EXPECT_EQ(other.points[0].force_N, 0.7);

  ContactRecord record, same;
  record.link = 4;
  record.friction_W << 0, 1, 0;
  restore(saved(record), same);
  EXPECT_EQ(same.link, 4);
  EXPECT_EQ(same.friction_W, record.friction_W);
}

TEST(Archive, AVectorKeepsItsLength) {
  std::vector<double> three(3), four(4);
  EXPECT_EQ(refusal(saved(three), four), "state 'it' has 3 numbers, and this stack needs 4");
  Eigen::VectorXd five = Eigen::VectorXd::Zero(5), one = Eigen::VectorXd::Zero(1);
  EXPECT_EQ(refusal(saved(one), five), "state 'it' has 1 number, and this stack needs 5");
  std::vector<Inner> two(2), none;
  EXPECT_THAT(refusal(saved(two), none), HasSubstr("'it/size' has 2 numbers, and this stack needs 0"));
}

TEST(Archive, OtherTypesAreRefused) {
  std::string text = "x";
  double real = 0;
  int whole = 0;
  EXPECT_THAT(refusal(saved(text), real), HasSubstr("'it' is a text"));
  EXPECT_THAT(refusal(saved(real), whole), HasSubstr("needs whole numbers"));
  EXPECT_THAT(refusal(saved(real), text), HasSubstr("needs a text"));
  whole = 5;                                                       // a whole number is a real one, too
  restore(saved(whole), real);
  EXPECT_EQ(real, 5);
}

TEST(Archive, AnIndexStaysInItsRange) {
  int index = 1;
  for (const std::int64_t wrong : {-1, 3}) {
    const State state{{"it", std::vector<std::int64_t>{wrong}}};
    Archive archive = Archive::restoring(state);
    try {
      archive.whole("it", index, 0, 2);
      ADD_FAILURE();
    } catch (const StateError& error) {
      EXPECT_EQ(error.what(), "state 'it' is " + std::to_string(wrong) + ", and must be from 0 to 2");
    }
  }
  EXPECT_EQ(index, 1);
}

TEST(Archive, AnAbsurdSizeIsRefused) {
  std::vector<double> list;
  const State state{{"it/size", std::vector<std::int64_t>{std::numeric_limits<std::int64_t>::max()}},
                    {"it/values", std::vector<double>{}}};
  Archive archive = Archive::restoring(state);
  EXPECT_THROW(archive.growing("it", list), StateError);
  const State negative{{"it/size", std::vector<std::int64_t>{-1}}};
  Archive again = Archive::restoring(negative);
  EXPECT_THROW(again.growing("it", list), StateError);
}

TEST(Archive, WhatIsMissingStaysAndIsTold) {
  double real = 3;
  std::vector<double> list{1, 2};
  const State state{{"other", std::vector<double>{5}}};
  Archive archive = Archive::restoring(state);
  archive("real", real);
  archive.growing("list", list);
  EXPECT_EQ(real, 3);
  EXPECT_THAT(list, ElementsAre(1, 2));
  EXPECT_THAT(archive.missing(), ElementsAre("real", "list/size"));
  EXPECT_THAT(archive.unclaimed(), ElementsAre("other"));
  EXPECT_THAT(archive.unclaimed("real"), IsEmpty());
}

}  // namespace
}  // namespace tactus::control
