// A free can of 0.3 kg in the hand while the arm waves: it stays where it was in the palm, and friction is what holds
// it.
//
// Slip is how far the can's middle, and a point of its rim, move in the palm's frame between the first wave and the end
// of the run, at every row of the log; joints and the can's pose are those of the plant, kinematics the framework's
// own.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "dsl/read_robot.h"
#include "framework/dynamics/kinematics.h"
#include "framework/runtime/csv_table.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using Eigen::Vector3d;
using runtime::CsvTable;

const std::string kStack = TACTUS_SOURCE_DIR "/examples/hold_a_can/stack.xml";
constexpr double kLetGo = 1, kWaves = 2;                           // s

struct Hold {
  double slip = 0;                                                 ///< m, the largest
  double way = 0;                                                  ///< m, of the palm
  double speed = 0;                                                ///< m/s, of the palm, the largest
  double lowest_N = 1e9, highest_N = 0;                            ///< of the largest force of a finger link
  double palm_N = 0;                                               ///< of the palm, the largest
  int contacts = 1000;                                             ///< desired ones, the fewest
};

/// The log of a run while the arm waves.
Hold measure(const std::string& log_file) {
  std::vector<dsl::Diagnostic> warnings;
  const description::Robot robot = dsl::readRobot(TACTUS_SOURCE_DIR "/models/lwr_allegro.urdf", warnings);
  const dynamics::Model model(robot);
  dynamics::Workspace workspace(model);
  const int palm = robot.linkIndex("palm");
  const CsvTable log = CsvTable::read(log_file);
  const auto column = [&](const std::string& name) { return log.numbers(log.column(name)); };
  const std::vector<double> time = column("time"), contacts = column("contact/contacts"),
                            force = column("contact/max_N"), palm_force = column("contact/undesired_max_N");
  std::vector<std::vector<double>> q, can;
  for (const std::string& joint : model.jointNames()) q.push_back(column("q/" + joint));
  for (const char* part : {"x", "y", "z", "qw", "qx", "qy", "qz"})
    can.push_back(column(std::string("object/can/") + part));

  Hold hold;
  Vector3d middle_first = Vector3d::Zero(), rim_first = middle_first, palm_last = middle_first;
  bool begun = false;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] < kWaves) continue;
    Eigen::VectorXd joints(static_cast<Eigen::Index>(q.size()));
    for (std::size_t j = 0; j < q.size(); ++j) joints[static_cast<Eigen::Index>(j)] = q[j][i];
    dynamics::forwardKinematics(model, joints, workspace);
    const Eigen::Isometry3d X_WP = dynamics::framePose(model, workspace, palm);
    const Vector3d p(can[0][i], can[1][i], can[2][i]);
    const Eigen::Quaterniond R(can[3][i], can[4][i], can[5][i], can[6][i]);
    const Vector3d middle = X_WP.inverse() * p, rim = X_WP.inverse() * (p + R * Vector3d(0.03, 0, 0.06));
    if (!begun) {
      middle_first = middle;
      rim_first = rim;
    } else {
      const double step = (X_WP.translation() - palm_last).norm();
      hold.way += step;
      hold.speed = std::max(hold.speed, step / (time[i] - time[i - 1]));
    }
    begun = true;
    palm_last = X_WP.translation();
    hold.slip = std::max({hold.slip, (middle - middle_first).norm(), (rim - rim_first).norm()});
    hold.lowest_N = std::min(hold.lowest_N, force[i]);
    hold.highest_N = std::max(hold.highest_N, force[i]);
    hold.palm_N = std::max(hold.palm_N, palm_force[i]);
    hold.contacts = std::min(hold.contacts, static_cast<int>(contacts[i]));
  }
  return hold;
}

Hold run(const TemporaryFolder& folder, const std::string& stack, const std::string& grip = "0.3") {
  const Outcome outcome = tactus({"run", stack, "--set", "grip=" + grip, "--out", folder.file("run")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return measure(folder.file("run/log.csv"));
}

TEST(HoldACan, WhileTheArmWavesItSlipsLessThanAMillimetre) {
  const TemporaryFolder folder;
  const Hold hold = run(folder, kStack);
  std::cout << "slip " << 1e3 * hold.slip << " mm while the palm moves " << hold.way << " m at up to " << hold.speed
            << " m/s; largest force of a finger link " << hold.lowest_N << " to " << hold.highest_N
            << " N, of the palm " << hold.palm_N << " N; at least " << hold.contacts
            << " links of fingers and thumb touch\n";
  EXPECT_LT(hold.slip, 1e-3);
  EXPECT_GT(hold.way, 0.7) << "m: it does wave";
  EXPECT_GT(hold.speed, 0.3);
  EXPECT_GE(hold.contacts, 4);
  EXPECT_GT(hold.lowest_N, 0.3);
  EXPECT_LT(hold.highest_N, 6) << "a light grasp";
  EXPECT_LT(hold.palm_N, 6);
}

TEST(HoldACan, FirmerFingersLetItSlipLess) {
  const TemporaryFolder folder;
  const Hold light = run(folder, kStack), firm = run(folder, kStack, "1");
  std::cout << "grip 1 N m/rad: slip " << 1e3 * firm.slip << " mm, fingers " << firm.highest_N << " N, palm "
            << firm.palm_N << " N\n";
  EXPECT_LT(firm.slip, 0.7 * light.slip);
  EXPECT_GT(firm.palm_N, 2 * light.palm_N);
}

/// The same grasp on a can as smooth as ice: it is friction that holds.
TEST(HoldACan, WithoutFrictionItIsLost) {
  const TemporaryFolder folder;
  std::string text = contentOf(kStack);
  const std::string friction = R"(friction="0.5")";
  ASSERT_NE(text.find(friction), std::string::npos);
  text.replace(text.find(friction), friction.size(), R"(friction="0.02")");
  EXPECT_GT(run(folder, folder.write("stack.xml", text)).slip, 0.1);
}

/// Before it lets go, what holds the can bears it; after that nothing does but the hand: opened, it drops the can.
TEST(HoldACan, ItIsLetGoAtItsTime) {
  const TemporaryFolder folder;
  std::string text = contentOf(kStack);
  for (const std::string task : {"close", "oppose"}) {
    const std::string whole = "name=\"" + task + "\"";
    ASSERT_NE(text.find(whole), std::string::npos);
    text.replace(text.find(whole), whole.size(), whole + " active=\"false\"");
  }
  ASSERT_EQ(
      tactus({"run", folder.write("stack.xml", text), "--duration", "1.5", "--out", folder.file("run")}).exit_code, 0);
  const CsvTable log = CsvTable::read(folder.file("run/log.csv"));
  const std::vector<double> time = log.numbers("time"), z = log.numbers("object/can/z");
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] <= 0.5 || time[i] > kLetGo) continue;
    EXPECT_NEAR(z[i], 0.5 - 0.3 * 9.81 / 500, 1e-3) << time[i];
  }
  EXPECT_LT(z.back(), 0.5 - 0.5 * 9.81 * 0.4 * 0.4);
}

}  // namespace
}  // namespace tactus::testing
