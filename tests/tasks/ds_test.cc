// The energy claims of the passive DS (Kronander & Billard 2016), on a point mass that the task's force drives.
//
// Strategy: the task runs on a robot of three sliders, so that the controlled point is a mass of 1 kg and W = kinetic
// energy + λ₁ V + s can be followed exactly.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

description::Robot pointMass() {
  description::Robot robot;
  robot.name = "point";
  const char* const names[] = {"base", "x", "y", "z"};
  for (int i = 0; i < 4; ++i) {
    description::Link link;
    link.name = names[i];
    link.has_inertial = i > 0;
    link.mass = i == 3 ? 1.0 : 0.0;
    if (i > 0) link.inertia = Eigen::Matrix3d::Identity() * (i == 3 ? 1e-3 : 0.0);
    robot.links.push_back(link);
  }
  // Massless intermediate sliders are no bodies of their own: all mass sits on the last one.
  for (int i = 0; i < 3; ++i) {
    description::Joint joint;
    joint.name = std::string("slide_") + names[i + 1];
    joint.type = description::JointType::prismatic;
    joint.parent = i;
    joint.child = i + 1;
    joint.axis = Eigen::Vector3d::Unit(i);
    robot.joints.push_back(joint);
  }
  return robot;
}

class PassiveDs {
 public:
  explicit PassiveDs(const std::string& matrix, double tank = 0.5, double lambda = 10)
      : lambda_(lambda), robot_(pointMass()), model_(robot_, dynamics::MassPolicy::kinematics_only), cache_(model_) {
    tasks::registerBuiltIns(registry_);
    std::ostringstream tank_text;
    tank_text << tank;
    values_ = control::makeValues(*registry_.elements().find("ds"),
                                  {{"name", "field"}, {"frame", "z"}, {"target", "0 0 0"}, {"matrix", matrix},
                                   {"damping-along", std::to_string(lambda)}, {"damping-across", std::to_string(lambda)},
                                   {"tank", tank_text.str()}, {"tank-max", "1"}});
    const control::BuildContext context(values_, robot_, model_, dt,
                                        [](const std::string&, const std::string&, const std::string&) -> const void* {
                                          return nullptr;
                                        });
    task_ = registry_.makeTask(context);
    std::vector<control::LogColumn> columns;
    task_->columns(columns);
    tank_ = columns.at(0).value;
    rows_ = control::TickTask("ds", 3, 3);
    sensed_.q = Eigen::Vector3d::Zero();
    sensed_.qd = Eigen::Vector3d::Zero();
    const std::vector<double>& A = values_.numbers("matrix");
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> full(A.data());
    symmetric_ = 0.5 * (full + full.transpose());
  }

  /// One step of a 1 kg point under the task's force and an external one; returns the work of the external one.
  double step(const Eigen::Vector3d& external) {
    cache_.update(sensed_.q, sensed_.qd);
    task_->update(control::Tick{sensed_.time, dt, sensed_, cache_}, rows_);
    const Eigen::Vector3d before = sensed_.qd;
    sensed_.qd += dt * (rows_.force.head<3>() + external);
    sensed_.q += dt * sensed_.qd;
    sensed_.time += dt;
    return dt * 0.5 * (before + sensed_.qd).dot(external);
  }
  double storage() const {
    const Eigen::Vector3d x = sensed_.q;
    return 0.5 * sensed_.qd.squaredNorm() - lambda_ * 0.5 * x.dot(symmetric_ * x) + *tank_;
  }

  double dt = 1e-3;
  control::Sensed sensed_;
  const double* tank_ = nullptr;

 private:
  double lambda_;
  description::Robot robot_;
  dynamics::Model model_;
  dynamics::DynamicsCache cache_;
  control::Registry registry_;
  control::ElementValues values_;
  std::unique_ptr<control::Task> task_;
  control::TickTask rows_;
  Eigen::Matrix3d symmetric_;
};

const char* const kConservative = "-1 0 0 0 -2 0 0 0 -1";
const char* const kSwirling = "-0.1 -3 0 3 -0.1 0 0 0 -0.1";

TEST(PassiveDs, StorageRisesByNoMoreThanTheWorkDoneOnIt) {
  double excess[2];
  for (const int fine : {0, 1}) {
    PassiveDs ds(kSwirling);
    ds.dt = fine ? 0.5e-3 : 1e-3;
    ds.sensed_.q = Eigen::Vector3d(0.1, 0, 0.05);
    const double start = ds.storage();
    double work = 0, worst = 0;
    for (double t = 0; t < 10; t += ds.dt) {
      work += ds.step(0.5 * Eigen::Vector3d(std::sin(3 * t), std::cos(2 * t), std::sin(t)));
      worst = std::max(worst, ds.storage() - start - work);
      ASSERT_GE(*ds.tank_, 0);
      ASSERT_LE(*ds.tank_, 1);
    }
    excess[fine] = worst;
  }
  // What is left belongs to the explicit integrator (½‖Δv‖² a step): it halves with the step and vanishes in the limit.
  EXPECT_LT(excess[1], 0.6 * excess[0] + 1e-6);
  EXPECT_LT(2 * excess[1] - excess[0], 5e-4) << "extrapolated to a step of zero";
}

TEST(PassiveDs, AgainstADragNoMoreComesOutThanWasIn) {
  PassiveDs ds(kSwirling);
  ds.sensed_.q = Eigen::Vector3d(0.1, 0, 0);
  const double initially = ds.storage();
  double delivered = 0;
  for (int k = 0; k < 20000; ++k) delivered -= ds.step(-5 * Eigen::Vector3d(ds.sensed_.qd));
  EXPECT_GT(delivered, 0);
  EXPECT_LE(delivered, initially + 2e-3);
}

TEST(PassiveDs, AConservativeFieldNeverTakesFromTheTank) {
  PassiveDs ds(kConservative, 0.3);
  ds.sensed_.q = Eigen::Vector3d(0.1, -0.1, 0.05);
  double last = *ds.tank_;
  for (int k = 0; k < 5000; ++k) {
    ds.step(Eigen::Vector3d::Zero());
    EXPECT_GE(*ds.tank_, last);
    last = *ds.tank_;
  }
}

TEST(PassiveDs, FollowsTheFieldToItsTarget) {
  PassiveDs ds(kConservative, 0.5, 100);
  ds.sensed_.q = Eigen::Vector3d(0.1, -0.1, 0.05);
  const Eigen::Vector3d start = ds.sensed_.q;
  for (int k = 0; k < 2000; ++k) ds.step(Eigen::Vector3d::Zero());
  // ẋ = A x has the closed-form answer x_i exp(a_i t); the 1 kg mass lags it by about 1/λ₁.
  EXPECT_NEAR(ds.sensed_.q.x(), start.x() * std::exp(-2.0), 2e-3);
  EXPECT_NEAR(ds.sensed_.q.y(), start.y() * std::exp(-4.0), 2e-3);
}

TEST(PassiveDs, RefusesAFieldThatDoesNotLeadToItsTarget) {
  try {
    PassiveDs ds("1 0 0 0 -1 0 0 0 -1");
    FAIL();
  } catch (const control::ElementError& error) {
    EXPECT_EQ(error.attribute, "matrix");
    EXPECT_STREQ(error.what(),
                 "the symmetric part of matrix must be negative definite, or the field does not lead to the target");
  }
}

}  // namespace
}  // namespace tactus::test
