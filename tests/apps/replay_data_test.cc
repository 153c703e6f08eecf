// What a page replays: numbers as they were, and fewer of them, said so, where there are too many.

#include "apps/tactus/replay_data.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "apps/tactus/text.h"
#include "tests/runtime/temporary_folder.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tactus::testing::TemporaryFolder;

std::vector<float> numbersOf(const std::string& base64) {
  std::string bytes;
  unsigned group = 0;
  int bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    group = group << 6 | static_cast<unsigned>(digits.find(c));
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 255);
  }
  std::vector<float> numbers(bytes.size() / sizeof(float));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(float));
  return numbers;
}

/// A run of that many frames with a contact in each; the force has one peak.
class ReplayDataTest : public ::testing::Test {
 protected:
  ordered_json dataOf(int frames, size_t most_characters) {
    std::string replay = "time,link/tip/x,link/tip/y,link/tip/z\n", log = "time,contact/max_N\n",
                contacts = "time,link,on,x,y,z,force_x,force_y,force_z\n";
    for (int i = 0; i < frames; ++i) {
      const std::string time = std::to_string(i);
      replay += time + "," + time + ",0.5,-1\n";
      log += time + (i == frames / 3 + 1 ? ",9\n" : ",1\n");
      contacts += time + ",tip," + (i % 2 ? "cup" : "table") + ",1,2,3,0,0," + time + "\n";
    }
    RunRecord run;
    run.folder = folder.path();
    run.json = {{"stack", "s"}, {"backend", "b"}};
    run.frames = runtime::CsvTable::read(folder.write("replay.csv", replay));
    run.contacts = runtime::CsvTable::read(folder.write("replay_contacts.csv", contacts));
    run.log = runtime::CsvTable::read(folder.write("log.csv", log));
    return replayData(run, "a run", most_characters);
  }
  TemporaryFolder folder;
};

TEST_F(ReplayDataTest, HoldsTheNumbersAsTheyWere) {
  const ordered_json data = dataOf(3, 1'000'000);
  EXPECT_THAT(numbersOf(data["frames"]["data"]), ElementsAre(0, 0, 0.5, -1, 1, 1, 0.5, -1, 2, 2, 0.5, -1));
  EXPECT_EQ(data["contacts"]["on"], ordered_json({"table", "cup"}));
  EXPECT_THAT(numbersOf(data["contacts"]["data"]),
              ElementsAre(0, 0, 0, 1, 2, 3, 0, 0, 0, 1, 0, 1, 1, 2, 3, 0, 0, 1, 2, 0, 0, 1, 2, 3, 0, 0, 2));
  EXPECT_EQ(data["plots"].size(), 1u);
  EXPECT_TRUE(data["notes"].empty());
}

TEST_F(ReplayDataTest, WhereThereAreTooManyItKeepsSomeAndThePeaksAndSaysSo) {
  constexpr size_t most = 100'000;
  const ordered_json data = dataOf(20'000, most);
  EXPECT_LT(jsonText(data).size(), most);
  const std::string notes = data["notes"].dump();
  EXPECT_THAT(notes, HasSubstr("Of the frames of the replay every "));
  EXPECT_THAT(notes, HasSubstr("The plot 'Contact forces (N)' shows the largest of every "));

  const std::vector<float> frames = numbersOf(data["frames"]["data"]), contacts = numbersOf(data["contacts"]["data"]);
  ASSERT_GE(contacts.size() / 9, 100u);
  EXPECT_EQ(contacts.size() / 9, frames.size() / 4) << "each frame has its contact";
  for (size_t row = 0; row < contacts.size() / 9; ++row)
    EXPECT_EQ(contacts[9 * row + 8], frames[4 * static_cast<size_t>(contacts[9 * row])]) << "the force is the frame's time";

  const std::vector<float> force = numbersOf(data["plots"][0]["series"][1]["data"]);
  EXPECT_EQ(*std::max_element(force.begin(), force.end()), 9);
}

TEST_F(ReplayDataTest, NothingInItEndsItsElement) {
  EXPECT_THAT(replayScript({{"title", "</script>"}}), HasSubstr("\\u003c/script>\"}"));
}

}  // namespace
}  // namespace tactus::app
