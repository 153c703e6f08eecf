#include "bench/tick_cases.h"

#include <cmath>
#include <stdexcept>

#include "dsl/compile.h"
#include "dsl/read_stack.h"
#include "framework/dynamics/dynamics_cache.h"
#include "framework/runtime/plugin_loader.h"
#include "tasks/register_tasks.h"
#include "tests/dynamics/robots.h"

namespace tactus::bench {
namespace {

using control::Relation;
using control::Tick;
using control::TickTask;

constexpr double period = 1e-3;

/// Small slow movements about a pose, each coordinate with its own phase.
void move(std::vector<control::Sensed>& sensed, const Eigen::VectorXd& q0, const dynamics::Model& model) {
  const int n = model.dof();
  for (int k = 0; k < static_cast<int>(sensed.size()); ++k) {
    const double angle = 2 * M_PI * k / static_cast<double>(sensed.size());
    sensed[k].time = k * period;
    sensed[k].q = q0;
    sensed[k].qd.resize(n);
    for (int i = 0; i < n; ++i) sensed[k].qd[i] = 0.1 * std::cos(angle + i);
    // The last coordinates of a tree with a floating base are those of its joints: q and q̇ end alike.
    const int joints = std::min<int>(n, static_cast<int>(q0.size())) - (q0.size() > n ? 6 : 0);
    for (int i = 0; i < joints; ++i) sensed[k].q[q0.size() - 1 - i] += 0.05 * std::sin(angle + n - 1 - i);
  }
}

/// Where contacts stand on the arm with hand: the nine links of three fingers that are to touch, whose contacts are
/// equality rows, then others, whose are inequality rows.
constexpr const char* touched[] = {
    "index_proximal", "middle_medial", "ring_distal",   "index_medial", "middle_distal", "ring_proximal", "index_distal",
    "middle_proximal", "ring_medial",  "thumb_distal",  "palm",         "thumb_medial",  "flange",        "thumb_proximal",
    "lwr_6",          "index_base",    "middle_base",   "ring_base",    "thumb_base",    "lwr_5"};

class StackCase final : public TickCase {
 public:
  StackCase(std::string name, std::string file, int contacts)
      : TickCase(std::move(name)), file_(TACTUS_SOURCE_DIR "/bench/stacks/" + std::move(file)) {
    const dsl::Stack stack = read({});
    const std::unique_ptr<control::Controller> controller = dsl::compile(stack, registry());
    const dynamics::Model& model = controller->model();
    move(sensed_, stack.start_q, model);
    std::vector<int> links;
    for (const char* link : touched) links.push_back(stack.robot.linkIndex(link));
        dynamics::DynamicsCache cache(model);
    for (control::Sensed& sensed : sensed_) {
      cache.update(sensed.q, sensed.qd);
      for (int c = 0; c < contacts; ++c) {
        // Every fiftieth tick another one is away.
        const int tick = static_cast<int>(&sensed - sensed_.data());
        if (contacts > 1 && (tick / 10) % 5 == 0 && tick / 50 % contacts == c) continue;
        control::ContactRecord record;
        record.link = links[c];
        record.object = 0;
        record.normal_W = Eigen::Vector3d(0.2 * std::sin(c), 0.2 * std::cos(c), -1).normalized();
        record.point_W = cache.framePose(record.link) * Eigen::Vector3d(0, 0, 0.01 + 0.001 * c);
        record.force_N = 0.5;
        sensed.contacts.push_back(record);
      }
    }
  }

  std::unique_ptr<control::Controller> controller(const BackEndChoice& choice) const override {
    return dsl::compile(read(choice), registry());
  }

 private:
  dsl::Stack read(const BackEndChoice& choice) const {
    dsl::ReadOptions options;
    options.model_path = {TACTUS_SOURCE_DIR "/models"};
    options.backend = choice.name;
    options.backend_options = choice.options;
    return dsl::readStack(file_, registry(), options);
  }

  std::string file_;
};

/// Linear rows of points of links, pulled to where they were at first.
class Points final : public control::Task {
 public:
  Points(const dynamics::Model& model, const std::vector<std::string>& links, bool contact = false)
      : Task(Relation::equality, contact ? static_cast<int>(links.size()) : 3 * static_cast<int>(links.size()), contact) {
    for (const std::string& link : links) frames_.push_back(model.frameIndex(link));
  }

 private:
  void doUpdate(const Tick& tick, TickTask& rows) override {
    rows.rows = capacity();
    for (int i = 0; i < static_cast<int>(frames_.size()); ++i) {
      const Eigen::Vector3d p = tick.robot.framePose(frames_[i]).translation();
      if (isContact()) {
        tick.robot.directionJacobian(frames_[i], p, -Eigen::Vector3d::UnitZ(), rows.jacobian.row(i));
        rows.force[i] = 5;
        continue;
      }
      tick.robot.pointJacobian(frames_[i], p, rows.jacobian.middleRows<3>(3 * i));
      rows.force.segment<3>(3 * i) = Eigen::Vector3d(5, -3, 4) - 20 * tick.robot.pointVelocity(frames_[i], p);
    }
  }

  std::vector<int> frames_;
};

class Posture final : public control::Task {
 public:
  explicit Posture(const dynamics::Model& model) : Task(Relation::equality, model.dof()) {}

 private:
  void doUpdate(const Tick& tick, TickTask& rows) override {
    rows.rows = capacity();
    rows.jacobian.setIdentity();
    rows.force = -2 * tick.robot.qd();
    rows.force.array() += 0.3;
  }
};

class Limits final : public control::Task {
 public:
  explicit Limits(const dynamics::Model& model) : Task(Relation::inequality, model.dof()) {}

 private:
  void doUpdate(const Tick&, TickTask& rows) override {
    rows.rows = capacity() / 2;
    rows.jacobian.setZero();
    for (int i = 0; i < rows.rows; ++i) rows.jacobian(i, 2 * i) = 1;
    rows.force.setZero();
  }
};

class TreeCase final : public TickCase {
 public:
  using Builder = std::vector<control::Level> (*)(const dynamics::Model&);

  TreeCase(std::string name, description::Robot robot, Builder levels)
      : TickCase(std::move(name)), model_(std::make_shared<dynamics::Model>(robot)), levels_(levels) {
    Eigen::VectorXd q = model_->neutral();
    const int base = model_->positionCount() > model_->dof() ? 7 : 0;
    for (int i = base; i < q.size(); ++i) q[i] = 0.4 * std::sin(1.7 * i);
    move(sensed_, q, *model_);
  }

  std::unique_ptr<control::Controller> controller(const BackEndChoice& choice) const override {
    const control::ElementRow* row = registry().elements().findBackEnd(choice.name);
    if (!row) throw std::logic_error("no back end " + choice.name);
    return std::make_unique<control::Controller>(model_, std::vector<control::NamedSignal>{}, levels_(*model_),
                                                 registry().makeBackEnd(control::makeValues(*row, choice.options)),
                                                 period, Eigen::Vector3d(0, 0, -9.81));
  }

 private:
  std::shared_ptr<const dynamics::Model> model_;
  Builder levels_;
};

control::Level level(int priority, double weight) {
  control::Level level;
  level.priority = priority;
  level.weight = weight;
  return level;
}

std::vector<control::Level> humanoidLevels(const dynamics::Model& model) {
  std::vector<control::Level> levels;
  levels.push_back(level(1, 1));
  levels.back().tasks.push_back({"feet", std::make_unique<Points>(
      model, std::vector<std::string>{"left_ankle_roll_link", "right_ankle_roll_link"}, true)});
  levels.push_back(level(2, 1e-1));
  levels.back().tasks.push_back({"limits", std::make_unique<Limits>(model)});
  levels.push_back(level(3, 1e-2));
  levels.back().tasks.push_back({"hands", std::make_unique<Points>(
      model, std::vector<std::string>{"left_forearm_yaw_link", "right_forearm_yaw_link"})});
  levels.push_back(level(4, 1e-4));
  levels.back().tasks.push_back({"posture", std::make_unique<Posture>(model)});
  return levels;
}

std::vector<control::Level> chainLevels(const dynamics::Model& model) {
  std::vector<control::Level> levels;
  levels.push_back(level(1, 1));
  levels.back().tasks.push_back({"tip", std::make_unique<Points>(
      model, std::vector<std::string>{model.frames().back().name})});
  levels.push_back(level(2, 1e-2));
  levels.back().tasks.push_back({"posture", std::make_unique<Posture>(model)});
  return levels;
}

}  // namespace

control::Registry& registry() {
  static control::Registry all = [] {
    control::Registry registry;
    dsl::addStructureElements(registry);
    tasks::registerBuiltIns(registry);
    runtime::PluginLoader(registry, {}, SHIPPED_PLUGINS).loadFolder(SHIPPED_PLUGINS);
    return registry;
  }();
  return all;
}

std::vector<std::unique_ptr<TickCase>> tickCases() {
  std::vector<std::unique_ptr<TickCase>> cases;
  for (const int contacts : {0, 4, 6, 12, 20})
    cases.push_back(std::make_unique<StackCase>("lwr_allegro, " + std::to_string(contacts) + " contacts",
                                                "arm_hand.xml", contacts));
  cases.push_back(std::make_unique<StackCase>("arm, 7 joints, 2 levels", "arm.xml", 0));
  cases.push_back(std::make_unique<TreeCase>("humanoid, 36 joints, 4 levels", test_robots::humanoid(), humanoidLevels));
  for (const int joints : {10, 30, 100})
    cases.push_back(std::make_unique<TreeCase>("chain, " + std::to_string(joints) + " joints, 2 levels",
                                               test_robots::chain(joints), chainLevels));
  return cases;
}

}  // namespace tactus::bench
