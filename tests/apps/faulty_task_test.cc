// Tasks of a plugin that go wrong in the middle of a run: the user learns which one, when and what, and keeps the log.

#include <gmock/gmock.h>

#include <filesystem>

#include "framework/runtime/csv_table.h"
#include "framework/runtime/file_error.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using runtime::CsvTable;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kPlugin = std::string(TEST_PLUGINS) + "/naughty.so";

/// The small stack with a task of the plugin, as a file in `folder`.
std::string faultyStack(const TemporaryFolder& folder, const std::string& fault) {
  return changedStack(folder, "<level priority=\"2\">",
                      "<level priority=\"2\"><naughty.task name=\"imp\" fault=\"" + fault + "\"/>");
}

struct FaultyRun {
  TemporaryFolder folder;
  Outcome outcome;
  nlohmann::json run;

  explicit FaultyRun(const std::string& fault, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run", faultyStack(folder, fault), "--plugin", kPlugin, "--out", folder.file("run")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    outcome = tactus(arguments);
    if (std::filesystem::exists(folder.file("run/run.json"))) {
      run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
    }
  }
};

class NonFiniteTask : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(NonFiniteTask, IsNamedWithItsTimeAndTheRunGoesOn) {
  const auto& [fault, back_end] = GetParam();
  const FaultyRun faulty(fault, {"--backend", back_end});
  EXPECT_EQ(faulty.outcome.exit_code, 5);
  const std::string warning =
      "task 'imp' gave numbers that are not finite, or too large to work with, first at t = 0.021 s: 979 ticks fell back";
  EXPECT_THAT(faulty.outcome.err, HasSubstr("tactus run: warning: " + warning + "\n"));
  EXPECT_THAT(faulty.outcome.out, HasSubstr("warning: 979 ticks fell back"));
  EXPECT_EQ(faulty.run["status"], "done");
  EXPECT_EQ(faulty.run["duration_s"], 1.0);
  EXPECT_EQ(faulty.run["ticks"]["fallback"], 979);
  EXPECT_EQ(faulty.run["warnings"], nlohmann::json({warning}));
  EXPECT_THAT(contentOf(faulty.folder.file("run/report.html")), HasSubstr("979 ticks fell back"));
}

INSTANTIATE_TEST_SUITE_P(Faults, NonFiniteTask,
                         ::testing::Values(std::pair{"nan", "null-space"}, std::pair{"huge", "null-space"},
                                           std::pair{"nan", "qp/nlopt"}, std::pair{"huge", "qp/ipopt"}),
                         [](const auto& info) {
                           return std::string(info.param.first) + (info.param.second[0] == 'q' ? "Qp" : "NullSpace");
                         });

TEST(FaultyTask, AGainThatOverflowsIsNamedToo) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"run", changedStack(folder, "stiffness=\"1\"", "stiffness=\"1e308\""), "--out",
                                  folder.file("run"), "--duration", "0.1"});
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.err, HasSubstr("warning: task 'bow' gave numbers that are not finite, or too large to work with"));
}

TEST(FaultyTask, NoWarningWithoutAFault) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"run", data("press.xml"), "--out", folder.file("run"), "--json"});
  EXPECT_EQ(outcome.json()["warnings"], nlohmann::json::array());
  EXPECT_THAT(outcome.err, Not(HasSubstr("warning")));
}

class ThrowingTask : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(ThrowingTask, EndsTheRunWithItsName) {
  const auto& [fault, what] = GetParam();
  const FaultyRun faulty(fault);
  const std::string message = std::string("task 'imp' failed at t = 0.021 s: ") + what;
  EXPECT_EQ(faulty.outcome.exit_code, 4);
  EXPECT_THAT(faulty.outcome.err, HasSubstr("tactus run: " + message + "; the log is kept\n"));
  EXPECT_EQ(faulty.run["status"], "tick-error");
  EXPECT_EQ(faulty.run["message"], message);
  EXPECT_EQ(CsvTable::read(faulty.folder.file("run/timing.csv")).rows(), 21u);
  EXPECT_THAT(contentOf(faulty.folder.file("run/report.html")), HasSubstr("failed at t = 0.021 s"));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, ThrowingTask,
    ::testing::Values(std::pair{"throw", "the licence server is on holiday"},
                      std::pair{"throw-other", "it threw something that is not a std::exception"},
                      std::pair{"rows", "it fills 5 rows, but announced at most 1"},
                      std::pair{"resize", "it changed the size of its rows: jacobian must stay 1 × 3, force and "
                                          "acceleration 1"}),
    [](const auto& info) {
      std::string name = info.param.first;
      std::erase(name, '-');
      return name;
    });

/// The stack with the faulty task and `on-fault`, run into a folder of its own.
struct SwitchedRun {
  explicit SwitchedRun(const std::string& fault, const std::string& on_fault) {
    std::string text = contentOf(faultyStack(folder, fault));
    const std::string controller = "<controller ";
    text.insert(text.find(controller) + controller.size(), "on-fault=\"" + on_fault + "\" ");
    const std::string stack = folder.file("switched.xml");
    runtime::writeFile(stack, text);
    outcome = tactus({"run", stack, "--plugin", kPlugin, "--out", folder.file("run")});
    run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
  }
  TemporaryFolder folder;
  Outcome outcome;
  nlohmann::json run;
};

/// The run without the task is the rest's; the torque makes no jump where it goes.
TEST(FaultyTask, IsSwitchedOffAndTheRestGoesOnWhereTheStackSaysSo) {
  for (const auto& [fault, code, reason] :
       {std::tuple{"throw", 4, "the licence server is on holiday"}, {"nan", 5, "it gave numbers that are not finite"},
        {"rows", 4, "it fills 5 rows, but announced at most 1"}, {"resize", 4, "it changed the size of its rows"}}) {
    SCOPED_TRACE(fault);
    const SwitchedRun switched(fault, "switch-off");
    EXPECT_EQ(switched.outcome.exit_code, code) << switched.outcome.err;
    EXPECT_EQ(switched.run["status"], "done");
    EXPECT_EQ(switched.run["ticks"]["fallback"], 0);
    EXPECT_EQ(switched.run["ticks"]["total"], 1000);
    EXPECT_THAT(switched.run["warnings"][0].get<std::string>(),
                HasSubstr(std::string("task 'imp' was switched off at t = 0.021 s: ") + reason));
    EXPECT_THAT(switched.outcome.err, HasSubstr("warning: task 'imp' was switched off at t = 0.021 s"));
  }
}

TEST(FaultyTask, EndsTheRunWhereTheStackSaysSo) {
  const SwitchedRun ended("nan", "end");
  EXPECT_EQ(ended.outcome.exit_code, 4);
  EXPECT_EQ(ended.run["status"], "tick-error");
  EXPECT_THAT(ended.outcome.err, HasSubstr("task 'imp' failed at t = 0.021 s: it gave numbers that are not finite"));
}

TEST(FaultyTask, ThatAnnouncesNoSensibleNumberOfRowsIsRefused) {
  const FaultyRun faulty("capacity");
  EXPECT_EQ(faulty.outcome.exit_code, 3);
  EXPECT_THAT(faulty.outcome.err, HasSubstr("the task says that it has at most -1 rows"));
}

TEST(FaultyTask, OtherCommandsNameItToo) {
  const TemporaryFolder folder;
  const std::string stack = faultyStack(folder, "throw");
  const Outcome compared = tactus({"compare", stack, "--plugin", kPlugin, "--backends", "null-space"});
  EXPECT_EQ(compared.exit_code, 4);
  EXPECT_THAT(compared.err, HasSubstr("task 'imp' failed at t = 0.021 s"));
  const Outcome recorded =
      tactus({"golden", "record", folder.file("case"), "--stack", stack, "--plugin", kPlugin, "--reason", "to see"});
  EXPECT_EQ(recorded.exit_code, 4);
  EXPECT_THAT(recorded.err, HasSubstr("task 'imp' failed at t = 0.021 s"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("case")));
}

TEST(FaultyTask, ARunWithoutNumbersIsNoGoldenCase) {
  const TemporaryFolder folder;
  const std::string stack = faultyStack(folder, "nan");
  const Outcome outcome =
      tactus({"golden", "record", folder.file("case"), "--stack", stack, "--plugin", kPlugin, "--reason", "to see"});
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.err, HasSubstr("such a run is not recorded"));
  EXPECT_EQ(tactus({"compare", stack, "--plugin", kPlugin, "--backends", "null-space", "--duration", "0.1"}).exit_code, 5);
}

}  // namespace
}  // namespace tactus::testing
