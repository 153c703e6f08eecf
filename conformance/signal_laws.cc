#include <cmath>
#include <map>

#include "conformance/allocation_count.h"
#include "conformance/laws.h"
#include "conformance/states.h"
#include "conformance/take_over.h"

namespace tactus::conformance {
namespace {

constexpr int kTicks = 16 * kStretch;

class SignalBench {
 public:
  SignalBench(const Subject& subject, unsigned seed)
      : bench_(subject.stack, subject.registry), states_(subject.stack, seed), subject_(subject) {}

  void tick() {
    states_.next(bench_);
    const control::Tick tick = bench_.sense();
    for (const control::NamedSignal& signal : bench_.signals()) {
      const long before = allocationCount();
      signal.signal->update(tick);
      if (signal.name == subject_.name) allocations_ = allocationCount() - before;
    }
    bench_.endTick();
  }
  const control::Signal& signal() const { return bench_.signal(subject_.name); }
  std::vector<control::PortRow> ports() const {
    for (const dsl::ElementInstance& signal : subject_.stack.signals)
      if (signal.name == subject_.name) return signal.values.ports();
    return {};
  }
  long allocations() const { return allocations_; }
  void tick(int times) {
    for (int k = 0; k < times; ++k) tick();
  }
  /// Goes on where another one stands.
  void goOnAs(SignalBench& other) {
    takeOver(other.bench_, bench_);
    states_ = other.states_;
  }

 private:
  Bench bench_;
  States states_;
  const Subject& subject_;
  long allocations_ = 0;
};

bool isScalar(const control::PortRow& port) { return port.type == control::PortType<double>::name; }

void checkPorts(const Subject& subject) {
  SignalBench bench(subject, 1);
  std::map<std::string, const void*> addresses;
  for (const control::PortRow& port : bench.ports()) {
    const void* value = bench.signal().port(port.name);
    if (!value) throw Broken{"nothing stands behind the declared port '" + port.name + "'"};
    addresses[port.name] = value;
  }
  for (int k = 0; k < kTicks; ++k) {
    bench.tick();
    for (const control::PortRow& port : bench.ports()) {
      const void* value = bench.signal().port(port.name);
      if (value != addresses[port.name]) throw Broken{"port '" + port.name + "' moved to another address"};
      if (isScalar(port) && !std::isfinite(*static_cast<const double*>(value)))
        throw Broken{"port '" + port.name + "' is not finite"};
    }
  }
}

void checkAllocation(const Subject& subject) {
  SignalBench bench(subject, 3);
  for (int k = 0; k < kTicks; ++k) {
    bench.tick();
    if (bench.allocations() != 0)
      throw Broken{"update " + std::to_string(k + 1) + " took memory " + std::to_string(bench.allocations()) +
                   " times"};
  }
}

std::vector<double> trace(SignalBench& bench, int ticks = kTicks) {
  std::vector<control::LogColumn> columns;
  bench.signal().columns(columns);
  std::vector<double> said;
  for (int k = 0; k < ticks; ++k) {
    bench.tick();
    for (const control::PortRow& port : bench.ports())
      if (isScalar(port)) said.push_back(*static_cast<const double*>(bench.signal().port(port.name)));
    for (const control::LogColumn& column : columns) said.push_back(*column.value);
  }
  return said;
}

std::vector<double> trace(const Subject& subject, unsigned seed) {
  SignalBench bench(subject, seed);
  return trace(bench);
}

void checkDeterminism(const Subject& subject) {
  const std::vector<double> first = trace(subject, 2);
  trace(subject, 5);
  if (first != trace(subject, 2)) throw Broken{"a second instance gave other numbers for the same inputs"};
}

void checkState(const Subject& subject) {
  SignalBench goes_on(subject, 2), restored(subject, 5);
  goes_on.tick(kTicks / 2);
  restored.tick(3 * kStretch);
  restored.goOnAs(goes_on);
  if (trace(goes_on, kTicks / 2) != trace(restored, kTicks / 2)) throw Broken{kArchivesTooLittle};
}

}  // namespace

void checkSignal(const Subject& subject, Report& report) {
  judge(subject, "ports", report, [&] { checkPorts(subject); });
  if (report.findings.back().outcome == Outcome::broken) return;   // nobody can read them
  judge(subject, "allocation", report, [&] { checkAllocation(subject); });
  judge(subject, "determinism", report, [&] { checkDeterminism(subject); });
  if (report.findings.back().outcome == Outcome::kept)
    judge(subject, "state", report, [&] { checkState(subject); });
}

}  // namespace tactus::conformance
