#include <sched.h>

#include <chrono>
#include <deque>
#include <filesystem>
#include <iostream>
#include <set>
#include <thread>

#include "apps/tactus/interrupt.h"
#include "apps/tactus/run_folder.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/study_check.h"
#include "apps/tactus/study_folder.h"
#include "apps/tactus/study_progress.h"
#include "apps/tactus/study_results.h"
#include "apps/tactus/text.h"
#include "dsl/read_study.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct StudyArguments {
  std::string file;
  std::string out;
  std::string shard = "1/1";
  long jobs = 0;                                                   ///< 0: one for each core
  bool dry_run = false;
  bool retry = false;
  std::vector<std::string> plugins;
};

struct MergeArguments {
  std::vector<std::string> folders;
  std::string out;
};

/// Cores that this process may use: a scheduler may have given it fewer than there are.
long cores() {
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return std::max(1L, static_cast<long>(std::thread::hardware_concurrency()));
}

/// "2/8"
Shard parseShard(const std::string& text) {
  const std::vector<std::string> parts = split(text, '/');
  const auto number = [&](const std::string& part) {
    if (part.empty() || part.size() > 7 || part.find_first_not_of("0123456789") != std::string::npos)
      throw UsageError("--shard " + text + ": expected i/n, such as 2/8");
    return std::stol(part);
  };
  if (parts.size() != 2) throw UsageError("--shard " + text + ": expected i/n, such as 2/8");
  const Shard shard{number(parts[0]), number(parts[1])};
  if (shard.index < 1 || shard.index > shard.count)
    throw UsageError("--shard " + text + ": shards count from 1 to " + parts[1]);
  return shard;
}

/// Every trial with its conditions and where it stands.
ordered_json listOf(const StudyPlan& plan, const Shard& shard, const std::string& folder) {
  ordered_json list = ordered_json::array();
  for (long number = 1; number <= plan.trials(); ++number) {
    if (!shard.has(number)) continue;
    const Trial trial = plan.trial(number);
    ordered_json row{{"trial", number}};
    for (size_t i = 0; i < plan.factors.size(); ++i) row[plan.factors[i].name] = plan.level(trial.levels, i);
    row["seed"] = trial.seed;
    row["finished"] = fs::exists(folder + "/trial-" + std::to_string(number) + "/trial.json");
    list.push_back(std::move(row));
  }
  return list;
}

std::string listText(const ordered_json& list) {
  std::vector<std::vector<std::string>> rows;
  for (const ordered_json& trial : list) {
    if (rows.empty()) {
      rows.emplace_back();
      for (const auto& [key, value] : trial.items()) rows.back().push_back(key == "finished" ? "" : key);
    }
    rows.emplace_back();
    for (const auto& [key, value] : trial.items())
      rows.back().push_back(key == "finished"   ? (value.get<bool>() ? "finished" : "")
                            : value.is_string() ? value.get<std::string>()
                                                : value.dump());
  }
  return textTable(rows);
}

struct RunningTrial {
  long number;
  ChildProcess process;
};

/// Runs the waiting trials, so many at a time, and records each as it ends.  Returns whether all of them have run.
bool runTrials(const dsl::Study& study, const StudyArguments& arguments, StudyFolder& folder, std::deque<long> waiting,
               StudyState state, const std::atomic<bool>& stop) {
  const size_t jobs = static_cast<size_t>(arguments.jobs > 0 ? arguments.jobs : cores());
  std::vector<RunningTrial> running;
  StudyProgress progress;
  while (!stop && (!waiting.empty() || !running.empty())) {
    while (running.size() < jobs && !waiting.empty()) {
      const long number = waiting.front();
      waiting.pop_front();
      if (folder.isFinished(number)) continue;
      std::vector<std::string> words = runArguments(study, folder.plan(), folder.plan().trial(number));
      words.insert(words.end(), {"--out", folder.runningFolder(number)});
      for (const std::string& plugin : arguments.plugins) words.insert(words.end(), {"--plugin", plugin});
      running.push_back({number, ChildProcess(words, folder.talkFile(number))});
    }
    for (size_t i = 0; i < running.size();) {
      const std::optional<ProcessEnd> end = running[i].process.ended();
      if (!end) {
        ++i;
        continue;
      }
      const long number = running[i].number;
      // What the machine is to blame for says nothing of the trial.
      if (end->exit_code == exit_files || end->exit_code == 127) {
        std::cerr << runtime::readFile(folder.talkFile(number));
        throw runtime::FileError(folder.path(), "trial " + std::to_string(number) +
                                                    " could not be run or written; finished trials are kept");
      }
      folder.finish(number, *end);
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
      ++state.finished;
      ++state.finished_now;
      state.failed += end->exit_code != 0 || end->signal != 0;
    }
    state.running = static_cast<long>(running.size());
    progress.show(state);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return waiting.empty() && running.empty();
}

/// A failed trial's own code: of several, plugin before numerical.
int exitCodeOf(const StudyResults& results) {
  int code = exit_done;
  for (const auto& record : results.trials) {
    if (!record || !record->failed()) continue;
    if (record->end.signal != 0 || record->end.exit_code == exit_plugin) return exit_plugin;
    code = record->end.exit_code == exit_invalid_stack ? exit_invalid_stack : exit_numerical;
  }
  return code;
}

/// Writes and tells the results; returns the exit code.
int tell(const std::string& folder, const StudyResults& results, bool json) {
  writeResults(folder, results);
  if (json) {
    std::cout << jsonText(ordered_json{{"study", results.plan.name},
                                       {"folder", folder},
                                       {"trials", results.plan.trials()},
                                       {"finished", results.finished()},
                                       {"failed", results.failed()},
                                       {"remarks", remarksOf(results)},
                                       {"summary", conditionTable(results)},
                                       {"comparisons", comparisonTable(results)}}, 2) << "\n";
  } else {
    std::cout << resultsText(results);
  }
  for (const std::string& remark : remarksOf(results)) std::cerr << "tactus study: " << remark << "\n";
  std::cerr << "study folder: " << folder << ", tables and box plots in index.html\n";
  const int code = exitCodeOf(results);
  return code == exit_done && results.finished() < results.plan.trials() ? exit_mismatch : code;
}

int runStudy(const StudyArguments& arguments, bool json) {
  if (arguments.file.empty()) throw UsageError("study: give the study's XML file, or `merge` and folders");
  const Shard shard = parseShard(arguments.shard);
  Program program(arguments.plugins);
  const dsl::Study study = dsl::readStudy(arguments.file, program.registry(), program.includeFolders());
  std::vector<dsl::Diagnostic> warnings;
  const StudyPlan plan = planOf(program, study, warnings);
  for (const dsl::Diagnostic& warning : warnings) std::cerr << dsl::render(warning) << "\n";
  const std::string path = arguments.out.empty() ? "studies/" + plan.name : arguments.out;
  if (arguments.dry_run) {
    const ordered_json list = listOf(plan, shard, path);
    std::cout << (json ? jsonText(list, 2) + "\n" : listText(list));
    return exit_done;
  }

  const Interrupt interrupt;
  StudyFolder folder(path, plan, shard);
  StudyState state;
  std::deque<long> waiting;
  for (long number = 1; number <= plan.trials(); ++number) {
    if (!shard.has(number)) continue;
    ++state.all;
    const auto record = folder.record(number);
    if (record && arguments.retry && record->failed()) folder.forget(number);
    if (folder.isFinished(number)) ++state.finished;
    else waiting.push_back(number);
  }
  if (state.finished > 0)
    std::cerr << "tactus study: " << state.finished << " of " << state.all << " trials are finished already\n";
  const bool all_run = runTrials(study, arguments, folder, std::move(waiting), state, interrupt.stop());
  if (!all_run) {
    std::cerr << "tactus study: interrupted; finished trials are kept, the same command goes on\n";
    return exit_interrupted;
  }
  if (shard.count == 1) return tell(path, resultsOf(folder), json);
  StudyResults results = resultsOf(folder);
  for (long number = 1; number <= plan.trials(); ++number)
    if (!shard.has(number)) results.trials[static_cast<size_t>(number - 1)].reset();
  if (json)
    std::cout << jsonText(ordered_json{{"study", plan.name}, {"folder", path}, {"shard", arguments.shard},
                                       {"trials", state.all}, {"failed", results.failed()}}, 2) << "\n";
  std::cerr << "tactus study: shard " << arguments.shard << ": " << state.all << " trials, " << results.failed()
            << " failed; when all shards have run: tactus study merge " << path << "\n";
  return exitCodeOf(results);
}

/// Figures and end of a trial decide; times in run.json are those of the machine that ran it.
bool sameOutcome(const TrialRecord& one, const TrialRecord& other) {
  const auto bits = [](const TrialRecord& record) {
    ordered_json figures = ordered_json::array();
    for (const auto& [name, value] : record.metrics) figures.push_back({name, value});
    return figures.dump();
  };
  return one.end.exit_code == other.end.exit_code && one.end.signal == other.end.signal && one.status == other.status &&
         one.fallback_ticks == other.fallback_ticks && bits(one) == bits(other);
}

int mergeStudies(const MergeArguments& arguments, bool json) {
  std::deque<StudyFolder> sources;
  for (const std::string& folder : arguments.folders) sources.emplace_back(folder);
  const StudyPlan& plan = sources.front().plan();
  for (const StudyFolder& source : sources)
    if (const std::vector<std::string> differences = differencesOf(plan, source.plan()); !differences.empty())
      throw runtime::FileError(source.path(), "holds trials of another study than " + sources.front().path() + ": " +
                                                  joined(differences, "; "));
  const std::string path = arguments.out.empty() ? sources.front().path() : arguments.out;
  std::optional<StudyFolder> target;
  if (sources.size() > 1 || path != sources.front().path()) target.emplace(path, plan, Shard{});
  for (StudyFolder& source : sources) {
    if (!target || fs::equivalent(source.path(), path)) continue;
    for (long number = 1; number <= plan.trials(); ++number) {
      const auto record = source.record(number);
      if (!record) continue;
      if (const auto there = target->record(number)) {
        if (sameOutcome(*record, *there)) continue;
        std::cerr << "tactus study: trial " << number << " has come out otherwise in " << source.path() << " than in "
                  << path << " or a folder before it: one of the machines does not repeat the other\n";
        return exit_mismatch;
      }
      target->adopt(number, source);
    }
  }
  return tell(path, resultsOf(target ? *target : sources.front()), json);
}

}  // namespace

void addStudy(CLI::App& program, Context& context) {
  CLI::App* command =
      program.add_subcommand("study", "A stack under many conditions, on all cores, and what came of it");
  const auto arguments = std::make_shared<StudyArguments>();
  command->add_option("STUDY", arguments->file, "The study's XML file")->type_name("");
  command->add_option("--out", arguments->out, "Study folder; studies/<study> without it")->type_name("DIR");
  command->add_option("--jobs", arguments->jobs, "Trials at a time; one for each core without it")
      ->type_name("N")
      ->check(CLI::Range(1L, 100000L));
  command->add_option("--shard", arguments->shard, "Run the i-th of n parts alone, as one job of an array")
      ->type_name("I/N");
  command->add_flag("--dry-run", arguments->dry_run, "List the trials and run none");
  command->add_flag("--retry", arguments->retry, "Run trials again that failed");
  declarePlugins(*command, arguments->plugins);
  command->add_flag("--json", context.json, "{study, folder, trials, finished, failed, remarks, summary, comparisons}");
  command->footer(
      R"(Leaves trials, summary and comparisons as .csv and .json, a box plot METRIC.svg of each figure, index.html, and
a folder trial-<number> of each trial.  The same command goes on where it was interrupted or killed.

Examples:
  tactus study examples/explore_table/study.xml --dry-run
  tactus study examples/explore_table/study.xml --jobs 4
  tactus study examples/explore_table/study.xml --shard 2/8 --out studies/press
  tactus study merge studies/press)");
  command->callback([=, &context] {
    if (command->get_subcommands().empty())
      context.action = [=, &context] { return runStudy(*arguments, context.json); };
  });
  CLI::App* merge = command->add_subcommand("merge", "Put the shards of a study together and make its tables");
  const auto merged = std::make_shared<MergeArguments>();
  merge->add_option("DIR", merged->folders, "Study folders")->required()->type_name("DIR");
  merge->add_option("--out", merged->out, "Folder for all of it; the first DIR without it")->type_name("DIR");
  merge->add_flag("--json", context.json, "As for study");
  merge->footer(R"(Folders of one study, run with --shard on machines that share no file system, or the one that they share.
Exit code 1: trials are missing, or one has come out in two ways.

Examples:
  tactus study merge studies/press
  tactus study merge from-a from-b --out studies/press)");
  merge->callback([=, &context] { context.action = [=, &context] { return mergeStudies(*merged, context.json); }; });
}

}  // namespace tactus::app
