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

/// A file of tests/apps/data.
std::string data(const std::string& name);

/// A copy of a test stack and its robot in `folder` with `from` replaced by `to`.
std::string changedStack(const TemporaryFolder& folder, const std::string& from, const std::string& to);

}  // namespace tactus::testing
