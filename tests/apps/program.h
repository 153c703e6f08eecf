#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/runtime/temporary_folder.h"

/// Runs the real `tactus` as a user does.
namespace tactus::testing {

struct Outcome {
  int exit_code = -1;                                              ///< 128 + signal when it was killed
  std::string out;                                                 ///< stdout
  std::string err;                                                 ///< stderr
  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

struct Settings {
  std::string working_folder = ".";
  std::vector<std::string> environment;                            ///< NAME=VALUE, besides the test's own
  std::string out;                                                 ///< where stdout goes; "" = into the outcome
  long largest_file = -1;                                          ///< bytes; writing beyond fails, as on a full disk
};

/// Waits for its end.
Outcome tactus(const std::vector<std::string>& arguments, const Settings& settings = {});

/// A `tactus` that runs beside the test.
class RunningProgram {
 public:
  RunningProgram(const std::vector<std::string>& arguments, const Settings& settings = {});
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void send(int signal);
  Outcome wait();

 private:
  TemporaryFolder output_;
  pid_t process_ = -1;
};

/// A `tactus` whose input and output are a terminal of 80 columns and 24 lines, with the terminal's ordinary settings.
class ProgramInTerminal {
 public:
  explicit ProgramInTerminal(const std::vector<std::string>& arguments);
  ~ProgramInTerminal();
  ProgramInTerminal(const ProgramInTerminal&) = delete;
  ProgramInTerminal& operator=(const ProgramInTerminal&) = delete;

  /// What it has written by now is added to output(), after waiting for at most that long; false at its end.
  bool read(int milliseconds);
  const std::string& output() const { return output_; }
  void type(const std::string& keys);
  void send(int signal);
  /// Reads on to its end; returns the exit code as Outcome has it.
  int wait();
  /// Whether the settings are those of the start; before wait().
  bool settingsAreOrdinary() const;

 private:
  int terminal_ = -1;
  pid_t process_ = -1;
  std::string output_, settings_;
};

/// What a terminal of that width shows of a program's output, line by line from the first to the last that it wrote in;
/// what scrolls away is kept.  Understands line ends, ESC[nA, ESC[K and ESC[J, and fails the test for any other escape
/// sequence and for a line that wraps.
std::vector<std::string> screenOf(const std::string& output, size_t width = 80);

/// A file of tests/apps/data.
std::string data(const std::string& name);

/// A copy of a test stack and its robot in `folder` with `from` replaced by `to`.
std::string changedStack(const TemporaryFolder& folder, const std::string& from, const std::string& to);

}  // namespace tactus::testing
