// The controller that closes fingers by positions: which joint goes when, and what stops it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/bench.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/temporary_folder.h"

namespace tactus::plugins {
namespace {

/// A hand in mid-air, and contacts that the test puts on its links.
class EncloseTest : public ::testing::TestWithParam<const char*> {
 protected:
  conformance::Bench& bench() {
    if (!bench_) {
      const std::string file = folder_.path + "/stack.xml";
      runtime::writeFile(file, R"(<stack format="1" name="close"><robot model="lwr_allegro">
        <start q="-0.227 -0.535 0.027 1.783 0.120 -0.485 -0.302  0 0.2 0.2 0.2  0 0.2 0.2 0.2  0 0.2 0.2 0.2  0.3 0.1 0.1 0.1"/></robot>
        <signals><contacts name="touch" desired="fingers" hold="0"/></signals>
        <level priority="1"><enclose name="grip" on="touch.all" order=")" + std::string(GetParam()) + R"(" speed="1" threshold="0.2"
          to="0.5" joints="index_proximal index_medial index_distal"/></level>
        <controller backend="null-space"/></stack>)");
      bench_ = std::make_unique<conformance::Bench>(file, std::vector<std::string>{});
    }
    return *bench_;
  }
  void touch(const char* link, double force) {
    bench().sense();
    control::ContactRecord contact;
    contact.link = bench().robot().model().frameIndex(link);
    contact.object = 0;
    contact.point_W = bench().robot().framePose(contact.link).translation();
    contact.normal_W = -Eigen::Vector3d::UnitZ();
    contact.force_N = force;
    bench().sensed.contacts = {contact};
  }
  void tick(int ticks) {
    for (int k = 0; k < ticks; ++k) bench().tick();
  }
  /// How far each joint's reference has gone: the joints stay where they are, so each row pulls with k times that.
  Eigen::Vector3d gone() { return bench().rows("grip.close").force.head<3>() - speeds() * 0.02; }
  Eigen::Vector3d speeds() const { return speeds_; }
  Eigen::Vector3d speeds_ = Eigen::Vector3d::Zero();               // 1 rad/s of a joint on its way, damped with 0.02

 private:
  runtime::TemporaryFolder folder_;
  std::unique_ptr<conformance::Bench> bench_;
};

class Successive : public EncloseTest {};
class Together : public EncloseTest {};

TEST_P(Successive, OneJointAfterTheOther) {
  tick(100);
  speeds_ << 1, 0, 0;
  EXPECT_LT((gone() - Eigen::Vector3d(0.1, 0, 0)).norm(), 1e-9);
  touch("index_distal", 0.1);                                      // too light to stop it
  tick(50);
  EXPECT_LT((gone() - Eigen::Vector3d(0.15, 0, 0)).norm(), 1e-9);
  touch("index_proximal", 0.3);
  tick(101);
  speeds_ << 0, 1, 0;
  EXPECT_LT((gone() - Eigen::Vector3d(0.15, 0.101, 0)).norm(), 2e-3) << "the first stops, the second goes";
  touch("index_distal", 0.3);
  tick(10);
  speeds_.setZero();
  EXPECT_LT((gone() - Eigen::Vector3d(0.15, 0.101, 0)).norm(), 2e-3) << "a touch beyond stops all that lies before it";
}

TEST_P(Together, AllJointsAtOnceUntilATouchBeyond) {
  tick(100);
  speeds_ << 1, 1, 1;
  EXPECT_LT((gone() - Eigen::Vector3d(0.1, 0.1, 0.1)).norm(), 1e-9);
  touch("index_medial", 0.3);
  tick(100);
  speeds_ << 0, 0, 1;
  EXPECT_LT((gone() - Eigen::Vector3d(0.1, 0.1, 0.2)).norm(), 2e-3) << "the tip goes on";
  bench().sensed.contacts.clear();
  tick(300);
  speeds_.setZero();
  EXPECT_LT((gone() - Eigen::Vector3d(0.1, 0.1, 0.3)).norm(), 2e-3) << "stopped for good, or arrived";
}

INSTANTIATE_TEST_SUITE_P(Enclose, Successive, ::testing::Values("successive"));
INSTANTIATE_TEST_SUITE_P(Enclose, Together, ::testing::Values("together"));

}  // namespace
}  // namespace tactus::plugins
