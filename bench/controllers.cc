// Controllers in real time: whole ticks (dynamics, signals, tasks, solve) and solves alone, medians and tails, beside
// MuJoCo's tick set in the same run.  docs/benchmarks.md says what is timed and how to read the table.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <regex>

#include "bench/peers/engine.h"
#include "bench/tick_cases.h"
#include "plugins/hqp/hqp.h"
#include "plugins/qp/active_set.h"
#include "tests/dynamics/robots.h"

namespace tactus::bench {
namespace {

using Clock = std::chrono::steady_clock;

struct Timing {
  double median_us = 0, p99_us = 0, p999_us = 0;
};

long preemptions() {
  rusage usage;
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

/// Each call timed alone; what the scheduler interrupted is taken again.
Timing measure(const std::function<void(int)>& call, int samples) {
  for (int k = 0; k < 200; ++k) call(k);
  std::vector<double> microseconds;
  microseconds.reserve(samples);
  for (int k = 0; static_cast<int>(microseconds.size()) < samples; ++k) {
    const long before = preemptions();
    const auto start = Clock::now();
    call(k);
    const double us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
    if (preemptions() == before) microseconds.push_back(us);
  }
  std::ranges::sort(microseconds);
  const auto at = [&](double share) {
    return microseconds[static_cast<std::size_t>(share * static_cast<double>(microseconds.size() - 1))];
  };
  return {at(0.5), at(0.99), at(0.999)};
}

std::vector<BackEndChoice> ownBackEnds() {
  return {{"null-space/augmented", "null-space", {{"projection", "augmented"}}},
          {"null-space/successive", "null-space", {{"projection", "successive"}}},
          {"null-space/consistent", "null-space", {{"projection", "consistent"}}},
          {"qp/active-set", "qp", {{"solver", "active-set"}, {"metric", "inertia"}}},
          {"qp/active-set/torque", "qp", {{"solver", "active-set"}, {"objective", "torque"}}},
          {"hqp", "hqp", {}}};
}

std::vector<BackEndChoice> referenceBackEnds() {
  return {{"qp/nlopt", "qp", {{"solver", "nlopt"}, {"metric", "inertia"}}},
          {"qp/ipopt", "qp", {{"solver", "ipopt"}, {"metric", "inertia"}}}};
}

struct Figure {
  std::string what, back_end;
  Timing timing;
  double steps = 0;                                                ///< of the solver, mean
  int failures = 0;
  std::optional<double> target_multiple;                           ///< of MuJoCo's tick set in this run
  std::optional<double> target_us;
};

/// Whole ticks at 23 joints, as multiples of MuJoCo's tick set there.
std::optional<double> targetMultiple(const std::string& what, const std::string& back_end) {
  if (what == "lwr_allegro, 12 contacts") {
    if (back_end == "null-space/augmented" || back_end == "null-space/successive") return 4;
    if (back_end == "qp/active-set") return 5.4;
    if (back_end == "hqp") return 26;
  }
  if (what == "lwr_allegro, 6 contacts" && back_end == "hqp") return 14;
  return {};
}

Figure measureTick(const TickCase& tick_case, const BackEndChoice& choice, int samples) {
  const std::unique_ptr<control::Controller> controller = tick_case.controller(choice);
  controller->backEnd().setReportsRanks(false);                    // the log's, which no torque depends on
  Figure figure{tick_case.name(), choice.label, {}, 0, 0, targetMultiple(tick_case.name(), choice.label), {}};
  if (tick_case.name().starts_with("arm,")) figure.target_us = 8;
  int calls = 0;
  figure.timing = measure(
      [&](int k) {
        controller->tick(tick_case.sensed(k));
        ++calls;
        figure.steps += controller->solution().iterations;
        figure.failures += controller->record().status != control::Status::ok;
      },
      samples);
  figure.steps /= calls;
  return figure;
}

// ---- Solves alone, from assembled matrices.

std::string aloneName(const std::string& what, int contacts) {
  return what + " alone, " + std::to_string(contacts) + " contacts";
}

Eigen::MatrixXd gaussian(std::mt19937& random, int rows, int columns) {
  std::normal_distribution<> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

/// A robot's numbers that vary smoothly: 23 joints, N_c contact rows, 6 rows of a hand, 23 of a posture.
struct Sequence {
  static constexpr int dof = 23, length = 1000;

  Sequence(int contacts, unsigned seed) : random(seed) {
    const Eigen::MatrixXd A = gaussian(random, dof, dof);
    M0 = 0.3 * A * A.transpose() / dof + 0.1 * Eigen::MatrixXd::Identity(dof, dof);
    const Eigen::MatrixXd B = gaussian(random, dof, dof);
    M1 = 0.03 * (B + B.transpose()) / dof;
    Jc = gaussian(random, contacts, dof);
    Jc1 = 0.2 * gaussian(random, contacts, dof);
    Jh = gaussian(random, 6, dof);
    Jh1 = 0.2 * gaussian(random, 6, dof);
    phase = 3 * gaussian(random, 2 * dof + contacts + 6, 1);
  }
  double wave(int k, int i) const { return std::sin(2 * M_PI * k / length + phase[i]); }
  Eigen::MatrixXd massMatrix(int k) const { return M0 + wave(k, 0) * M1; }
  Eigen::MatrixXd contactRows(int k) const { return Jc + wave(k, 1) * Jc1; }
  Eigen::MatrixXd handRows(int k) const { return Jh + wave(k, 2) * Jh1; }

  std::mt19937 random;
  Eigen::MatrixXd M0, M1, Jc, Jc1, Jh, Jh1;
  Eigen::VectorXd phase;
};

/// The thesis's programme, reduced: min w ‖τ − τ°‖² + 1e-3 ‖f‖², J M⁻¹ τ = 0, |τ + Jᵀf| ≤ 8, 0 ≤ f ≤ 20.
std::vector<qp::Programme> weightedProgrammes(int contacts) {
  const Sequence sequence(contacts, 1);
  constexpr int n = Sequence::dof;
  std::vector<qp::Programme> programmes;
  for (int k = 0; k < Sequence::length; ++k) {
    qp::Programme p;
    p.dense = n;
    p.variables = n + contacts;
    p.F.resize(0, n);
    p.ridge.setConstant(p.variables, std::sqrt(1e-3));
    p.ridge.head(n).setConstant(std::sqrt(1 / (1 / 1.0 + 1 / 0.1)));
    p.reference.setZero(p.variables);
    for (int i = 0; i < n; ++i) p.reference[i] = 6 * sequence.wave(k, 3 + i) + 3 * sequence.wave(3 * k, i);
    p.rows = 2 * contacts + n;
    p.A.setZero(p.variables, p.rows);
    p.lower.setZero(p.rows);
    p.upper.setZero(p.rows);
    const Eigen::MatrixXd J = sequence.contactRows(k);
    const Eigen::MatrixXd JMinv = sequence.massMatrix(k).llt().solve(J.transpose()).transpose();
    p.A.topLeftCorner(n, contacts) = JMinv.transpose();
    p.A.block(0, contacts, n, n).setIdentity();
    p.A.block(n, contacts, contacts, n) = J;
    p.lower.segment(contacts, n).setConstant(-8);
    p.upper.segment(contacts, n).setConstant(8);
    p.A.block(n, contacts + n, contacts, contacts).setIdentity();
    p.upper.tail(contacts).setConstant(20);
    programmes.push_back(p);
  }
  return programmes;
}

Figure measureWeightedSolve(int contacts, double target_us, int samples) {
  const std::vector<qp::Programme> programmes = weightedProgrammes(contacts);
  const qp::Programme& shape = programmes[0];
  qp::ActiveSet solver(shape.variables, shape.dense, 0, shape.rows);
  Figure figure{aloneName("weighted QP", contacts), "active-set", {}, 0, 0, {}, target_us};
  std::vector<int> start;
  start.reserve(2 * shape.rows);
  int calls = 0;
  figure.timing = measure(
      [&](int k) {
        for (const int row : start) solver.guess(std::abs(row) - 1, row);
        const auto outcome = solver.solve(programmes[k % Sequence::length]);
        start.clear();
        for (int i = 0; i < solver.activeCount(); ++i) start.push_back(solver.side(i) * (solver.active(i) + 1));
        figure.steps += solver.activeCount();
        figure.failures += outcome != qp::ActiveSet::Outcome::solved;
        ++calls;
      },
      samples);
  figure.steps /= calls;
  return figure;
}

struct HierarchyCase {
  int contacts;
  double hand, posture;                                            ///< amplitudes of the accelerations asked for
  double target_us;
};

/// Amplitudes that bring 7 to 15 limits to their bounds: with fewer directions left for the posture it has to ask for
/// more, and beside 12 contacts the hand too.
constexpr HierarchyCase hierarchy_cases[] = {{0, 30, 80, 9}, {3, 30, 100, 31}, {6, 40, 300, 36}, {12, 500, 250, 75}};

/// Torque limits > contacts > hand > posture.
Figure measureHierarchySolve(const HierarchyCase& hierarchy, int samples) {
  const int contacts = hierarchy.contacts;
  const Sequence sequence(contacts, 2);
  constexpr int n = Sequence::dof;
  std::vector<control::TickProblem> problems;
  for (int k = 0; k < Sequence::length; ++k) {
    control::TickProblem problem;
    problem.dof = n;
    problem.mass_matrix = sequence.massMatrix(k);
    const Eigen::VectorXd limit = Eigen::VectorXd::Constant(n, 8);
    problem.torque_limits = control::TorqueLimits{-limit, limit, {}};
    control::TickTask touch("touch", contacts, n), hand("hand", 6, n), posture("posture", n, n);
    touch.jacobian = sequence.contactRows(k);
    touch.force.setConstant(0.5);
    hand.jacobian = sequence.handRows(k);
    for (int i = 0; i < 6; ++i) hand.acceleration[i] = hierarchy.hand * sequence.wave(k, i + 3);
    posture.jacobian.setIdentity();
    for (int i = 0; i < n; ++i)
      posture.acceleration[i] = hierarchy.posture * (sequence.wave(k, i + 9) + 0.45 * sequence.wave(3 * k, i));
    hand.has_acceleration = posture.has_acceleration = true;
    int priority = 1;
    for (control::TickTask* task : {&touch, &hand, &posture}) {
      if (task->capacity() == 0) continue;
      task->rows = task->capacity();
      problem.levels.push_back({priority++, {}, {*task}});
    }
    problems.push_back(problem);
  }
  hqp::Hqp back_end;
  back_end.setReportsRanks(false);                                 // as in whole ticks
  control::TickSolution solution;
  back_end.prepare(problems[0], solution);
  Figure figure{aloneName("hierarchy", contacts), "hqp", {}, 0, 0, {}, hierarchy.target_us};
  int calls = 0;
  figure.timing = measure(
      [&](int k) {
        const control::TickProblem& problem = problems[k % Sequence::length];
        back_end.solve(problem, solution);
        figure.failures += solution.status != control::Status::ok;
        for (int i = 0; i < n; ++i) figure.steps += std::abs(std::abs(solution.torque[i]) - 8) < 1e-9;
        ++calls;
      },
      samples);
  figure.steps /= calls;
  return figure;
}

// ---- The table.

std::optional<Timing> mujocoTick(int samples) {
  const Problem problem("lwr_allegro", test_robots::lwrAllegro());
  for (const std::unique_ptr<Engine>& engine : makeEngines(problem))
    if (engine->name().starts_with("MuJoCo"))
      return measure([&](int k) { engine->run(Operation::tick, k % state_count); }, samples);
  return {};
}

void print(const Figure& figure, const std::optional<Timing>& mujoco) {
  std::printf("%-36s %-22s %9.2f %9.2f %9.2f %8.2f %6.1f", figure.what.c_str(), figure.back_end.c_str(),
              figure.timing.median_us, figure.timing.p99_us, figure.timing.p999_us,
              mujoco ? figure.timing.median_us / mujoco->median_us : NAN, figure.steps);
  const auto verdict = [](bool met) { return met ? "met" : "MISSED"; };
  if (figure.target_multiple && mujoco)
    std::printf("  <= %g x MuJoCo %s", *figure.target_multiple,
                verdict(figure.timing.median_us <= *figure.target_multiple * mujoco->median_us));
  if (figure.target_us) std::printf("  <= %g us %s", *figure.target_us, verdict(figure.timing.median_us <= *figure.target_us));
  if (figure.failures > 0) std::printf("  %d FAILED", figure.failures);
  std::printf("\n");
  std::fflush(stdout);
}

nlohmann::ordered_json toJson(const Figure& figure, const std::optional<Timing>& mujoco) {
  nlohmann::ordered_json json = {{"what", figure.what},
                                 {"back_end", figure.back_end},
                                 {"median_us", figure.timing.median_us},
                                 {"p99_us", figure.timing.p99_us},
                                 {"p999_us", figure.timing.p999_us},
                                 {"steps", figure.steps},
                                 {"failures", figure.failures}};
  if (mujoco) json["multiple_of_mujoco_tick"] = figure.timing.median_us / mujoco->median_us;
  if (figure.target_multiple) json["target_multiple"] = *figure.target_multiple;
  if (figure.target_us) json["target_us"] = *figure.target_us;
  return json;
}

struct Options {
  bool json = false, quick = false;
  std::string filter;
};

int run(const Options& options) {
  const int samples = options.quick ? 3000 : 20000;
  const std::regex filter(options.filter);
  const auto wanted = [&](const std::string& what, const std::string& back_end) {
    return std::regex_search(what + "/" + back_end, filter);
  };
  const std::optional<Timing> mujoco = mujocoTick(samples);
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  int failures = 0;
  const auto add = [&](const Figure& figure) {
    failures += figure.failures;
    if (options.json)
      figures.push_back(toJson(figure, mujoco));
    else
      print(figure, mujoco);
  };
  if (!options.json) {
    std::printf("%d calls each, timed one by one, one thread.  ", samples);
    if (mujoco)
      std::printf("MuJoCo's tick set (lwr_allegro: M, bias, 12 point Jacobians): %.2f us.\n", mujoco->median_us);
    else
      std::printf("MuJoCo was not found: no multiples.\n");
    std::printf("%-36s %-22s %9s %9s %9s %8s %6s\n", "whole tick", "back end", "median us", "p99", "p99.9", "/ MuJoCo",
                "steps");
  }
  for (const std::unique_ptr<TickCase>& tick_case : tickCases()) {
    for (const BackEndChoice& back_end : ownBackEnds())
      if (wanted(tick_case->name(), back_end.label)) add(measureTick(*tick_case, back_end, samples));
    if (tick_case->name() != "lwr_allegro, 12 contacts") continue;
    for (const BackEndChoice& back_end : referenceBackEnds())
      if (wanted(tick_case->name(), back_end.label)) add(measureTick(*tick_case, back_end, samples / 20));
  }
  if (!options.json) std::printf("solve alone; steps: rows at their bounds\n");
  constexpr double weighted_targets[] = {1.35, 1.75, 5.7, 9.7};
  constexpr int contacts[] = {0, 3, 6, 12};
  for (int i = 0; i < 4; ++i)
    if (wanted(aloneName("weighted QP", contacts[i]), "active-set"))
      add(measureWeightedSolve(contacts[i], weighted_targets[i], samples));
  for (const HierarchyCase& hierarchy : hierarchy_cases)
    if (wanted(aloneName("hierarchy", hierarchy.contacts), "hqp")) add(measureHierarchySolve(hierarchy, samples));
  if (options.json) {
    nlohmann::ordered_json all;
    if (mujoco) all["mujoco_tick_us"] = mujoco->median_us;
    all["samples"] = samples;
    all["figures"] = figures;
    std::cout << all.dump(2) << '\n';
  }
  return failures > 0 ? 1 : 0;
}

}  // namespace
}  // namespace tactus::bench

int main(int argc, char** argv) {
  tactus::bench::Options options;
  CLI::App app("Times whole controller ticks and solves alone; exit 1 when a solve failed.\n"
               "Example: bench_controllers --quick --filter '12 contacts/hqp'");
  app.add_flag("--json", options.json, "Figures as JSON on stdout");
  app.add_flag("--quick", options.quick, "Fewer calls");
  app.add_option("--filter", options.filter, "Only what this regular expression finds in case/back end");
  CLI11_PARSE(app, argc, argv);
  try {
    return tactus::bench::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_controllers: %s\n", error.what());
    return 2;
  }
}
