#include <array>
#include <cmath>
#include <random>

#include "conformance/allocation_count.h"
#include "conformance/laws.h"
#include "conformance/states.h"
#include "conformance/take_over.h"
#include "dsl/compile.h"
#include "framework/control/sensing_guard.h"

namespace tactus::conformance {
namespace {

constexpr int kTicks = 16 * kStretch;
constexpr std::uint64_t kSeed = 1;

/// One sensor of the stack, told what there is at random states: others read random numbers.
class SensorBench {
 public:
  SensorBench(const Subject& subject, unsigned states)
      : bench_(subject.stack, subject.registry), states_(subject.stack, states) {
    auto sensors = dsl::makeSensors(subject.stack, subject.registry, subject.stack.scene(kSeed), kSeed);
    for (runtime::NamedSensor& named : sensors) {
      int count = 0;
      for (const control::ReadingRow& row : named.rows) count += row.count;
      if (named.name == subject.name) {
        first_ = readings_;
        count_ = count;
        sensor_ = std::move(named);
      }
      readings_ += count;
    }
    felt_.contacts.reserve(control::SensingGuard::contact_capacity);
    felt_.readings.setZero(readings_);
    for (const int link : sensor_.sensor->wrenchLinks()) {
      control::LinkWrench wrench;
      wrench.link = link;
      bench_.sensed.wrenches.push_back(wrench);
    }
  }

  void tick() {
    states_.next(bench_);
    const auto random = [this] { return std::uniform_real_distribution<double>(-5, 5)(random_); };
    for (control::LinkWrench& wrench : bench_.sensed.wrenches) {
      for (double& number : wrench.force_L) number = random();
      for (double& number : wrench.moment_L) number = random();
    }
    const control::Sensed& truth = bench_.sensed;
    felt_.time = truth.time;
    felt_.q = truth.q;
    felt_.qd = truth.qd;
    felt_.contacts.assign(truth.contacts.begin(), truth.contacts.end());
    for (double& reading : felt_.readings) reading = random();
    const long before = allocationCount();
    sensor_.sensor->sense(truth, felt_, felt_.readings.segment(first_, count_));
    allocations_ = allocationCount() - before;
    bench_.endTick();
  }
  const control::Sensed& felt() const { return felt_; }
  int links() const { return static_cast<int>(bench_.robot().model().frames().size()); }
  int dof() const { return bench_.robot().dof(); }
  long allocations() const { return allocations_; }
  void tick(int times) {
    for (int k = 0; k < times; ++k) tick();
  }
  void archive(control::Archive& archive) {
    archive("bench", bench_);
    archive("sensor", *sensor_.sensor);
  }
  /// Goes on where another one stands.
  void goOnAs(SensorBench& other) {
    takeOver(other, *this);
    states_ = other.states_;
    random_ = other.random_;
  }

 private:
  Bench bench_;
  States states_;
  runtime::NamedSensor sensor_;
  control::Sensed felt_;
  int readings_ = 0;                                               // of all sensors
  int first_ = 0, count_ = 0;                                      // of this one
  std::mt19937 random_{1};
  long allocations_ = 0;
};

void checkFelt(const Subject& subject) {
  SensorBench bench(subject, 1);
  for (int k = 0; k < kTicks; ++k) {
    bench.tick();
    const control::Sensed& felt = bench.felt();
    if (felt.q.size() != bench.dof() || felt.qd.size() != bench.dof()) throw Broken{"it changed the number of joints"};
    for (const double reading : felt.readings)
      if (std::isinf(reading)) throw Broken{"a reading is infinite; NaN says that there is none"};
    for (const control::ContactRecord& contact : felt.contacts)
      if (contact.link < 0 || contact.link >= bench.links())
        throw Broken{"it feels a contact at link " + std::to_string(contact.link) + ", which the robot does not have"};
  }
}

void checkAllocation(const Subject& subject) {
  SensorBench bench(subject, 3);
  for (int k = 0; k < kTicks; ++k) {
    bench.tick();
    if (bench.allocations() != 0)
      throw Broken{"tick " + std::to_string(k + 1) + " took memory " + std::to_string(bench.allocations()) + " times"};
  }
}

std::vector<double> trace(SensorBench& bench, int ticks = kTicks) {
  std::vector<double> said;
  const auto add = [&said](const auto& numbers) {
    for (const double number : numbers) said.push_back(std::isnan(number) ? -1e300 : number);
  };
  for (int k = 0; k < ticks; ++k) {
    bench.tick();
    add(bench.felt().q);
    add(bench.felt().qd);
    add(bench.felt().readings);
    for (const control::ContactRecord& contact : bench.felt().contacts) {
      said.push_back(contact.link);
      add(std::array{contact.force_N, contact.depth});
      add(contact.point_W);
      add(contact.normal_W);
    }
  }
  return said;
}

std::vector<double> trace(const Subject& subject, unsigned states) {
  SensorBench bench(subject, states);
  return trace(bench);
}

void checkState(const Subject& subject) {
  SensorBench goes_on(subject, 2), restored(subject, 5);
  goes_on.tick(kTicks / 2);
  restored.tick(3 * kStretch);
  restored.goOnAs(goes_on);
  if (trace(goes_on, kTicks / 2) != trace(restored, kTicks / 2)) throw Broken{kArchivesTooLittle};
}

void checkDeterminism(const Subject& subject) {
  const std::vector<double> first = trace(subject, 2);
  trace(subject, 5);
  if (first != trace(subject, 2)) throw Broken{"a second instance of the same seed felt something else"};
}

}  // namespace

void checkSensor(const Subject& subject, Report& report) {
  judge(subject, "felt", report, [&] { checkFelt(subject); });
  judge(subject, "allocation", report, [&] { checkAllocation(subject); });
  judge(subject, "determinism", report, [&] { checkDeterminism(subject); });
  if (report.findings.back().outcome == Outcome::kept)
    judge(subject, "state", report, [&] { checkState(subject); });
}

}  // namespace tactus::conformance
