// Tables of a run as other programs read them.  PlotJuggler's loader (DataLoadCSV, csv_parser.cpp and
// timestamp_parsing.cpp) takes the first line for names, which it changes where two are alike; splits at the one of
// tab, semicolon, comma and blank that the first line has most of; skips lines with another number of cells; tells a
// column's kind by its first cell, a number being digits, a sign and a point, no exponent; and says so when times go
// back.

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  if (line.ends_with(',')) cells.emplace_back();
  return cells;
}

void expectPlain(const std::string& file, bool strictly_rising) {
  const std::string content = contentOf(file);
  EXPECT_TRUE(content.ends_with('\n')) << file;
  for (const char unwanted : {'"', '\'', ';', '\t', ' ', '\r', '\xef'})
    EXPECT_EQ(content.find(unwanted), std::string::npos) << file << " holds '" << unwanted << "'";
  std::stringstream in(content);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = cellsOf(line);
  EXPECT_EQ(names.front(), "time");
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << "two names are alike";
  for (const std::string& name : names) EXPECT_TRUE(std::regex_match(name, std::regex("[^/,]+(/[^/,]+)*"))) << name;

  const std::regex number("-?[0-9]+(\\.[0-9]+)?"), value("-?[0-9]+(\\.[0-9]+)?|-?nan|-?inf");
  double last = -1;
  size_t rows = 0;
  for (; std::getline(in, line); ++rows) {
    const std::vector<std::string> cells = cellsOf(line);
    ASSERT_EQ(cells.size(), names.size()) << file;
    for (size_t i = 0; i < cells.size(); ++i)
      EXPECT_TRUE(std::regex_match(cells[i], rows == 0 ? number : value)) << names[i] << ": " << cells[i];
    const double time = std::stod(cells.front());
    EXPECT_TRUE(strictly_rising ? time > last : time >= last);
    last = time;
  }
  EXPECT_GT(rows, 10u);
}

TEST(CsvForOthers, TablesOfARunArePlain) {
  const TemporaryFolder folder;
  const std::string example = std::string(TACTUS_SOURCE_DIR) + "/examples/explore_table/stack.xml";
  // A locale with decimal commas changes nothing, where there is one.
  Settings german;
  german.environment = {"LC_ALL=de_DE.UTF-8"};
  int run = 0;
  for (const std::string& stack : {example, data("press.xml")}) {
    const std::string out = folder.file("run" + std::to_string(++run));
    const Outcome outcome = tactus({"run", stack, "--duration", "0.5", "--out", out}, german);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const char* name : {"log.csv", "replay.csv", "timing.csv"}) expectPlain(out + "/" + name, true);
  }
}

}  // namespace
}  // namespace tactus::testing
