// Law 8 for every back end that there is: whatever is switched, and however often, no joint's torque changes faster
// than the controller declares; it is always finite and within the actuators' limits.
//
// Strategy: random tasks on an arm, equalities, inequalities and contacts, whose rows come and go; now and then a task
// gives numbers that are none.  Every few ticks something is switched.  Each back end is taken from the registry with
// its defaults, and once with each choice of each of its options.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dsl/read_robot.h"
#include "dsl/read_stack.h"
#include "framework/control/controller.h"
#include "framework/control/registry.h"
#include "framework/runtime/plugin_loader.h"

namespace tactus::test {
namespace {

using control::Controller;
using control::Relation;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double dt = 0.001;

class Draws {
 public:
  explicit Draws(unsigned seed) : random_(seed) {}
  double normal() { return std::normal_distribution<>()(random_); }
  bool chance(double share) { return std::uniform_real_distribution<>()(random_) < share; }
  int below(std::size_t count) { return std::uniform_int_distribution<>(0, static_cast<int>(count) - 1)(random_); }
  MatrixXd matrix(int rows, int columns) {
    return MatrixXd::NullaryExpr(rows, columns, [this] { return normal(); });
  }

 private:
  std::mt19937 random_;
};

/// Up to three rows that turn slowly; in some ticks there are fewer, in some they are no numbers.
class Wandering final : public control::Task {
 public:
  Wandering(Draws& draws, Relation relation, bool contact, int dof)
      : Task(relation, 3, contact), draws_(draws), from_(draws.matrix(3, dof)), to_(draws.matrix(3, dof)) {}

 private:
  void doUpdate(const control::Tick& tick, control::TickTask& rows) override {
    if (draws_.chance(0.05)) count_ = draws_.below(4);
    const int n = rows.rows = count_;
    rows.jacobian.topRows(n) = from_.topRows(n) + std::sin(3 * tick.time) * to_.topRows(n);
    for (int i = 0; i < n; ++i) rows.force[i] = (isContact() ? 1 : 20) * std::cos(5 * tick.time + i);
    if (draws_.chance(0.003)) rows.force[0] = draws_.chance(0.5) ? std::nan("") : 1e200;
  }
  Draws& draws_;
  MatrixXd from_, to_;
  int count_ = 3;
};

struct Variant {
  const control::ElementRow* row;
  std::map<std::string, std::string> options;
  std::string name() const {
    std::string text = row->name;
    for (const auto& [option, value] : options) text += " " + option + "=" + value;
    return text;
  }
};

class SwitchingLaws : public ::testing::Test {
 protected:
  SwitchingLaws() {
    dsl::addStructureElements(registry);
    runtime::PluginLoader(registry, {}, SHIPPED_PLUGINS).loadFolder(SHIPPED_PLUGINS);
    std::vector<dsl::Diagnostic> warnings;
    model = std::make_shared<dynamics::Model>(dsl::readRobot(TACTUS_SOURCE_DIR "/models/lwr_4plus.urdf", warnings));
    for (const std::string& name : registry.names(control::ElementKind::back_end)) {
      const control::ElementRow& row = *registry.elements().findBackEnd(name);
      variants.push_back({&row, {}});
      for (const control::AttributeRow& option : row.attributes)
        for (const std::string& choice : option.choices)
          if (choice != option.default_text) variants.push_back({&row, {{option.name, choice}}});
    }
  }

  std::unique_ptr<control::BackEnd> make(const Variant& variant) const {
    return registry.makeBackEnd(control::makeValues(*variant.row, variant.options));
  }

  std::unique_ptr<Controller> controllerOf(const Variant& variant, Draws& draws, double rate) {
    std::vector<control::Level> levels(3);
    for (int i = 0; i < 3; ++i) {
      levels[static_cast<std::size_t>(i)].priority = i + 1;
      for (const Relation relation : {Relation::equality, Relation::inequality}) {
        const std::string name = std::string(relation == Relation::equality ? "same" : "less") + std::to_string(i);
        const bool contact = i == 0 && relation == Relation::equality;
        control::ActiveWhen when;
        when.ramp = 0.01;
        levels[static_cast<std::size_t>(i)].tasks.push_back(
            {name, std::make_unique<Wandering>(draws, relation, contact, model->dof()), control::Activation(when)});
        names.push_back(name);
      }
    }
    control::ControllerOptions options;
    options.torque_rate = rate;
    options.ramp = 0.02;
    return std::make_unique<Controller>(model, std::vector<control::NamedSignal>{}, std::move(levels),
                                        make(variant), dt, Eigen::Vector3d(0, 0, -9.81), options);
  }

  void switchSomething(Controller& controller, Draws& draws) {
    const std::string& task = names[static_cast<std::size_t>(draws.below(names.size()))];
    const int priority = 1 + draws.below(3);
    switch (draws.below(5)) {
      case 0: return controller.setActive(task, draws.chance(0.5));
      case 1: return controller.setActive(priority, draws.chance(0.5));
      case 2: return controller.setWeight(priority, std::exp(2 * draws.normal()));
      case 3: return controller.setPriority(task, priority);
      default: return controller.setBackEnd(make(variants[static_cast<std::size_t>(draws.below(variants.size()))]));
    }
  }

  control::Registry registry;
  std::shared_ptr<const dynamics::Model> model;
  std::vector<Variant> variants;
  std::vector<std::string> names;
};

TEST_F(SwitchingLaws, NoSwitchMakesTheTorqueJump) {
  constexpr double rate = 50;
  const VectorXd& effort = model->effort();
  ASSERT_TRUE(effort.allFinite());
  ASSERT_GE(variants.size(), 5u);
  long limited = 0, unlimited = 0;
  for (std::size_t v = 0; v < variants.size(); ++v) {
    SCOPED_TRACE(variants[v].name());
    Draws draws(static_cast<unsigned>(v + 1));
    names.clear();
    const auto controller = controllerOf(variants[v], draws, rate);
    control::Sensed sensed;
    sensed.q.resize(model->dof());
    sensed.qd.resize(model->dof());
    VectorXd before;
    for (int k = 0; k < 200; ++k) {
      sensed.time = dt * k;
      for (int i = 0; i < model->dof(); ++i) {
        sensed.q[i] = 0.5 * std::sin(2 * sensed.time + i);
        sensed.qd[i] = std::cos(2 * sensed.time + i);
      }
      // The first half with one back end, the second with all.
      if (draws.chance(0.1)) {
        if (k < 100)
          controller->setActive(names[static_cast<std::size_t>(draws.below(names.size()))], draws.chance(0.5));
        else
          switchSomething(*controller, draws);
      }
      const VectorXd& torque = controller->tick(sensed);
      ASSERT_TRUE(torque.allFinite()) << k;
      ASSERT_TRUE((torque.cwiseAbs().array() <= effort.array()).all()) << k;
      if (k == 0) before = torque;
      ASSERT_TRUE(((torque - before).cwiseAbs().array() <= (rate * dt + 1e-12) * effort.array()).all()) << k;
      before = torque;
      (controller->record().rate_limited ? limited : unlimited) += 1;
    }
  }
  // The law was tried on something: the rate had to bite, and did not always.
  EXPECT_GT(limited, 100);
  EXPECT_GT(unlimited, 100);
}

TEST_F(SwitchingLaws, TheSameSwitchesGiveTheSameBits) {
  const auto run = [&](const Variant& variant) {
    Draws draws(3);
    names.clear();
    const auto controller = controllerOf(variant, draws, 20);
    control::Sensed sensed;
    sensed.q = sensed.qd = VectorXd::Constant(model->dof(), 0.2);
    VectorXd sum = VectorXd::Zero(model->dof());
    for (int k = 0; k < 50; ++k) {
      sensed.time = dt * k;
      if (draws.chance(0.1)) switchSomething(*controller, draws);
      sum = 0.9 * sum + controller->tick(sensed);
    }
    return sum;
  };
  for (const Variant& variant : variants) EXPECT_EQ(run(variant), run(variant)) << variant.name();
}

}  // namespace
}  // namespace tactus::test
