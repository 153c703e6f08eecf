// Laws that every registered task obeys, whatever it is for.
//
// Strategy: each task type is made with one set of attributes and put into random states with random contacts
// (fixed seeds).  What a single task should do at its goal is tested in its own file.  Not tested here: closed loops.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <sstream>

#include "conformance/allocation_count.h"
#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

using control::Task;
using control::TickTask;

/// How an attribute with world axes changes when the whole world is turned about the vertical.
enum class Turn { vectors, yaw, matrix };

struct Sample {
  std::string type;
  Attributes attributes;
  std::map<std::string, Turn> world_valued = {};
};

std::vector<Sample> samples() {
  return {
      {"contact-force", {{"on", "touch.held"}, {"feedback", "1"}}},
      {"contact-limit", {{"on", "touch.undesired"}, {"max-force", "0.3"}}},
      {"joint-limits", {{"margin", "0.2"}}},
      {"make-contact", {{"on", "touch.missing"}}},
      {"follow-surface",
       {{"frame", "palm"}, {"along", "0.6 0.1 0.2; 0.7 0.1 0.2"}, {"heading", "1 0.1 0"}, {"yaw-stiffness", "10"},
        {"tilt", "0.2"}, {"approach", "0.1 0 -1"}},
       {{"along", Turn::vectors}, {"heading", Turn::vectors}, {"approach", Turn::vectors}}},
      {"impedance",
       {{"frame", "palm"}, {"position", "0.6 0.1 0.3"}, {"orientation", "0.1 0.2 0.3"}, {"axes", "link"},
        {"stiffness", "300 100 50"}, {"damping", "20 30 40"}, {"point", "0.02 0.01 0.05"}, {"speed", "0.05"},
        {"turn-speed", "0.3"}},
       {{"position", Turn::vectors}, {"orientation", Turn::yaw}}},
      {"posture", {{"joints", "free"}, {"q", "0.1"}, {"delay", "0"}}},
      {"ds",
       {{"frame", "index_tip"}, {"target", "0.5 0.2 0.3"}, {"matrix", "-1 0.5 0 -0.5 -1 0.2 0 -0.2 -2"},
        {"damping-across", "40"}},
       {{"target", Turn::vectors}, {"matrix", Turn::matrix}}},
  };
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> result;
  std::string part;
  for (const char c : text + " ") {
    if (c == ' ' || c == ';') {
      if (!part.empty()) result.push_back(std::stod(part));
      part.clear();
    } else {
      part += c;
    }
  }
  return result;
}

Attributes turnedAttributes(const Sample& sample, double yaw) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Attributes attributes = sample.attributes;
  for (const auto& [name, turn] : sample.world_valued) {
    std::vector<double> values = numbers(attributes.at(name));
    if (turn == Turn::yaw) values[2] += yaw;
    if (turn == Turn::vectors) {
      for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        Eigen::Map<Eigen::Vector3d> v(values.data() + i);
        v = (R * v).eval();
      }
    }
    if (turn == Turn::matrix) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> A(values.data());
      A = (R * A * R.transpose()).eval();
    }
    std::ostringstream text;
    text.precision(17);
    for (std::size_t i = 0; i < values.size(); ++i) {
      text << values[i] << (name == "along" && i % 3 == 2 && i + 1 < values.size() ? ";" : " ");
    }
    attributes[name] = text.str();
    while (attributes[name].back() == ' ') attributes[name].pop_back();
  }
  return attributes;
}

/// Random state near the hand over the table, random contacts on hand links.
class RandomStates {
 public:
  explicit RandomStates(unsigned seed) : random_(seed) {}

  void apply(TaskWorld& world, double yaw = 0) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::VectorXd base = handOverTable();
    for (int i = 0; i < world.model.dof(); ++i) {
      world.sensed.q[i] = base[i] + uniform(-0.3, 0.3);
      world.sensed.qd[i] = uniform(-0.5, 0.5);
    }
    world.sensed.contacts.clear();
    static const char* const links[] = {"palm",       "index_proximal", "index_distal", "middle_medial",
                                        "ring_medial", "ring_distal",    "thumb_distal"};
    for (const char* name : links) {
      const Eigen::Vector3d normal(uniform(-0.5, 0.5), uniform(-0.5, 0.5), -1);
      const double force = uniform(0.1, 3);
      const bool touches = uniform(0, 1) < 0.5;
      if (touches) world.sensed.contacts.push_back(world.contactOn(name, R * normal, force));
    }
    world.sensed.time += world.dt;
    world.feel();
  }

 private:
  double uniform(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(random_); }
  std::mt19937 random_;
};

class TaskLaws : public ::testing::TestWithParam<Sample> {};

TEST_P(TaskLaws, RowsFitTheirCapacityAndAreFinite) {
  TaskWorld world;
  const auto task = world.make(GetParam().type, GetParam().attributes);
  TickTask rows = world.rowsFor(*task);
  RandomStates states(1);
  int rows_met = 0;
  for (int k = 0; k < 200; ++k) {
    states.apply(world);
    task->update(world.tick(), rows);
    ASSERT_GE(rows.rows, 0);
    ASSERT_LE(rows.rows, task->capacity());
    ASSERT_TRUE(rows.J().allFinite());
    ASSERT_TRUE(rows.F().allFinite());
    ASSERT_TRUE(std::isfinite(task->error()));
    rows_met += rows.rows;
  }
  EXPECT_GT(rows_met, 0) << "the law was tested on nothing";
}

TEST_P(TaskLaws, SameInputsGiveTheSameBytes) {
  TaskWorld first, second;
  const auto a = first.make(GetParam().type, GetParam().attributes);
  const auto b = second.make(GetParam().type, GetParam().attributes);
  TickTask rows_a = first.rowsFor(*a), rows_b = second.rowsFor(*b);
  RandomStates states_a(2), states_b(2);
  for (int k = 0; k < 100; ++k) {
    states_a.apply(first);
    states_b.apply(second);
    a->update(first.tick(), rows_a);
    b->update(second.tick(), rows_b);
    ASSERT_EQ(rows_a.rows, rows_b.rows);
    ASSERT_EQ(Eigen::MatrixXd(rows_a.J()), Eigen::MatrixXd(rows_b.J()));
    ASSERT_EQ(Eigen::VectorXd(rows_a.F()), Eigen::VectorXd(rows_b.F()));
  }
}

TEST_P(TaskLaws, AnUpdateAllocatesNothing) {
  TaskWorld world;
  const auto task = world.make(GetParam().type, GetParam().attributes);
  TickTask rows = world.rowsFor(*task);
  RandomStates states(3);
  for (int k = 0; k < 50; ++k) {
    states.apply(world);
    const long before = conformance::allocationCount();
    world.touch->update(world.tick());
    task->update(world.tick(), rows);
    ASSERT_EQ(conformance::allocationCount() - before, 0);
  }
}

TEST_P(TaskLaws, TurningTheWholeWorldChangesNoTorque) {
  const double yaw = 0.7;
  TaskWorld here;
  TaskWorld there(turned(lwrAllegro(), yaw));
  const auto a = here.make(GetParam().type, GetParam().attributes);
  const auto b = there.make(GetParam().type, turnedAttributes(GetParam(), yaw));
  TickTask rows_a = here.rowsFor(*a), rows_b = there.rowsFor(*b);
  RandomStates states_a(4), states_b(4);
  double largest = 0;
  for (int k = 0; k < 100; ++k) {
    states_a.apply(here);
    states_b.apply(there, yaw);
    a->update(here.tick(), rows_a);
    b->update(there.tick(), rows_b);
    ASSERT_EQ(rows_a.rows, rows_b.rows);
    const Eigen::VectorXd torque_a = rows_a.J().transpose() * rows_a.F();
    const Eigen::VectorXd torque_b = rows_b.J().transpose() * rows_b.F();
    largest = std::max(largest, torque_a.norm());
    ASSERT_LT((torque_a - torque_b).norm(), 1e-9 * (1 + torque_a.norm())) << "state " << k;
  }
  EXPECT_GT(largest, 0) << "the law was tested on zero torques";
}

TEST_P(TaskLaws, WhatVelocityAddsNeverDrives) {
  // The torque with velocity less the torque without takes power out: q̇ᵀ Jᵀ (F(q, q̇) − F(q, 0)) ≤ 0.
  // Tasks with memory get a fresh copy for each of the two; `ds` tracks a field whose tank reacts to velocity only
  // by giving less.
  RandomStates moving_states(5), still_states(5);
  for (int k = 0; k < 60; ++k) {
    TaskWorld moving, still;
    const auto a = moving.make(GetParam().type, GetParam().attributes);
    const auto b = still.make(GetParam().type, GetParam().attributes);
    TickTask rows_a = moving.rowsFor(*a), rows_b = still.rowsFor(*b);
    moving_states.apply(moving);
    still_states.apply(still);
    still.sensed.qd.setZero();
    still.feel();
    a->update(moving.tick(), rows_a);
    b->update(still.tick(), rows_b);
    ASSERT_EQ(rows_a.rows, rows_b.rows);
    const Eigen::VectorXd v = rows_a.J() * moving.sensed.qd;
    const double power = v.dot(rows_a.F() - rows_b.F());
    EXPECT_LE(power, 1e-12) << "state " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryTask, TaskLaws, ::testing::ValuesIn(samples()),
                         [](const ::testing::TestParamInfo<Sample>& info) {
                           std::string name = info.param.type;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST(TaskLaws, EveryRegisteredTaskHasASample) {
  control::Registry registry;
  tasks::registerBuiltIns(registry);
  std::vector<std::string> sampled;
  for (const Sample& sample : samples()) sampled.push_back(sample.type);
  std::vector<std::string> registered = registry.names(control::ElementKind::task);
  std::sort(sampled.begin(), sampled.end());
  std::sort(registered.begin(), registered.end());
  EXPECT_EQ(sampled, registered);
}

}  // namespace
}  // namespace tactus::test
