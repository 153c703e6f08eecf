// State files: every bit through a file, and what is wrong with one is said with its place.

#include "dsl/state_file.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>

namespace tactus::dsl {
namespace {

using ::testing::HasSubstr;

SavedState example() {
  SavedState saved;
  saved.stack = "press \xF0\x9F\x91\x88";
  saved.back_end = "qp";
  saved.seed = 3;
  saved.time = 0.1 + 0.2;
  saved.robot = "finger";
  saved.joints = {"a", "b"};
  saved.links = {"base", "tip"};
  saved.values["plant/q"] = std::vector<double>{0.1, -0.0, 5e-324, std::nan(""), -std::nan(""),
                                                -std::numeric_limits<double>::infinity(), 3};
  saved.values["plant/steps"] = std::vector<std::int64_t>{std::numeric_limits<std::int64_t>::min(), 7};
  saved.values["task/says"] = std::string("nan");
  saved.values["nothing"] = std::vector<double>{};
  return saved;
}

std::string refusal(const std::string& text) {
  try {
    parseState(text);
  } catch (const JsonFileError& error) {
    return error.what();
  }
  return "";
}

std::string with(const std::string& values) {
  return R"({"format": "tactus-state/1", "stack": "", "backend": "", "seed": 1, "time": 0, "robot": "", "joints": [],
            "links": [], "objects": [], "values": )" + values + "}";
}

TEST(StateFile, KeepsEveryBit) {
  const SavedState before = example(), after = parseState(stateToJson(before));
  EXPECT_EQ(after.stack, before.stack);
  EXPECT_EQ(after.back_end, "qp");
  EXPECT_EQ(after.seed, 3u);
  EXPECT_EQ(after.time, before.time);
  EXPECT_EQ(after.joints, before.joints);
  EXPECT_EQ(after.links, before.links);
  EXPECT_TRUE(after.objects.empty());
  ASSERT_EQ(after.values.size(), before.values.size());
  const auto& q = std::get<std::vector<double>>(before.values.at("plant/q"));
  const auto& read = std::get<std::vector<double>>(after.values.at("plant/q"));
  ASSERT_EQ(read.size(), q.size());
  for (std::size_t i = 0; i < q.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read[i]), std::bit_cast<std::uint64_t>(q[i])) << i;
  EXPECT_EQ(after.values.at("plant/steps"), before.values.at("plant/steps"));
  EXPECT_EQ(after.values.at("task/says"), before.values.at("task/says"));
}

TEST(StateFile, IsWrittenTheSameWayAgain) {
  const std::string text = stateToJson(example());
  EXPECT_EQ(stateToJson(parseState(text)).size(), text.size());
}

TEST(StateFile, HasALineForEachValue) {
  EXPECT_THAT(stateToJson(example()), HasSubstr("\n\"plant/steps\": [-9223372036854775808,7],\n\"task/says\": \"nan\"\n"));
}

TEST(StateFile, SaysWhatIsWrong) {
  EXPECT_THAT(refusal("nothing"), HasSubstr("not JSON"));
  EXPECT_THAT(refusal("[]"), HasSubstr("no state: \"format\" is not \"tactus-state/1\""));
  EXPECT_THAT(refusal(R"({"format": "tactus-tick/1"})"), HasSubstr("no state"));
  EXPECT_THAT(refusal(R"({"format": "tactus-state/1"})"), HasSubstr("\"stack\" is missing"));
  EXPECT_THAT(refusal(with("[]")), HasSubstr("values: expected an object"));
  EXPECT_THAT(refusal(with(R"({"a": 1})")), HasSubstr("values.a: expected an array of numbers, or a text"));
  EXPECT_THAT(refusal(with(R"({"a": [1, "x"]})")), HasSubstr("values.a[1]: expected a number"));
  EXPECT_THAT(refusal(with(R"({"a": [1, null]})")), HasSubstr("values.a[1]: expected a number"));
  EXPECT_THAT(refusal(with(R"({"a": [1], "a": [2]})")), HasSubstr("repeated"));
  EXPECT_EQ(refusal(with("{}")), "");
}

}  // namespace
}  // namespace tactus::dsl
