#include "apps/tactus/study_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "apps/tactus/json_place.h"
#include "apps/tactus/run_folder.h"
#include "apps/tactus/text.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* trial_format = "tactus-trial/1";
constexpr const char* lock_file = "lock";

/// What makes a trial the one that it is.
ordered_json describe(const StudyPlan& plan, const Trial& trial) {
  ordered_json levels = ordered_json::object();
  for (size_t i = 0; i < plan.factors.size(); ++i) levels[plan.factors[i].name] = plan.level(trial.levels, i);
  return {{"format", trial_format}, {"trial", trial.number}, {"levels", levels}, {"seed", trial.seed}};
}

bool isStudyFolder(const fs::path& folder) { return fs::exists(folder / "study.json"); }

void refuseOther(const std::string& path, const StudyPlan& before, const StudyPlan& now) {
  const std::vector<std::string> differences = differencesOf(before, now);
  if (differences.empty()) return;
  throw runtime::FileError(path, "holds trials of another study than this one: " + joined(differences, "; ") +
                                     ". Give another folder with --out, or take this one away");
}

/// Held by one process at a time, for as long as it lives; -1 where the file system knows no locks.
int lockAlone(const std::string& file, const Shard& shard) {
  const int lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock < 0) throw runtime::FileError(file, "cannot be written", errno);
  if (::flock(lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(lock);
    throw runtime::FileError(file, "another process runs shard " + std::to_string(shard.index) + "/" +
                                       std::to_string(shard.count) + " of this study here");
  }
  return lock;
}

/// The last line of a file, "" for none.
std::string lastLine(const std::string& file) {
  if (!fs::exists(file)) return "";
  std::string text = runtime::readFile(file);
  text.erase(text.find_last_not_of('\n') + 1);
  return text.substr(text.find_last_of('\n') + 1);
}

}  // namespace

StudyFolder::StudyFolder(const std::string& path) : path_(path) {
  const std::string file = path + "/study.json";
  plan_ = planFromJson(file, readJson(file));
}

StudyFolder::StudyFolder(const std::string& path, const StudyPlan& plan, const Shard& shard)
    : path_(path), plan_(plan) {
  fs::create_directories(path);
  const std::string file = path + "/study.json";
  const bool is_new = !isStudyFolder(path);
  if (!is_new) refuseOther(path, planFromJson(file, readJson(file)), plan);
  // Other shards may be about to begin here, too.
  for (const auto& entry : fs::directory_iterator(path))
    if (!entry.path().filename().string().starts_with(".shard-") && !isStudyFolder(path))
      throw runtime::FileError(path, "holds files that are not of a study; give an empty or a new folder with --out");
  running_ = path + "/.shard-" + std::to_string(shard.index) + "-of-" + std::to_string(shard.count);
  fs::create_directories(running_);
  lock_ = lockAlone(running_ + "/" + lock_file, shard);
  for (const auto& entry : fs::directory_iterator(running_))       // of a run that was killed
    if (entry.path().filename() != lock_file) fs::remove_all(entry.path());
  if (is_new) {
    runtime::writeFile(running_ + "/study.json", jsonText(toJson(plan), 2) + "\n");
    fs::rename(running_ + "/study.json", file);
    refuseOther(path, planFromJson(file, readJson(file)), plan);
  }
}

StudyFolder::~StudyFolder() {
  if (lock_ < 0) return;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(running_, ignored))
    if (entry.path().filename() != lock_file) fs::remove_all(entry.path(), ignored);
  ::close(lock_);
}

std::string StudyFolder::trialFolder(long trial) const { return path_ + "/trial-" + std::to_string(trial); }
std::string StudyFolder::runningFolder(long trial) const { return running_ + "/trial-" + std::to_string(trial); }
std::string StudyFolder::talkFile(long trial) const { return runningFolder(trial) + ".txt"; }
bool StudyFolder::isFinished(long trial) const { return fs::exists(trialFolder(trial) + "/trial.json"); }

void StudyFolder::finish(long trial, const ProcessEnd& end) {
  const std::string folder = runningFolder(trial);
  fs::create_directories(folder);                                  // a run that ended early left none
  std::vector<fs::path> not_kept;
  if (!plan_.keeps_runs)
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().filename() != "run.json") not_kept.push_back(entry.path());
  for (const fs::path& file : not_kept) fs::remove_all(file);
  if (fs::exists(talkFile(trial))) fs::rename(talkFile(trial), folder + "/stderr.txt");
  ordered_json record = describe(plan_, plan_.trial(trial));
  if (end.signal != 0) record["signal"] = end.signal;
  else record["exit_code"] = end.exit_code;
  writeJson(folder + "/trial.json", record);
  if (isFinished(trial)) fs::remove_all(folder);                   // by another shard of an overlapping split
  else fs::rename(folder, trialFolder(trial));
}

void StudyFolder::adopt(long trial, const StudyFolder& from) {
  fs::copy(from.trialFolder(trial), runningFolder(trial), fs::copy_options::recursive);
  fs::rename(runningFolder(trial), trialFolder(trial));
}

void StudyFolder::forget(long trial) {
  const std::string away = runningFolder(trial) + ".old";
  fs::rename(trialFolder(trial), away);
  fs::remove_all(away);
}

std::optional<TrialRecord> StudyFolder::record(long number) const {
  if (!isFinished(number)) return std::nullopt;
  const std::string folder = trialFolder(number), trial_file = folder + "/trial.json", run_file = folder + "/run.json";
  TrialRecord record{plan_.trial(number), {}, "crashed", "", 0, {}};
  const ordered_json written = readJson(trial_file);
  ordered_json identity = written;
  identity.erase("exit_code");
  identity.erase("signal");
  if (identity != describe(plan_, record.trial))
    throw runtime::FileError(trial_file, "is not of trial " + std::to_string(number) + " of this study");
  const JsonPlace end(trial_file, written);
  if (!end.at("exit_code").exists() && !end.at("signal").exists())
    throw runtime::FileError(trial_file, "does not say how the trial ended");
  record.end = {static_cast<int>(end.at("exit_code").number().value_or(0)),
                static_cast<int>(end.at("signal").number().value_or(0))};
  if (record.failed())
    record.message = record.end.signal != 0 ? "ended by signal " + std::to_string(record.end.signal)
                                            : lastLine(folder + "/stderr.txt");
  if (!fs::exists(run_file)) {
    if (record.end.signal == 0) record.status = "not-run";
    return record;
  }
  const ordered_json described = readJson(run_file);
  const JsonPlace run(run_file, described);
  if (record.end.signal == 0) record.status = run.at("status").text();
  if (record.failed()) record.message = run.at("message").text(record.message);
  record.fallback_ticks = static_cast<long>(run.at("ticks").at("fallback").number().value_or(0));
  for (const auto& [name, value] : run.at("metrics").members())
    record.metrics.emplace_back(name, value.number().value_or(NAN));
  return record;
}

}  // namespace tactus::app
