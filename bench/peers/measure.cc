#include "bench/peers/measure.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <limits>

namespace tactus::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int blocks = 30;

/// How often the scheduler took the processor from this thread.
long preemptions() {
  rusage usage;
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols() || !a.allFinite() || !b.allFinite())
    return std::numeric_limits<double>::infinity();
  if (a.size() == 0) return 0;
  return (a - b).cwiseAbs().maxCoeff() / a.cwiseAbs().maxCoeff();
}

/// One engine at one operation: cycles the states, keeps the samples.
class Run {
 public:
  Run(Engine& engine, Operation operation, const Effort& effort)
      : engine_(engine), operation_(operation), samples_(effort.samples), calls_(effort.calls) {
    sample(calls_);
    const double call_us = std::max(sample(calls_), 0.01);         // after the warm-up
    const double affordable = effort.budget_s * 1e6 / call_us;     // calls
    if (affordable >= static_cast<double>(samples_) * calls_) return;
    samples_ = std::clamp(static_cast<int>(affordable / calls_), std::min(samples_, 10 * blocks), samples_);
    calls_ = std::clamp(static_cast<int>(affordable / samples_), 1, calls_);
  }

  void block() {
    sample(calls_);                                                // finds the caches as another engine left them
    for (int k = 0; k < (samples_ + blocks - 1) / blocks; ++k) microseconds_.push_back(undisturbedSample());
  }

  Timing timing() {
    std::ranges::sort(microseconds_);
    const auto at = [&](double share) {
      return microseconds_[static_cast<size_t>(share * static_cast<double>(microseconds_.size() - 1))];
    };
    return {at(0.5), at(0.99), static_cast<int>(microseconds_.size()), calls_};
  }

 private:
  /// On a busy machine the scheduler's time slices, milliseconds, would be the 99th percentile of every engine: what
  /// it interrupted is taken again.
  double undisturbedSample() {
    for (int attempt = 0;; ++attempt) {
      const long before = preemptions();
      const double us = sample(calls_);
      if (preemptions() == before || attempt == 4) return us;
    }
  }

  /// Microseconds a call.
  double sample(int calls) {
    const Clock::time_point start = Clock::now();
    for (int k = 0; k < calls; ++k) {
      engine_.run(operation_, state_);
      state_ = (state_ + 1) % state_count;
    }
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count() / calls;
  }

  Engine& engine_;
  Operation operation_;
  int samples_, calls_, state_ = 0;
  std::vector<double> microseconds_;
};

}  // namespace

double relativeDifference(Engine& reference, Engine& engine, Operation operation) {
  double worst = 0;
  for (int state = 0; state < state_count; ++state) {
    reference.run(operation, state);
    engine.run(operation, state);
    const Results a = reference.results(operation, state), b = engine.results(operation, state);
    worst = std::max({worst, difference(a.vector, b.vector), difference(a.mass_matrix, b.mass_matrix),
                      difference(a.jacobians, b.jacobians)});
  }
  return worst;
}

std::vector<Timing> measure(const std::vector<Engine*>& engines, Operation operation, const Effort& effort) {
  std::vector<Run> runs;
  for (Engine* engine : engines) runs.emplace_back(*engine, operation, effort);
  for (int block = 0; block < blocks; ++block)
    for (Run& run : runs) run.block();
  std::vector<Timing> timings;
  for (Run& run : runs) timings.push_back(run.timing());
  return timings;
}

}  // namespace tactus::bench
