#include <cmath>

#include "conformance/allocation_count.h"
#include "conformance/laws.h"
#include "conformance/states.h"
#include "conformance/take_over.h"

namespace tactus::conformance {
namespace {

constexpr int kTicks = 16 * kStretch;

const control::Level& levelOf(const Bench& bench, const std::string& name) {
  for (const control::Level& level : bench.controller().levels())
    if (level.owner.name == name) return level;
  throw Broken{"the stack has no controller '" + name + "'"};
}

/// What a controller tells in a run of random states: its columns and the forces of its tasks.
std::vector<double> trace(const Subject& subject, Bench& bench, States& states, int ticks) {
  const control::Level& level = levelOf(bench, subject.name);
  std::vector<control::LogColumn> columns;
  level.owner.controller->columns(columns);
  std::vector<double> said;
  for (int k = 0; k < ticks; ++k) {
    states.next(bench);
    bench.tick();
    for (const control::LogColumn& column : columns) said.push_back(*column.value);
    for (const control::NamedTask& owned : level.tasks)
      for (const double force : bench.rows(owned.name).F()) said.push_back(force);
  }
  return said;
}

std::vector<double> trace(const Subject& subject, unsigned seed) {
  Bench bench(subject.stack, subject.registry);
  States states(subject.stack, seed);
  return trace(subject, bench, states, kTicks);
}

void checkState(const Subject& subject) {
  Bench goes_on(subject.stack, subject.registry), restored(subject.stack, subject.registry);
  States states(subject.stack, 2), others(subject.stack, 5);
  trace(subject, goes_on, states, kTicks / 2);
  trace(subject, restored, others, 3 * kStretch);
  takeOver(goes_on, restored);
  States again = states;
  if (trace(subject, goes_on, states, kTicks / 2) != trace(subject, restored, again, kTicks / 2))
    throw Broken{kArchivesTooLittle};
}

void checkDeterminism(const Subject& subject) {
  const std::vector<double> first = trace(subject, 2);
  trace(subject, 5);
  if (first != trace(subject, 2)) throw Broken{"a second instance gave other numbers for the same inputs"};
}

void checkAllocation(const Subject& subject) {
  Bench bench(subject.stack, subject.registry);
  States states(subject.stack, 3);
  control::LevelController& controller = *levelOf(bench, subject.name).owner.controller;
  for (int k = 0; k < kTicks; ++k) {
    states.next(bench);
    const control::Tick tick = bench.sense();
    for (const control::NamedSignal& signal : bench.signals()) signal.signal->update(tick);
    const long before = allocationCount();
    controller.update(tick);
    if (allocationCount() != before) throw Broken{"update " + std::to_string(k + 1) + " took memory"};
    bench.endTick();
  }
}

void checkTasks(const Subject& subject, Report& report) {
  const Bench bench(subject.stack, subject.registry);
  for (const control::NamedTask& owned : levelOf(bench, subject.name).tasks)
    checkTask({subject.stack, subject.registry, subject.element, owned.name}, report);
}

}  // namespace

void checkController(const Subject& subject, Report& report) {
  judge(subject, "tasks", report, [&] {
    const Bench bench(subject.stack, subject.registry);
    if (levelOf(bench, subject.name).tasks.empty()) throw Broken{"it owns no task"};
  });
  if (report.findings.back().outcome == Outcome::broken) return;
  judge(subject, "allocation", report, [&] { checkAllocation(subject); });
  judge(subject, "determinism", report, [&] { checkDeterminism(subject); });
  if (report.findings.back().outcome == Outcome::kept)
    judge(subject, "state", report, [&] { checkState(subject); });
  checkTasks(subject, report);
}

}  // namespace tactus::conformance
