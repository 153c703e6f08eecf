#include <stdlib.h>

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
  const std::vector<Operation> all = {Operation::rnea,             Operation::bias,            Operation::mass_matrix,
                                      Operation::forward_dynamics, Operation::point_jacobians, Operation::tick,
                                      Operation::cache_tick};
  std::vector<Case> cases = {{"lwr_allegro", test_robots::lwrAllegro(), all},
                             {"arm", test_robots::lwr(), all},
                             {"humanoid", test_robots::humanoid(), all}};
  for (const int joints : {10, 20, 50, 100, 200})
    cases.push_back({"chain_" + std::to_string(joints), test_robots::chain(joints),
                     {Operation::rnea, Operation::forward_dynamics}});
  return cases;
}

void addFigures(const Case& c, const std::vector<std::unique_ptr<Engine>>& engines, Operation operation,
                const Effort& effort, std::vector<Figure>& figures) {
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

std::vector<Figure> measureAll(const Effort& effort, const std::regex& filter) {
  std::vector<Figure> figures;
  for (const Case& c : cases()) {
    std::vector<Operation> wanted = c.operations;
    std::erase_if(wanted, [&](Operation o) { return !std::regex_search(c.name + "/" + operationName(o), filter); });
    if (wanted.empty()) continue;
    const Problem problem(c.name, c.robot);
    const std::vector<std::unique_ptr<Engine>> engines = makeEngines(problem);
    for (const Operation operation : wanted) addFigures(c, engines, operation, effort, figures);
  }
  if (figures.empty())
    throw std::invalid_argument("--filter finds no model/operation: they are as in the table, e.g. 'humanoid/rnea'");
  return figures;
}

/// Processes that ran or wanted to, mean of the last minute.
double loadAverage() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

void print(const std::vector<Figure>& figures, const Effort& effort, double load) {
  std::printf("%d samples of %d calls (fewer of slow engines), %d states; one thread.  Load average %.1f before, %.1f "
              "after.\n", effort.samples, effort.calls, state_count, load, loadAverage());
  for (const std::string& absent : absentEngines()) std::printf("Not built in: %s\n", absent.c_str());
  std::fputs((table(figures) + growth(figures)).c_str(), stdout);
}

/// 1 when engines disagree, else 0.
int run(const Options& options) {
  const Effort effort = options.quick ? Effort{300, 20, 0.1} : Effort{};
  const double load = loadAverage();
  const std::vector<Figure> figures = measureAll(effort, std::regex(options.filter));
  if (options.json) {
    const nlohmann::ordered_json all = {{"states", state_count},
                                        {"load_average", {load, loadAverage()}},
                                        {"not_built_in", absentEngines()},
                                        {"figures", toJson(figures)}};
    std::cout << all.dump(2) << '\n';
  } else {
    print(figures, effort, load);
  }
  int status = 0;
  for (const Figure& f : figures) {
    if (disagreement(f).empty()) continue;
    std::fprintf(stderr, "bench_dynamics: %s\n", disagreement(f).c_str());
    status = 1;
  }
  return status;
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
