#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/tactus/comparison_view.h"
#include "apps/tactus/differences.h"
#include "apps/tactus/interrupt.h"
#include "apps/tactus/progress.h"
#include "apps/tactus/same_states.h"
#include "apps/tactus/session.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/text.h"
#include "dsl/compile.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/percentile.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

struct CompareArguments : StackArguments {
  std::string back_ends = "null-space,qp/ipopt,qp/nlopt";
  long every = 50;
  std::string page;                                                ///< file of the page, empty for none
};

/// How a closed loop went, for its curves: so many samples at most, each the largest of its ticks.
class Traces final : public control::Observer {
 public:
  explicit Traces(const Session& session)
      : session_(session), ticks_per_sample_(std::max(1L, std::lround(session.stack().run.duration / session.controller().period() / most_samples))) {}
  void observe(const control::ObservedTick& tick) override {
    const runtime::ContactMetrics::Now& now = session_.contacts().now();
    if (ticks_++ % ticks_per_sample_ == 0) samples_.push_back({tick.sensed.time, 0, 0, 0});
    Sample& sample = samples_.back();
    sample.links = std::max(sample.links, now.links);
    sample.force = std::max(sample.force, now.max_N);
    sample.tick_us = std::max(sample.tick_us, tick.tick_us);
  }
  ordered_json toJson() const {
    ordered_json json{{"time", ordered_json::array()}};
    for (const Sample& sample : samples_) {
      json["time"].push_back(sample.time);
      json["links"].push_back(sample.links);
      json["force_max_N"].push_back(sample.force);
      json["tick_max_us"].push_back(sample.tick_us);
    }
    return json;
  }

 private:
  static constexpr double most_samples = 500;
  struct Sample {
    double time;                                                   ///< of the first tick, s
    int links;
    double force;                                                  ///< N, of a desired link
    double tick_us;
  };
  const Session& session_;
  long ticks_per_sample_;
  long ticks_ = 0;
  std::vector<Sample> samples_;
};

/// Mean of |error| of each task over a run.
class TaskErrors final : public control::Observer {
 public:
  explicit TaskErrors(const control::Controller& controller) {
    for (const control::Level& level : controller.levels()) {
      for (const control::NamedTask& named : level.tasks) tasks_.push_back({named.name, named.task.get(), 0});
    }
  }
  void observe(const control::ObservedTick&) override {
    ++ticks_;
    for (Sum& sum : tasks_) sum.error += std::abs(sum.task->error());
  }
  ordered_json means() const {
    ordered_json json = ordered_json::object();
    for (const Sum& sum : tasks_) json[sum.name] = sum.error / static_cast<double>(std::max(1L, ticks_));
    return json;
  }

 private:
  struct Sum {
    std::string name;
    const control::Task* task;
    double error;
  };
  std::vector<Sum> tasks_;
  long ticks_ = 0;
};

ordered_json kktToJson(bool has_kkt, const control::KktResidual& kkt) {
  if (!has_kkt) return nullptr;
  return {{"stationarity", kkt.stationarity}, {"primal", kkt.primal}, {"complementarity", kkt.complementarity}};
}

ordered_json timesToJson(const std::vector<double>& times) {
  return {{"median", runtime::percentile(times, 0.5)}, {"p99", runtime::percentile(times, 0.99)}};
}

/// The whole run with one back end.
ordered_json closedLoop(Session& session, const std::string& label, const std::vector<control::Observer*>& more,
                        const std::atomic<bool>& stop) {
  TaskErrors errors(session.controller());
  Traces traces(session);
  Progress progress(session.stack().run.duration, label + ": ");
  std::vector<control::Observer*> observers{&errors, &traces, &progress};
  observers.insert(observers.end(), more.begin(), more.end());
  const runtime::LoopResult result = session.run(observers, stop);

  for (const std::string& warning : session.warnings()) std::cerr << label << ": warning: " << warning << "\n";
  if (result.ending == runtime::Ending::tick_error || result.ending == runtime::Ending::part_error)
    std::rethrow_exception(result.error);

  const runtime::RunStatistics& statistics = session.statistics();
  ordered_json metrics = ordered_json::object();
  for (const control::Metric& metric : session.metrics()) metrics[metric.name] = metric.value;
  return {{"status", result.ending == runtime::Ending::done ? "done" : result.message},
          {"duration_s", result.simulated},
          {"realtime_factor", result.realtimeFactor()},
          {"tick_us", timesToJson(statistics.tickTimes())},
          {"fallbacks", statistics.fallbacks},
          {"infeasible", statistics.infeasible},
          {"limited", statistics.limited},
          {"rate_limited", statistics.rate_limited},
          {"late", statistics.late},
          {"lost_rank", statistics.lost_rank},
          {"kkt_max", kktToJson(statistics.has_kkt, statistics.kkt_max)},
          {"warnings", session.warnings()},
          {"metrics", metrics},
          {"task_errors", errors.means()},
          {"traces", traces.toJson()}};
}

ordered_json sameStates(const std::vector<control::TickProblem>& problems, const Answers& reference,
                        const Answers& answers, const std::vector<TickDifference>& differences) {
  const TorqueDifference difference = compareTorques(problems, reference, answers);
  const auto count = [&](auto differs) {
    return std::count_if(differences.begin(), differences.end(), [&](const TickDifference& tick) {
      return differs(tick.here) || differs(tick.there);
    });
  };
  return {{"torque_difference", {{"mean", difference.mean}, {"max", difference.max}}},
          {"torque_difference_relative", {{"mean", difference.relative_mean}, {"max", difference.relative_max}}},
          {"compared", difference.compared},
          {"unsolved", answers.unsolved},
          {"other_active_rows", count([](const BoundsOf& bounds) { return !bounds.rows.empty(); })},
          {"other_limits", count([](const BoundsOf& bounds) { return !bounds.joints.empty(); })},
          {"violation_max", answers.violation_max},
          {"kkt_max", kktToJson(answers.has_kkt, answers.kkt_max)},
          {"solve_us", timesToJson(answers.solve_us)}};
}

int compare(const CompareArguments& arguments, bool json) {
  Program program(arguments.plugins);
  const std::vector<std::string> labels = split(arguments.back_ends, ',');
  const auto readFor = [&](const std::string& label) {
    StackOptions options = arguments.stack;
    options.back_end = label;
    return readAloud(program, options);
  };
  // What can be refused is refused before the first long run.
  for (const std::string& label : labels) program.backEndChoice(label);
  if (!arguments.page.empty()) runtime::writeFile(arguments.page, unfinishedPage());

  const Interrupt interrupt;
  ProblemSampler sampler(arguments.every);
  ordered_json back_ends = ordered_json::array();
  std::string name;
  std::uint64_t seed = 0;
  int code = exit_done;
  for (const std::string& label : labels) {
    Session session(readFor(label), program.registry());
    name = session.stack().name;
    seed = session.stack().run.seed;
    std::vector<control::Observer*> sampling;
    if (back_ends.empty()) sampling.push_back(&sampler);
    back_ends.push_back({{"backend", label}, {"closed_loop", closedLoop(session, label, sampling, interrupt.stop())}});
    if (interrupt.stop()) throw Interrupted();
    if (back_ends.back()["closed_loop"]["status"] != "done" || session.faultCode() != exit_done) {
      code = exit_numerical;
    }
  }
  Answers reference;
  for (size_t i = 0; i < labels.size(); ++i) {
    // A fresh controller, so that no back end starts warm from its own run.
    const auto controller = dsl::compile(readFor(labels[i]), program.registry());
    const Answers answers = solveAll(controller->backEnd(), sampler.problems());
    if (i == 0) reference = answers;
    const std::vector<TickDifference> apart = differences(sampler, reference, answers);
    const std::vector<std::string>& joints = controller->model().jointNames();
    back_ends[i]["same_states"] = sameStates(sampler.problems(), reference, answers, apart);
    back_ends[i]["same_states"]["ticks"] = toJson(apart, sampler, answers, joints);
    back_ends[i]["same_states"]["furthest"] = largestDifferences(apart, sampler, joints, labels.front());
  }
  const ordered_json comparison{{"stack", name},
                                {"seed", seed},
                                {"reference", labels.front()},
                                {"sampled_ticks", sampler.problems().size()},
                                {"backends", back_ends}};
  if (!arguments.page.empty()) {
    runtime::writeFile(arguments.page, comparisonPage(comparison));
    std::cerr << "page: " << arguments.page << "\n";
  }
  std::cout << (json ? jsonText(comparison, 2) + "\n" : comparisonText(comparison));
  return code;
}

}  // namespace

void addCompare(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("compare", "Several back ends on one stack: same states, and closed loop");
  const auto arguments = std::make_shared<CompareArguments>();
  command->add_option("STACK", arguments->stack.file, "The stack's XML file")->required()->type_name("");
  command->add_option("--backends", arguments->back_ends, "Back ends; the first is the reference")
      ->type_name("A,B,…")
      ->capture_default_str();
  command->add_option("--every", arguments->every, "Solve every K-th tick problem of the first run with all back ends")
      ->type_name("K")
      ->check(positive())
      ->capture_default_str();
  command->add_option("--page", arguments->page, "Write the comparison as a page with curves, too")->type_name("FILE");
  arguments->declare(*command);
  command->add_flag("--json", context.json,
                    "{stack, seed, reference, sampled_ticks, backends: [{backend, closed_loop, same_states}]}");
  command->footer(R"(A back end may name its variants: qp/nlopt, null-space/augmented, null-space/successive/one-pass.

Examples:
  tactus compare examples/explore_table/stack.xml --backends null-space,qp/ipopt,hqp --duration 5 --page compare.html
  tactus compare examples/explore_table/stack.xml --backends null-space/successive,null-space/augmented --json)");
  command->callback([=, &context] { context.action = [=, &context] { return compare(*arguments, context.json); }; });
}

}  // namespace tactus::app
