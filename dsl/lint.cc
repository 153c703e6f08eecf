#include "dsl/lint.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "dsl/codes.h"
#include "dsl/compile.h"
#include "dsl/source_text.h"
#include "framework/control/contact_set.h"
#include "framework/control/xray.h"
#include "framework/dynamics/inverse_kinematics.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ElementValues;
using control::Relation;
using control::TickTask;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rank_threshold = 1e-6;                            // relative, of unit rows
constexpr double nudge = 1e-6;                                     // rad or m, rad/s or m/s: for differences
constexpr double growth = 1e-3;                                    // of an eigenvalue beyond 1: differences and rounding
constexpr double near_enough = 0.02;                               // m
constexpr int tries = 8;                                           // starts of the inverse kinematics
constexpr double long_after_start = 1e3;                           // s: ramps have ended

std::string counted(long count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Rows of a task as unit rows; zero rows are left out.
MatrixXd unitRows(const TickTask& task) {
  MatrixXd rows(0, task.jacobian.cols());
  for (int i = 0; i < task.rows; ++i) {
    const double norm = task.jacobian.row(i).norm();
    if (norm < 1e-12) continue;
    rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
    rows.row(rows.rows() - 1) = task.jacobian.row(i) / norm;
  }
  return rows;
}

long rankOf(const MatrixXd& rows) {
  if (rows.rows() == 0) return 0;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(rows.transpose());
  qr.setThreshold(rank_threshold);
  return qr.rank();
}

class Linter {
 public:
  Linter(const Stack& stack, const control::Registry& registry, double plant_step)
      : stack_(stack), plant_step_(plant_step), controller_(compile(stack, registry)), cache_(controller_->model()) {
    sensed_.q = stack.start_q;
    sensed_.qd = VectorXd::Zero(stack.start_q.size());
    sensed_.time = long_after_start;
    controller_->tick(sensed_);
    cache_.update(sensed_.q, sensed_.qd);
  }

  std::vector<Diagnostic> run() {
    levels();
    contacts();
    gains();
    reach();
    phases();
    std::stable_sort(found_.begin(), found_.end(), [](const Diagnostic& a, const Diagnostic& b) {
      return a.place.file == b.place.file && a.place.line < b.place.line;
    });
    return std::move(found_);
  }

 private:
  void say(const Code& code, const description::Place& place, int length, const std::string& path,
           const std::string& message) {
    Diagnostic diagnostic;
    diagnostic.severity = Severity::warning;
    diagnostic.code = code.id;
    diagnostic.message = message;
    diagnostic.place = place;
    diagnostic.length = std::max(1, length);
    diagnostic.path = path;
    if (const auto file = stack_.files.find(place.file); file != stack_.files.end())
      diagnostic.source_line = SourceText(place.file, file->second).lineAt(place.line);
    if (const auto way = stack_.included_from.find(place.file); way != stack_.included_from.end())
      diagnostic.included_from = way->second;
    found_.push_back(std::move(diagnostic));
  }

  void say(const Code& code, const ElementInstance& element, const std::string& message) {
    say(code, element.place, countCharacters(element.values.row().name) + 1, element.path, message);
  }

  int dof() const { return controller_->model().dof(); }

  const TickTask& rowsOf(std::size_t level, std::size_t task) const {
    return controller_->problem().levels[level].tasks[task];
  }

  void levels() {
    const control::Xray xray = control::xray(controller_->problem(), controller_->solution());
    if (!xray.usable) return;
    for (std::size_t i = 0; i < stack_.levels.size(); ++i) {
      const LevelDescription& level = stack_.levels[i];
      const control::LevelXray& granted = xray.levels[i];
      if (granted.wanted > 0 && granted.granted == 0)
        say(code::dead_level, level.element,
            "level " + std::to_string(level.priority) + " can do nothing where the robot starts: higher levels take " +
                (granted.wanted == 1 ? "the one direction" : "all " + std::to_string(granted.wanted) + " directions") +
                " that it asks for");
      for (std::size_t k = 0; k < level.tasks.size(); ++k) {
        holdsAll(i, k);
        for (std::size_t other = 0; other < k; ++other) compareRows(i, other, k);
      }
    }
  }

  void holdsAll(std::size_t i, std::size_t k) {
    const TickTask& rows = rowsOf(i, k);
    if (i + 1 == stack_.levels.size() || rows.relation == Relation::inequality || rankOf(unitRows(rows)) < dof()) return;
    say(code::posture_above, stack_.levels[i].tasks[k],
        "'" + stack_.levels[i].tasks[k].name + "' holds all " + counted(dof(), "joint", "joints") +
            ": nothing is left for the levels below level " + std::to_string(stack_.levels[i].priority));
  }

  void compareRows(std::size_t level, std::size_t first, std::size_t second) {
    const TickTask &a = rowsOf(level, first), &b = rowsOf(level, second);
    if (a.relation != Relation::equality || b.relation != Relation::equality) return;
    const MatrixXd rows_a = unitRows(a), rows_b = unitRows(b);
    MatrixXd both(rows_a.rows() + rows_b.rows(), dof());
    both << rows_a, rows_b;
    const long shared = rankOf(rows_a) + rankOf(rows_b) - rankOf(both);
    if (shared <= 0) return;
    const auto& tasks = stack_.levels[level].tasks;
    say(code::duplicate_rows, tasks[second],
        "'" + tasks[second].name + "' and '" + tasks[first].name + "' of the same level ask for the same " +
            (shared == 1 ? "direction" : std::to_string(shared) + " directions") + ": neither gets there alone");
  }

  /// Each desired link touched once, in directions that mean nothing: so many independent rows can there be.
  void contacts() {
    for (const ElementInstance& signal : stack_.signals) {
      for (const control::PortRow& port : signal.values.ports()) {
        if (port.type != control::PortType<control::FrameSet>::name) continue;
        const auto& frames = static_cast<const control::FrameSet*>(signalOf(signal.name).port(port.name))->frames;
        MatrixXd rows(static_cast<long>(frames.size()), dof());
        std::mt19937 random(1);
        std::normal_distribution<> normal;
        for (std::size_t i = 0; i < frames.size(); ++i) {
          Eigen::Matrix<double, 6, Eigen::Dynamic> J(6, dof());
          cache_.frameJacobian(frames[i], J);
          Eigen::VectorXd direction(6);
          for (double& part : direction) part = normal(random);
          rows.row(static_cast<long>(i)) = direction.transpose() * J;
        }
        const long directions = rankOf(rows);
        if (directions < static_cast<long>(frames.size()))
          say(code::too_many_contacts, signal,
              counted(static_cast<long>(frames.size()), "link is", "links are") + " desired to touch, but they move in only " +
                  counted(directions, "independent direction", "independent directions") +
                  ": not every contact force can be held");
      }
    }
  }

  const control::Signal& signalOf(const std::string& name) const {
    const auto found = std::find_if(controller_->signals().begin(), controller_->signals().end(),
                                    [&](const control::NamedSignal& named) { return named.name == name; });
    return *found->signal;
  }

  /// F of a task at a state.
  VectorXd force(control::Task& task, TickTask& rows, dynamics::DynamicsCache& cache, const control::Sensed& sensed) const {
    cache.update(sensed.q, sensed.qd);
    task.update({sensed.time, controller_->period(), sensed, cache}, rows);
    return rows.F();
  }

  void gains() {
    dynamics::DynamicsCache cache(controller_->model());
    const MatrixXd M = controller_->problem().mass_matrix;
    const Eigen::LLT<MatrixXd> factor(M);
    for (std::size_t i = 0; i < stack_.levels.size(); ++i)
      for (std::size_t k = 0; k < stack_.levels[i].tasks.size(); ++k) {
        control::Task& task = *controller_->levels()[i].tasks[k].task;
        if (task.relation() == Relation::inequality || task.isContact()) continue;
        TickTask rows(stack_.levels[i].tasks[k].name, task.capacity(), dof());
        const VectorXd at_start = force(task, rows, cache, sensed_);
        if (!at_start.allFinite() || rows.rows == 0) continue;
        const MatrixXd J = rows.J();                               // that turns with the robot is not the gains' doing
        MatrixXd by_q(J.rows(), dof()), by_qd(J.rows(), dof());
        const auto change = [&](const control::Sensed& moved) -> VectorXd {
          const VectorXd there = force(task, rows, cache, moved);
          if (there.size() != at_start.size()) return VectorXd::Zero(at_start.size());
          return there - at_start;
        };
        for (int j = 0; j < dof(); ++j) {
          control::Sensed moved = sensed_;
          moved.q[j] += nudge;
          by_q.col(j) = change(moved) / nudge;
          moved = sensed_;
          moved.qd[j] += nudge;
          by_qd.col(j) = change(moved) / nudge;
        }
        const MatrixXd stiffness = factor.solve(J.transpose() * by_q);
        const MatrixXd damping = factor.solve(J.transpose() * by_qd);
        if (!stiffness.allFinite() || !damping.allFinite()) continue;
        judge(stack_.levels[i].tasks[k], stiffness, damping);
      }
  }

  /// q̈ = K q + D q̇, held for a tick dt: q̇⁺ = q̇ + dt q̈, q⁺ = q + dt q̇⁺.
  static double largestEigenvalue(const MatrixXd& K, const MatrixXd& D, double dt) {
    const long n = K.rows();
    MatrixXd A(2 * n, 2 * n);
    A.bottomLeftCorner(n, n) = dt * K;
    A.bottomRightCorner(n, n) = MatrixXd::Identity(n, n) + dt * D;
    A.topLeftCorner(n, n) = MatrixXd::Identity(n, n) + dt * A.bottomLeftCorner(n, n);
    A.topRightCorner(n, n) = dt * A.bottomRightCorner(n, n);
    return Eigen::EigenSolver<MatrixXd>(A, false).eigenvalues().cwiseAbs().maxCoeff();
  }

  void judge(const ElementInstance& task, const MatrixXd& stiffness, const MatrixXd& damping) {
    const double dt = controller_->period();
    const double value = largestEigenvalue(stiffness, damping, dt);
    if (value <= 1 + growth) return;
    std::string cure = "; lower its damping or stiffness";
    for (double rate = 2; rate <= 64 && dt / rate >= (1 - 1e-9) * plant_step_; rate *= 2) {
      // What grows slowly in a tick grows as much in many short ones.
      if (largestEigenvalue(stiffness, damping, dt / rate) > 1 + growth) continue;
      cure += ", or tick at " + std::to_string(std::lround(rate / dt)) + " Hz";
      break;
    }
    say(code::unstable_gains, task,
        "'" + task.name + "' is not stable at " + std::to_string(std::lround(1 / dt)) +
            " Hz where the robot starts: what it holds for a tick makes a deviation " +
            control::formatNumber(std::round(value * 1000) / 1000) + " times as large" + cure);
  }

  void reach() {
    for (const LevelDescription& level : stack_.levels)
      for (const ElementInstance& task : level.tasks)
        for (const AttributeRow& row : task.values.row().attributes)
          if (!row.reached_by.empty() && task.values.has(row.name)) reach(task, row);
  }

  void reach(const ElementInstance& task, const AttributeRow& row) {
    const dynamics::Model& model = controller_->model();
    const int frame = model.frameIndex(task.values.text(row.reached_by));
    const std::vector<double>& numbers = task.values.numbers(row.name);
    for (std::size_t i = 0; i + 3 <= numbers.size(); i += 3) {
      const Eigen::Vector3d place(numbers[i], numbers[i + 1], numbers[i + 2]);
      const double missed = nearest(model, frame, place);
      if (missed <= near_enough) continue;
      const control::Value& value = task.values.value(row.name);
      const bool written = value.origin.place.line > 0;
      const std::string which = numbers.size() > 3 ? "place " + std::to_string(i / 3 + 1) + " of '" + row.name + "'" : "'" + row.name + "'";
      say(code::out_of_reach, written ? value.origin.place : task.place, 1, task.path,
          which + " cannot be reached: link '" + task.values.text(row.reached_by) + "' comes no nearer than " +
              control::formatNumber(std::round(missed * 1000) / 1000) + " m");
      return;                                                      // one place is enough to look at all
    }
  }

  /// Distance of the nearest configuration that is found, from the start and from others.
  double nearest(const dynamics::Model& model, int frame, const Eigen::Vector3d& place) const {
    std::mt19937 random(1);
    double best = INFINITY;
    for (int k = 0; k < tries && best > near_enough; ++k) {
      VectorXd start = stack_.start_q;
      if (k > 0) {
        std::uniform_real_distribution<> uniform(-1, 1);
        for (double& q : start) q += uniform(random);
      }
      best = std::min(best, dynamics::inverseKinematics(model, {{frame, place, std::nullopt}}, start).error);
    }
    return best;
  }

  void phases() {
    for (const ElementInstance& signal : stack_.signals) {
      const ElementValues& values = signal.values;
      if (values.row().name != "phases") continue;
      const std::string first =
          values.has("start") ? values.text("start") : values.children.empty() ? "" : values.children[0].text("name");
      std::vector<std::string> reached{first};
      for (std::size_t i = 0; i < reached.size(); ++i)
        for (const ElementValues& phase : values.children)
          if (phase.text("name") == reached[i])
            for (const ElementValues& next : phase.children)
              if (std::find(reached.begin(), reached.end(), next.text("to")) == reached.end())
                reached.push_back(next.text("to"));
      for (const ElementValues& phase : values.children)
        if (std::find(reached.begin(), reached.end(), phase.text("name")) == reached.end())
          say(code::unreachable_phase, phase.place, 6, signal.path,
              "nothing leads to the phase '" + phase.text("name") + "' from '" + first + "', where the machine begins");
    }
  }

  const Stack& stack_;
  double plant_step_;                                              // s
  std::unique_ptr<control::Controller> controller_;
  dynamics::DynamicsCache cache_;
  control::Sensed sensed_;
  std::vector<Diagnostic> found_;
};

}  // namespace

std::vector<Diagnostic> lint(const Stack& stack, const control::Registry& registry, double plant_step) {
  return Linter(stack, registry, plant_step).run();
}

}  // namespace tactus::dsl
