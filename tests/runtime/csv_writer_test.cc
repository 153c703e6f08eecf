#include "framework/runtime/csv_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <thread>

#include "framework/runtime/csv_table.h"
#include "framework/runtime/file_error.h"
#include "tests/runtime/temporary_folder.h"

namespace tactus::runtime {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tactus::testing::contentOf;
using tactus::testing::TemporaryFolder;

TEST(CsvWriter, WritesTheseBytes) {
  const TemporaryFolder folder;
  CsvWriter writer(folder.file("a.csv"), {"time", "task/reach/error", "link"});
  writer << 0.0 << 0.1 << std::string_view("palm");
  writer.endRow();
  writer << 1.0 << -1.5e-7 << std::string_view("thumb");
  writer.endRow();
  writer << 1e22 << 1.0 / 3 << std::string_view("");
  writer.endRow();
  writer << std::nan("") << std::numeric_limits<double>::infinity() << -0.0;
  writer.endRow();
  writer.close();
  EXPECT_EQ(contentOf(folder.file("a.csv")),
            "time,task/reach/error,link\n0,0.1,palm\n1,-0.00000015,thumb\n10000000000000000000000,0.3333333333333333,\n"
            "nan,inf,-0\n");
}

TEST(CsvWriter, NumbersReadBackToTheSameBits) {
  const TemporaryFolder folder;
  std::vector<double> values;
  std::uint64_t state = 1;
  for (int i = 0; i < 10000; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    double value;
    static_assert(sizeof value == sizeof state);
    std::memcpy(&value, &state, sizeof value);
    if (std::isfinite(value)) values.push_back(value);
  }
  ASSERT_GT(values.size(), 9000u);
  CsvWriter writer(folder.file("a.csv"), {"x"});
  for (const double value : values) {
    writer << value;
    writer.endRow();
  }
  writer.close();
  EXPECT_EQ(CsvTable::read(folder.file("a.csv")).numbers(0), values);
}

TEST(CsvWriter, OldRowsAreOnDiskAfterASecond) {
  const TemporaryFolder folder;
  CsvWriter writer(folder.file("a.csv"), {"x"});
  writer << 1.0;
  writer.endRow();
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));
  writer << 2.0;
  writer.endRow();
  EXPECT_EQ(contentOf(folder.file("a.csv")), "x\n1\n2\n");
}

TEST(CsvWriter, SeldomRowsAreOnDiskAfterASecondToo) {
  const TemporaryFolder folder;
  CsvWriter writer(folder.file("a.csv"), {"x", "y"});
  writer << 1.0 << 2.0;
  writer.endRow();
  writer.flushWhenDue();
  EXPECT_EQ(contentOf(folder.file("a.csv")), "x,y\n");
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));
  writer.flushWhenDue();
  EXPECT_EQ(contentOf(folder.file("a.csv")), "x,y\n1,2\n");
  writer << 3.0;
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));
  writer.flushWhenDue();
  EXPECT_EQ(contentOf(folder.file("a.csv")), "x,y\n1,2\n") << "half a row is none";
  writer << 4.0;
  writer.endRow();
  EXPECT_EQ(contentOf(folder.file("a.csv")), "x,y\n1,2\n3,4\n");
}

TEST(CsvWriter, HeaderIsOnDiskAtOnce) {
  const TemporaryFolder folder;
  CsvWriter writer(folder.file("a.csv"), {"x", "y"});
  EXPECT_EQ(contentOf(folder.file("a.csv")), "x,y\n");
}

/// Whoever looks finds no file or one with its header, at any moment: so does whoever kills the program.
TEST(CsvWriter, NoFileIsEverWithoutItsHeader) {
  const TemporaryFolder folder;
  constexpr int files = 300;
  const auto path = [&](int i) { return folder.file(std::to_string(i) + ".csv"); };
  std::atomic<int> empty{0};
  std::thread onlooker([&] {
    for (int i = 0; i < files; ++i) {
      struct stat found{};
      while (::stat(path(i).c_str(), &found) != 0) {
      }
      if (found.st_size == 0) ++empty;
    }
  });
  for (int i = 0; i < files; ++i) CsvWriter(path(i), {"x", "y"});
  onlooker.join();
  EXPECT_EQ(empty, 0);
}

TEST(CsvWriter, FullDiskIsAnErrorWithThePathAndLeavesNothing) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.csv"), unfinished = path + unfinished_suffix;
  std::filesystem::create_symlink("/dev/full", unfinished);
  try {
    CsvWriter writer(path, {"x"});
    FAIL() << "wrote to a full disk";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith(path + ": cannot be written: "), HasSubstr("No space left")));
    EXPECT_EQ(error.path, path);
  }
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(path)));
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(unfinished)));
}

TEST(CsvWriter, FolderThatIsNotThereIsAnError) {
  EXPECT_THROW(CsvWriter("/nowhere/a.csv", {"x"}), FileError);
}

}  // namespace
}  // namespace tactus::runtime
