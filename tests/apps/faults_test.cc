// Drives, bodies and senses that go wrong, in the real program: the finger that presses on the floor with 0.5 N, and the
// main example, with every fault of docs/faults.md.  Whatever it is, the run ends in its time with finite torques within
// limits and bounded forces, or by a message that names what went wrong; and it tells when each fault struck.

#include <gmock/gmock.h>

#include <cmath>
#include <optional>

#include "framework/runtime/csv_table.h"
#include "framework/runtime/file_error.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using runtime::CsvTable;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSubsetOf;
using ::testing::Not;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A run that its folder tells of.
struct Run {
  void read(const std::vector<std::string>& arguments) {
    outcome = tactus(arguments);
    run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
    log.emplace(CsvTable::read(folder.file("run/log.csv")));
  }
  void endsInItsTime() const {
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(run["status"], "done");
  }
  /// In the row of that time.
  double at(double time, const std::string& column) const {
    const std::vector<double> times = log->numbers("time"), values = log->numbers(column);
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < times.size(); ++i)
      if (std::abs(times[i] - time) < std::abs(times[nearest] - time)) nearest = i;
    return values[nearest];
  }
  double largest(const std::string& column) const {
    double most = 0;
    for (const double value : log->numbers(column)) most = std::max(most, std::abs(value));
    return most;
  }
  void tells(const std::string& name, const std::string& kind, double began, std::optional<double> ended) const {
    for (const nlohmann::json& fault : run["faults"]) {
      if (fault["name"] != name) continue;
      EXPECT_EQ(fault["kind"], kind);
      EXPECT_EQ(fault["began_s"], began);
      EXPECT_EQ(fault["ended_s"], ended ? nlohmann::json(*ended) : nlohmann::json());
      EXPECT_THAT(outcome.err, HasSubstr("note: fault '" + name + "' (" + kind + ") struck from t = "));
      EXPECT_THAT(contentOf(folder.file("run/report.html")), HasSubstr("<td>" + name + "</td><td>" + kind + "</td>"));
      return;
    }
    ADD_FAILURE() << "run.json tells of no '" << name << "'";
  }

  TemporaryFolder folder;
  Outcome outcome;
  nlohmann::json run;
  std::optional<CsvTable> log;
};

constexpr double kEffort = 20;                                     // N m, of every joint of the finger
constexpr double kBefore = 1.09, kDuring = 1.39, kEnd = 2.99;

/// The finger for three seconds.
struct Finger : Run {
  explicit Finger(const std::string& faults, const std::string& objects = "") {
    std::string text = contentOf(changedStack(folder, "<signals>", "<faults>" + faults + "</faults><signals>"));
    text = replaced(text, "duration=\"1\"", "duration=\"3\"");
    text = replaced(text, "</scene>", objects + "</scene>");
    const std::string stack = folder.file("faulty.xml");
    runtime::writeFile(stack, text);
    read({"run", stack, "--out", folder.file("run")});
    for (const char* joint : {"hip", "knee", "tip"})
      for (const double torque : log->numbers(std::string("tau/") + joint)) {
        EXPECT_TRUE(std::isfinite(torque));
        EXPECT_LE(std::abs(torque), kEffort);
      }
  }
};

/// From 1.1 s, when the finger presses steadily, until 1.4 s.
std::string during(const std::string& fault) {
  const std::size_t end = fault.find("/>");
  return std::string(fault).replace(end, 0, " name=\"fault\" from=\"1.1\" until=\"1.4\"");
}
