#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/tactus/child_process.h"
#include "apps/tactus/study_plan.h"

namespace tactus::app {

/// A part of a study's trials: those whose number, counted from 0, leaves index − 1 when divided by count.
struct Shard {
  long index = 1;
  long count = 1;
  bool has(long trial) const { return (trial - 1) % count == index - 1; }
};

/// What came of a trial.
struct TrialRecord {
  Trial trial;
  ProcessEnd end;
  std::string status;                                              ///< that of run.json; "crashed" by a signal
  std::string message;                                             ///< why it failed, "" where nobody said
  long fallback_ticks = 0;
  std::vector<std::pair<std::string, double>> metrics;             ///< NaN: never met
  bool failed() const { return end.exit_code != 0 || end.signal != 0; }
};

/// study.json, the plan, and a folder trial-<number> for each finished trial with its trial.json and run.json.  A trial
/// runs in a hidden folder and takes its name in one step when it is finished: a kill at any time leaves it either
/// recorded or not begun.
class StudyFolder {
 public:
  /// The folder of a study that is there already.  Throws FileError.
  explicit StudyFolder(const std::string& path);
  /// A new or empty folder, or one with trials of the same plan; of another plan it is a FileError that says what has
  /// changed.  With a shard, its trials can run here, until the object is gone: nobody else may run them meanwhile.
  StudyFolder(const std::string& path, const StudyPlan& plan, const Shard& shard);
  ~StudyFolder();
  StudyFolder(const StudyFolder&) = delete;
  StudyFolder& operator=(const StudyFolder&) = delete;

  const std::string& path() const { return path_; }
  const StudyPlan& plan() const { return plan_; }
  bool isFinished(long trial) const;
  std::string trialFolder(long trial) const;
  /// Where a trial runs, a folder that is not there yet, and the file for what it says meanwhile.
  std::string runningFolder(long trial) const;
  std::string talkFile(long trial) const;

  /// Takes a trial that has ended over into the finished ones.  Throws FileError.
  void finish(long trial, const ProcessEnd& end);
  /// Takes over a finished trial of another folder.
  void adopt(long trial, const StudyFolder& from);
  /// Forgets a finished trial.
  void forget(long trial);
  /// Nothing while it is not finished.  Throws FileError for records that are damaged, or of another trial.
  std::optional<TrialRecord> record(long trial) const;

 private:
  std::string path_;
  StudyPlan plan_;
  std::string running_;                                            ///< folder of this shard
  int lock_ = -1;
};

}  // namespace tactus::app
