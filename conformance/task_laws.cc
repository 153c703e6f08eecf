#include <Eigen/SVD>

#include <cmath>

#include "conformance/allocation_count.h"
#include "conformance/laws.h"
#include "conformance/states.h"
#include "conformance/take_over.h"

namespace tactus::conformance {
namespace {

using control::TickTask;

constexpr int kTicks = 16 * kStretch;
constexpr int kPlaces = 12;                                        // where derivatives are taken
constexpr double kStep = 1e-5;                                     // rad or m, of central differences
constexpr double kDerivativeTolerance = 1e-6;
constexpr double kTurn = 0.7;                                      // rad, of the world

std::string text(double number) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", number);
  return buffer;
}

/// One world with the task in it.
class TaskBench {
 public:
  TaskBench(const dsl::Stack& stack, const Subject& subject, unsigned seed,
            const Eigen::Isometry3d& moved = Eigen::Isometry3d::Identity())
      : bench_(stack, subject.registry), states_(stack, seed, moved), on_bench_(bench_.taskNamed(subject.name)) {}
  TaskBench(const Subject& subject, unsigned seed) : TaskBench(subject.stack, subject, seed) {}

  /// Signals and the task at the next state, or at the one that `change` makes of it.
  template <class Change>
  void tickAt(Change change) {
    states_.next(bench_);
    change(bench_.sensed);
    states_.touch(bench_);
    const control::Tick tick = bench_.sense();
    bench_.prepare(tick);
    allocations_ = allocationCount();
    on_bench_.task->update(tick, on_bench_.rows);
    allocations_ = allocationCount() - allocations_;
    bench_.endTick();
  }
  void tick() {
    tickAt([](control::Sensed&) {});
  }
  void tick(int times) {
    for (int k = 0; k < times; ++k) tick();
  }

  const control::Task& task() const { return *on_bench_.task; }
  const TickTask& rows() const { return on_bench_.rows; }
  Eigen::VectorXd torque() const { return rows().J().transpose() * rows().F(); }
  long allocations() const { return allocations_; }                // of the last update
  const Bench& bench() const { return bench_; }
  /// Goes on where another one stands.
  void goOnAs(TaskBench& other) {
    takeOver(other.bench_, bench_);
    states_ = other.states_;
  }

 private:
  Bench bench_;
  States states_;
  Bench::TaskOnBench& on_bench_;
  long allocations_ = 0;
};

/// A bench that has gone through all but the last tick of a stretch; the next tick is where derivatives are taken.
TaskBench before(const Subject& subject, int place) {
  TaskBench bench(subject, 100 + place);
  bench.tick(kStretch - 1);
  return bench;
}

void checkRows(const Subject& subject) {
  TaskBench bench(subject, 1);
  const int capacity = bench.task().capacity(), dof = bench.bench().robot().dof();
  if (capacity < 0) throw Broken{"its capacity is " + std::to_string(capacity)};
  long met = 0;
  for (int k = 0; k < kTicks; ++k) {
    bench.tick();
    const TickTask& rows = bench.rows();
    if (rows.rows < 0 || rows.rows > capacity)
      throw Broken{"it fills " + std::to_string(rows.rows) + " rows, but announced at most " +
                   std::to_string(capacity)};
    if (rows.jacobian.rows() != capacity || rows.jacobian.cols() != dof || rows.force.size() != capacity ||
        rows.acceleration.size() != capacity)
      throw Broken{"it changed the size of its storage"};
    if (!rows.J().allFinite() || !rows.F().allFinite()) throw Broken{"J or F is not finite"};
    if (rows.has_acceleration && !rows.acceleration.head(rows.rows).allFinite())
      throw Broken{"its acceleration is not finite"};
    if (!std::isfinite(bench.task().error())) throw Broken{"its error is not finite"};
    met += rows.rows;
  }
  if (met == 0)
    throw Broken{"it had no rows in any of " + std::to_string(kTicks) + " states: give a stack in which it has some"};
}

/// J against the differences of what the task says that it measures.
void checkToldJacobian(const TaskBench& bench, dynamics::DynamicsCache& from, dynamics::DynamicsCache& to) {
  const TickTask& rows = bench.rows();
  const Eigen::VectorXd q = bench.bench().robot().q(), qd = bench.bench().robot().qd();
  from.update(q, qd);
  Eigen::VectorXd forth(rows.rows), back(rows.rows);
  for (int joint = 0; joint < q.size(); ++joint) {
    Eigen::VectorXd there = q;
    there[joint] = q[joint] + kStep;
    to.update(there, qd);
    bench.task().displacement(from, to, forth);
    there[joint] = q[joint] - kStep;
    to.update(there, qd);
    bench.task().displacement(from, to, back);
    for (int row = 0; row < rows.rows; ++row) {
      const double measured = (forth[row] - back[row]) / (2 * kStep), said = rows.jacobian(row, joint);
      if (std::abs(measured - said) <= kDerivativeTolerance * (1 + std::abs(said))) continue;
      throw Broken{"row " + std::to_string(row + 1) + ", joint '" + from.model().jointNames()[joint] + "': J says " +
                   text(said) + ", differences of its displacement say " + text(measured)};
    }
  }
}

/// How much F and the error change for a unit motion along `direction`, from a fresh world each time.
Eigen::VectorXd sensitivity(const Subject& subject, int place, const Eigen::VectorXd& direction) {
  Eigen::VectorXd change;
  for (const double sign : {1.0, -1.0}) {
    TaskBench bench = before(subject, place);
    bench.tickAt([&](control::Sensed& sensed) {
      sensed.q += sign * kStep * direction;
      sensed.qd.setZero();
    });
    Eigen::VectorXd answer(bench.rows().rows + 1);
    answer << bench.rows().F(), bench.task().error();
    if (change.size() != 0 && change.size() != answer.size()) return Eigen::VectorXd::Zero(1);  // rows came or went
    change = change.size() == 0 ? answer : Eigen::VectorXd((change - answer) / (2 * kStep));
  }
  return change;
}

void checkUntoldJacobian(const Subject& subject, const TaskBench& bench, int place) {
  const Eigen::MatrixXd J = bench.rows().J();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeFullV);
  const int rank = static_cast<int>((svd.singularValues().array() > 1e-9 * svd.singularValues()[0]).count());
  const Eigen::MatrixXd unseen = svd.matrixV().rightCols(J.cols() - rank);
  const double most = sensitivity(subject, place, svd.matrixV().col(0)).cwiseAbs().maxCoeff();
  for (int k = 0; k < std::min<int>(4, unseen.cols()); ++k) {
    const double change = sensitivity(subject, place, unseen.col(k)).cwiseAbs().maxCoeff();
    if (change <= 1e-4 * (1 + most)) continue;
    throw Broken{"its force or error changes by " + text(change) +
                 " for a unit motion that J does not see; J is wrong, or tell the displacement (Task::displacement)"};
  }
}

void checkJacobian(const Subject& subject) {
  bool any = false;
  for (int place = 0; place < kPlaces; ++place) {
    TaskBench bench = before(subject, place);
    bench.tick();
    const int rows = bench.rows().rows;
    if (rows == 0) continue;
    any = true;
    dynamics::DynamicsCache from(bench.bench().robot().model(), subject.stack.gravity), to = from;
    from.update(bench.bench().robot().q(), bench.bench().robot().qd());
    Eigen::VectorXd displacement(rows);
    if (bench.task().displacement(from, from, displacement)) checkToldJacobian(bench, from, to);
    else checkUntoldJacobian(subject, bench, place);
  }
  if (!any) throw NotAsked{"it had no rows where it was asked"};
}

void checkBias(const Subject& subject) {
  bool any = false;
  for (int place = 0; place < kPlaces; ++place) {
    const auto at = [&](double speed, double along) {
      TaskBench bench = before(subject, place);
      bench.tickAt([&](control::Sensed& sensed) {
        sensed.q += along * sensed.qd;
        sensed.qd *= speed;
      });
      return bench;
    };
    const TaskBench forth = at(1, 0), back = at(-1, 0), still = at(0, 0), ahead = at(1, kStep), behind = at(1, -kStep);
    const int rows = forth.rows().rows;
    if (rows == 0 || !forth.rows().has_acceleration) continue;
    bool same_rows = true;
    for (const TaskBench* bench : {&back, &still, &ahead, &behind}) same_rows = same_rows && bench->rows().rows == rows;
    if (!same_rows) continue;
    any = true;
    const Eigen::VectorXd qd = forth.bench().robot().qd();
    const Eigen::VectorXd measured = (ahead.rows().J() - behind.rows().J()) * qd / (2 * kStep);
    const auto a = [&](const TaskBench& bench) { return bench.rows().acceleration.head(rows); };
    const Eigen::VectorXd said = a(still) - 0.5 * (a(forth) + a(back));
    for (int row = 0; row < rows; ++row) {
      if (std::abs(measured[row] - said[row]) <= 1e-5 * (1 + std::abs(measured[row]))) continue;
      throw Broken{"row " + std::to_string(row + 1) + ": its acceleration takes off " + text(said[row]) +
                   " for J̇q̇, differences of J say " + text(measured[row])};
    }
  }
  if (!any) throw NotAsked{"it asks for no accelerations"};
}

void checkFrame(const Subject& subject) {
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.rotate(Eigen::AngleAxisd(kTurn, Eigen::Vector3d::UnitZ())).pretranslate(Eigen::Vector3d(0.4, -0.3, 0.2));
  const dsl::Stack there_stack = movedStack(subject.stack, moved);
  TaskBench here(subject, 4), there(there_stack, subject, 4, moved);
  for (int k = 0; k < kTicks; ++k) {
    here.tick();
    there.tick();
    const std::string when = " in state " + std::to_string(k + 1) + "; values in world axes are marked by .in_world";
    if (here.rows().rows != there.rows().rows) throw Broken{"the moved robot has other rows" + when};
    const Eigen::VectorXd torque = here.torque();
    const double change = (torque - there.torque()).norm();
    if (change > 1e-7 * (1 + torque.norm()))
      throw Broken{"the moved robot's joint torques differ by " + text(change) + " of " + text(torque.norm()) + when};
    const Eigen::MatrixXd gram = here.rows().J().transpose() * here.rows().J();
    if ((gram - there.rows().J().transpose() * there.rows().J()).norm() > 1e-7 * (1 + gram.norm()))
      throw Broken{"the moved robot's rows see other motions" + when};
  }
}

void checkAllocation(const Subject& subject) {
  TaskBench bench(subject, 3);
  for (int k = 0; k < kTicks; ++k) {
    bench.tick();
    if (bench.allocations() != 0)
      throw Broken{"update " + std::to_string(k + 1) + " took memory " + std::to_string(bench.allocations()) +
                   " times"};
  }
}

/// Everything that the task says in so many ticks.
std::vector<double> trace(TaskBench& bench, int ticks = kTicks) {
  std::vector<control::LogColumn> columns;
  bench.task().columns(columns);
  std::vector<double> said;
  for (int k = 0; k < ticks; ++k) {
    bench.tick();
    const TickTask& rows = bench.rows();
    said.push_back(rows.rows);
    for (int row = 0; row < rows.rows; ++row) {
      for (int joint = 0; joint < rows.jacobian.cols(); ++joint) said.push_back(rows.jacobian(row, joint));
      said.push_back(rows.force[row]);
      if (rows.has_acceleration) said.push_back(rows.acceleration[row]);
    }
    said.push_back(bench.task().error());
    for (const control::LogColumn& column : columns) said.push_back(*column.value);
  }
  return said;
}

std::vector<double> trace(const Subject& subject, unsigned seed) {
  TaskBench bench(subject, seed);
  return trace(bench);
}

void checkDeterminism(const Subject& subject) {
  const std::vector<double> first = trace(subject, 2);
  trace(subject, 5);
  const std::vector<double> second = trace(subject, 2);
  if (first == second) return;
  throw Broken{"a second instance gave other numbers for the same inputs"};
}

void checkState(const Subject& subject) {
  TaskBench goes_on(subject, 2), restored(subject, 5);
  goes_on.tick(kTicks / 2);
  restored.tick(3 * kStretch);
  restored.goOnAs(goes_on);
  if (trace(goes_on, kTicks / 2) != trace(restored, kTicks / 2)) throw Broken{kArchivesTooLittle};
}

}  // namespace

void checkTask(const Subject& subject, Report& report) {
  const auto law = [&](const char* name, void (*check)(const Subject&)) {
    judge(subject, name, report, [&] { check(subject); });
  };
  law("rows", checkRows);
  if (report.findings.back().outcome == Outcome::broken) return;   // nothing can be said of rows that nobody can use
  law("jacobian", checkJacobian);
  law("bias", checkBias);
  law("frame", checkFrame);
  law("allocation", checkAllocation);
  law("determinism", checkDeterminism);
  if (report.findings.back().outcome == Outcome::kept) law("state", checkState);
}

}  // namespace tactus::conformance
