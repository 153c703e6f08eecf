#include <cmath>

#include "conformance/allocation_count.h"
#include "conformance/laws.h"
#include "conformance/states.h"
#include "conformance/take_over.h"
#include "dsl/compile.h"
#include "framework/runtime/measures.h"

namespace tactus::conformance {
namespace {

constexpr int kTicks = 16 * kStretch;
constexpr std::uint64_t kSeed = 1;

/// One measure of the stack, beside a controller at random states; objects stay where they are.
class MeasureBench {
 public:
  MeasureBench(const Subject& subject, unsigned states)
      : scene_(subject.stack.scene(kSeed)),
        start_q_(subject.stack.start(kSeed)),
        controller_(dsl::compile(subject.stack, subject.registry)),
        bench_(subject.stack, subject.registry),
        states_(subject.stack, states) {
    for (const description::Object& object : scene_.objects) objects_.push_back({object.pose});
    for (auto& named : dsl::makeMeasures(subject.stack, subject.registry, *controller_, scene_, start_q_))
      if (named.name == subject.name) measure_ = std::move(named.measure);
    measure_->columns(columns_);
  }

  void tick() {
    states_.next(bench_);
    const Eigen::VectorXd& torque = controller_->tick(bench_.sensed);
    const long before = allocationCount();
    measure_->observe({bench_.sensed, bench_.sensed, *controller_, torque, 1, objects_});
    allocations_ = allocationCount() - before;
    bench_.endTick();
  }
  void tick(int times) {
    for (int k = 0; k < times; ++k) tick();
  }
  const std::vector<control::LogColumn>& columns() const { return columns_; }
  std::vector<control::Metric> metrics() const {
    std::vector<control::Metric> metrics;
    measure_->metrics(metrics);
    return metrics;
  }
  long allocations() const { return allocations_; }
  void archive(control::Archive& archive) {
    archive("bench", bench_);
    archive("controller", *controller_);
    archive("measure", *measure_);
  }
  /// Goes on where another one stands.
  void goOnAs(MeasureBench& other) {
    takeOver(other, *this);
    states_ = other.states_;
  }

 private:
  description::Scene scene_;
  Eigen::VectorXd start_q_;
  std::unique_ptr<control::Controller> controller_;
  Bench bench_;
  States states_;
  std::vector<control::ObjectMotion> objects_;
  std::unique_ptr<control::Measure> measure_;
  std::vector<control::LogColumn> columns_;
  long allocations_ = 0;
};

/// Figures are not asked for in every tick: they may be long work.
bool isAsked(int tick) { return tick % 10 == 9; }

void checkFigures(const Subject& subject) {
  MeasureBench bench(subject, 1);
  const std::vector<control::Metric> at_first = bench.metrics();
  if (at_first.empty() && bench.columns().empty()) throw Broken{"it has no figure and no column"};
  for (int k = 0; k < kTicks; ++k) {
    bench.tick();
    if (!isAsked(k)) continue;
    const std::vector<control::Metric> now = bench.metrics();
    if (now.size() != at_first.size()) throw Broken{"it has other figures after some ticks than before the first"};
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (now[i].name != at_first[i].name) throw Broken{"its figure '" + at_first[i].name + "' becomes '" + now[i].name + "'"};
      if (std::isinf(now[i].value)) throw Broken{"its figure '" + now[i].name + "' is infinite; NaN says that there is none"};
    }
  }
}

void checkAllocation(const Subject& subject) {
  MeasureBench bench(subject, 3);
  for (int k = 0; k < kTicks; ++k) {
    bench.tick();
    if (bench.allocations() != 0)
      throw Broken{"tick " + std::to_string(k + 1) + " took memory " + std::to_string(bench.allocations()) + " times"};
  }
}

std::vector<double> trace(MeasureBench& bench, int ticks) {
  std::vector<double> said;
  const auto add = [&said](double number) { said.push_back(std::isnan(number) ? -1e300 : number); };
  for (int k = 0; k < ticks; ++k) {
    bench.tick();
    for (const control::LogColumn& column : bench.columns()) add(*column.value);
    if (!isAsked(k)) continue;
    for (const control::Metric& metric : bench.metrics()) add(metric.value);
  }
  return said;
}

std::vector<double> trace(const Subject& subject, unsigned states) {
  MeasureBench bench(subject, states);
  return trace(bench, kTicks);
}

void checkDeterminism(const Subject& subject) {
  const std::vector<double> first = trace(subject, 2);
  trace(subject, 5);
  if (first != trace(subject, 2)) throw Broken{"a second instance said something else of the same ticks"};
}

void checkState(const Subject& subject) {
  MeasureBench goes_on(subject, 2), restored(subject, 5);
  goes_on.tick(kTicks / 2);
  restored.tick(3 * kStretch);
  restored.goOnAs(goes_on);
  if (trace(goes_on, kTicks / 2) != trace(restored, kTicks / 2)) throw Broken{kArchivesTooLittle};
}

}  // namespace

void checkMeasure(const Subject& subject, Report& report) {
  judge(subject, "figures", report, [&] { checkFigures(subject); });
  judge(subject, "allocation", report, [&] { checkAllocation(subject); });
  judge(subject, "determinism", report, [&] { checkDeterminism(subject); });
  if (report.findings.back().outcome == Outcome::kept)
    judge(subject, "state", report, [&] { checkState(subject); });
}

}  // namespace tactus::conformance
