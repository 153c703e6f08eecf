#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>
#include <regex>

#include "bench/peers/measure.h"
#include "bench/peers/report.h"
#include "tests/dynamics/robots.h"

// Rigid-body dynamics against other engines, on the same robots, states and points, in one run.  docs/benchmarks.md
// says what is timed and how to read the table.
namespace tactus::bench {
namespace {

/// Engines that differ by more than this, relative to the largest number, did not compute the same thing.
constexpr double agreement = 1e-6;

struct Options {
  bool json = false, quick = false;
  std::string filter;
};

struct Case {
  std::string name;
  description::Robot robot;
  std::vector<Operation> operations;
};

std::vector<Case> cases() {
  const std::vector<Operation> all = {Operation::rnea,            Operation::bias, Operation::mass_matrix,
                                      Operation::forward_dynamics, Operation::point_jacobians, Operation::tick,
                                      Operation::cache_tick};
  return {{"lwr_allegro", test_robots::lwrAllegro(), all}, {"arm", test_robots::lwr(), all}};
}

void addFigures(const Case& c, const Problem& problem, Operation operation, const Effort& effort,
                std::vector<Figure>& figures) {
  const std::vector<std::unique_ptr<Engine>> engines = makeEngines(problem);
  std::vector<Engine*> offering;
  for (const auto& engine : engines)
    if (engine->offers(operation)) offering.push_back(engine.get());
  std::vector<double> differences;
  for (Engine* engine : offering) differences.push_back(relativeDifference(*offering[0], *engine, operation));
  const std::vector<Timing> timings = measure(offering, operation, effort);
  std::optional<double> mujoco_us;
  for (size_t k = 0; k < offering.size(); ++k)
    if (offering[k]->name().starts_with("MuJoCo")) mujoco_us = timings[k].median_us;
  for (size_t k = 0; k < offering.size(); ++k) {
    Figure f{c.name, offering[k]->name(), operation, timings[k], differences[k], {}, {}};
    if (mujoco_us) f.ratio = timings[k].median_us / *mujoco_us;
    if (k == 0) f.target = targetRatio(c.name, operation);
    figures.push_back(f);
  }
}

/// 1 when engines disagree, else 0.
int report(const std::vector<Figure>& figures, const Options& options) {
  if (options.json) {
    printJson(figures);
  } else {
    printTable(figures);
    printGrowth(figures);
  }
  int status = 0;
  for (const Figure& f : figures) {
    if (f.difference <= agreement) continue;
    std::fprintf(stderr, "bench_dynamics: %s: %s of %s differs from Tactus's by %.1e, more than %.0e\n",
                 f.engine.c_str(), operationName(f.operation).c_str(), f.model.c_str(), f.difference, agreement);
    status = 1;
  }
  return status;
}

int run(const Options& options) {
  const Effort effort = options.quick ? Effort{300, 20, 0.1} : Effort{};
  const std::regex filter(options.filter);
  std::FILE* talk = options.json ? stderr : stdout;
  std::fprintf(talk, "Medians and 99th percentiles of %d samples of %d calls, %d states; one thread.\n",
               effort.samples, effort.calls, state_count);
  for (const std::string& absent : absentEngines()) std::fprintf(talk, "Not built in: %s\n", absent.c_str());
  std::vector<Figure> figures;
  for (const Case& c : cases()) {
    const Problem problem(c.name, c.robot);
    for (const Operation operation : c.operations)
      if (std::regex_search(c.name + "/" + operationName(operation), filter))
        addFigures(c, problem, operation, effort, figures);
  }
  return report(figures, options);
}

}  // namespace
}  // namespace tactus::bench

int main(int argc, char** argv) {
  tactus::bench::Options options;
  CLI::App app("Times rigid-body dynamics of Tactus and of the other engines that were found.");
  app.add_flag("--json", options.json, "Figures as JSON on stdout");
  app.add_flag("--quick", options.quick, "A tenth of the samples");
  app.add_option("--filter", options.filter, "Only what this regular expression finds in model/operation");
  CLI11_PARSE(app, argc, argv);
  try {
    return tactus::bench::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_dynamics: %s\n", error.what());
    return 2;
  }
}
