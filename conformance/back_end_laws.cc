#include <cmath>

#include "conformance/laws.h"
#include "conformance/states.h"
#include "dsl/compile.h"

namespace tactus::conformance {
namespace {

constexpr int kTicks = 4 * kStretch;

/// The back end, fed with the tick problems of the stack at random states.  `see` gets each problem with its answer.
template <class See>
void solveAll(const Subject& subject, unsigned seed, See see) {
  Bench bench(subject.stack, subject.registry);
  States states(subject.stack, seed);
  const auto controller = dsl::compile(subject.stack, subject.registry);
  for (int k = 0; k < kTicks; ++k) {
    states.next(bench);
    bench.endTick();
    controller->tick(bench.sensed);
    see(*controller);
  }
}

void checkTorque(const Subject& subject) {
  int solved = 0;
  solveAll(subject, 1, [&](const control::Controller& controller) {
    const control::TickSolution& solution = controller.solution();
    const control::TickProblem& problem = controller.problem();
    if (solution.torque.size() != problem.dof) throw Broken{"its torque has another size than the problem"};
    // The controller takes a torque that is not finite away, and falls back.
    if (solution.status == control::Status::ok && controller.record().fallback)
      throw Broken{"its torque is not finite"};
    if (solution.status != control::Status::ok) {
      if (solution.message.empty()) throw Broken{"it did not solve a tick and says nothing about it"};
      return;
    }
    ++solved;
    if (!controller.backEnd().abilities().torque_limits || !problem.torque_limits) return;
    const Eigen::ArrayXd above = solution.torque - problem.torque_limits->upper;
    const Eigen::ArrayXd below = problem.torque_limits->lower - solution.torque;
    if (std::max(above.maxCoeff(), below.maxCoeff()) > 1e-6)
      throw Broken{"it says that it honours torque limits, and its torque is beyond them"};
  });
  if (solved == 0) throw Broken{"it solved none of " + std::to_string(kTicks) + " ticks"};
}

std::vector<double> trace(const Subject& subject, unsigned seed) {
  std::vector<double> said;
  solveAll(subject, seed, [&](const control::Controller& controller) {
    for (const double torque : controller.solution().torque) said.push_back(torque);
    said.push_back(static_cast<double>(controller.solution().status));
  });
  return said;
}

void checkDeterminism(const Subject& subject) {
  const std::vector<double> first = trace(subject, 2);
  trace(subject, 5);
  if (first != trace(subject, 2)) throw Broken{"a second instance gave another torque for the same problems"};
}

}  // namespace

void checkBackEnd(const Subject& subject, Report& report) {
  judge(subject, "torque", report, [&] { checkTorque(subject); });
  if (report.findings.back().outcome == Outcome::broken) return;
  judge(subject, "determinism", report, [&] { checkDeterminism(subject); });
}

}  // namespace tactus::conformance
