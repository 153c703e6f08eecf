#include "framework/runtime/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "framework/runtime/file_error.h"
#include "tests/runtime/temporary_folder.h"

namespace tactus::runtime {
namespace {

using ::testing::HasSubstr;
using tactus::testing::TemporaryFolder;

std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  try {
    const CsvTable table = CsvTable::read(folder.write("a.csv", content));
    for (size_t i = 0; i < table.columns().size(); ++i) table.numbers(static_cast<int>(i));
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(CsvTable, ReadsNumbersAndText) {
  const TemporaryFolder folder;
  const CsvTable table = CsvTable::read(folder.write("a.csv", "time,link\n0,palm\n1.5e-3,thumb\n"));
  EXPECT_EQ(table.columns(), (std::vector<std::string>{"time", "link"}));
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.numbers(0), (std::vector<double>{0, 0.0015}));
  EXPECT_EQ(table.cell(1, table.column("link")), "thumb");
  EXPECT_EQ(table.column("nothing"), -1);
}

TEST(CsvTable, ReadsNotANumber) {
  const TemporaryFolder folder;
  EXPECT_TRUE(std::isnan(CsvTable::read(folder.write("a.csv", "x\nnan\n")).numbers(0)[0]));
}

TEST(CsvTable, BrokenLastLineIsLeftOut) {
  const TemporaryFolder folder;
  const CsvTable table = CsvTable::read(folder.write("a.csv", "x,y\n1,2\n3,"));
  EXPECT_EQ(table.rows(), 1u);
  EXPECT_TRUE(table.endsWithinLine());
  EXPECT_FALSE(CsvTable::read(folder.write("a.csv", "x,y\n1,2\n")).endsWithinLine());
}

TEST(CsvTable, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(refusal(""), HasSubstr("is empty; expected a line of column names"));
  EXPECT_THAT(refusal("x,y\n1,2\n1\n"), HasSubstr("row 2 has 1 cells, but there are 2 columns"));
  EXPECT_THAT(refusal("x,y\n1,2\n1,1.5abc\n"), HasSubstr("row 2, column y: '1.5abc' is not a number"));
  EXPECT_THROW(CsvTable::read("/nowhere.csv"), FileError);
}

}  // namespace
}  // namespace tactus::runtime
