#pragma once

#include <chrono>
#include <string>

namespace tactus::app {

/// How far a study is.
struct StudyState {
  long all = 0;                                                    ///< trials of this shard
  long finished = 0;                                               ///< of them, those of earlier runs included
  long failed = 0;                                                 ///< of this run
  long finished_now = 0;                                           ///< of this run
  long running = 0;
};

/// "12 of 60 trials, 1 failed, 2 running, 4:05 left"; time left by the mean of this run, nothing before its first
/// trial.
std::string progressText(const StudyState& state, double elapsed_s);

/// Tells on stderr how far a study is: in one line of a terminal, or now and then in a log.
class StudyProgress {
 public:
  StudyProgress();
  ~StudyProgress();
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;
  void show(const StudyState& state);

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  Clock::time_point start_, shown_;
};

}  // namespace tactus::app
