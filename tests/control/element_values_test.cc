// Strategy: what parses is the number that was written, for random doubles and every type; what does not parse says
// what was expected; and none of it depends on the locale.

#include "framework/control/element_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <random>

namespace tactus::control {
namespace {

using testing::ElementsAre;

std::string errorOf(const AttributeRow& row, const std::string& text) {
  std::string error;
  return parseValue(row, text, error) ? "none" : error;
}

std::vector<double> numbersOf(const AttributeRow& row, const std::string& text) {
  std::string error;
  const auto value = parseValue(row, text, error);
  EXPECT_TRUE(value) << error;
  return value ? value->numbers : std::vector<double>{};
}

const AttributeRow real{.name = "a", .type = ValueType::real};

TEST(FormatNumber, ReadsBackToTheSameBits) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const double number = std::bit_cast<double>(random());
    if (!std::isfinite(number)) continue;
    const auto back = numbersOf(real, formatNumber(number));
    ASSERT_EQ(back.size(), 1u);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(back[0]), std::bit_cast<std::uint64_t>(number));
  }
  EXPECT_EQ(formatNumber(0.1), "0.1");
  EXPECT_EQ(formatNumber(1e300), "1e+300");
}

TEST(ParseValue, TakesNumbersWholeOrNotAtAll) {
  EXPECT_THAT(numbersOf(real, "-1.5e-3"), ElementsAre(-1.5e-3));
  EXPECT_THAT(numbersOf(real, ".5"), ElementsAre(0.5));
  EXPECT_EQ(errorOf(real, "1.5abc"), "'1.5abc' is not a number: expected a number");
  EXPECT_EQ(errorOf(real, "0,5"), "'0,5' is not a number: expected a number; the decimal sign is a point");
  EXPECT_EQ(errorOf(real, ""), "'' is not a number: expected a number");
  EXPECT_EQ(errorOf(real, " 1"), "' 1' is not a number: expected a number");
  EXPECT_EQ(errorOf(real, "1 "), "'1 ' is not a number: expected a number");
  EXPECT_EQ(errorOf(real, "0x10"), "'0x10' is not a number: expected a number");
  EXPECT_EQ(errorOf(real, "nan"), "'nan' is not a finite number: expected a number");
  EXPECT_EQ(errorOf(real, "-inf"), "'-inf' is not a finite number: expected a number");
  EXPECT_EQ(errorOf(real, "1e999"), "'1e999' is too large or too small to be represented: expected a number");
}

TEST(ParseValue, SaysThatBlanksSeparateNumbers) {
  const std::string hint = "; numbers are separated by blanks, not by commas";
  const AttributeRow any{.name = "a", .type = ValueType::reals};
  const AttributeRow three{.name = "a", .type = ValueType::reals, .count = 3};
  const AttributeRow points{.name = "a", .type = ValueType::points, .count = 2};
  EXPECT_EQ(errorOf(any, "1,2"), "'1,2' is not a number: expected a number" + hint);
  EXPECT_EQ(errorOf(three, "1,2,3"), "expected 3 numbers, found 1" + hint);
  EXPECT_EQ(errorOf(three, "1, 2, 3"), "'1,' is not a number: expected a number" + hint);
  EXPECT_EQ(errorOf(points, "1 2; 3,4"), "point 2: expected 2 numbers, found 1" + hint);
  EXPECT_EQ(errorOf(three, "1 2"), "expected 3 numbers, found 2");
}

TEST(ParseValue, IntegersAreWholeAndFit) {
  const AttributeRow row{.name = "a", .type = ValueType::integer, .lower = 1, .upper = 5};
  EXPECT_THAT(numbersOf(row, "3"), ElementsAre(3));
  EXPECT_EQ(errorOf(row, "3.0"), "'3.0' is not an integer: expected an integer ≥ 1 and ≤ 5");
  EXPECT_EQ(errorOf(row, "6"), "'6' is out of range: expected an integer ≥ 1 and ≤ 5");
  EXPECT_EQ(errorOf(row, "99999999999"),
            "'99999999999' is too large or too small to be represented: expected an integer ≥ 1 and ≤ 5");
}

TEST(ParseValue, RangesAreOpenOrClosedAndNameTheirUnit) {
  const AttributeRow open{.name = "a", .type = ValueType::real, .unit = "N/m", .lower = 0, .lower_open = true};
  EXPECT_EQ(errorOf(open, "0"), "'0' is out of range: expected a number > 0 (N/m)");
  const AttributeRow closed{.name = "a", .type = ValueType::real, .unit = "1", .lower = 0, .upper = 1};
  EXPECT_EQ(errorOf(closed, "0"), "none");
  EXPECT_EQ(errorOf(closed, "1"), "none");
  EXPECT_EQ(errorOf(closed, "1.5"), "'1.5' is out of range: expected a number ≥ 0 and ≤ 1");
}

TEST(ParseValue, ListsHaveTheirCount) {
  const AttributeRow three{.name = "a", .type = ValueType::reals, .count = 3};
  EXPECT_THAT(numbersOf(three, " 1  2\n\t3 "), ElementsAre(1, 2, 3));
  EXPECT_EQ(errorOf(three, "1 2"), "expected 3 numbers, found 2");
  EXPECT_EQ(errorOf(three, "1 2 x"), "'x' is not a number: expected a number");
  const AttributeRow any{.name = "a", .type = ValueType::reals};
  EXPECT_THAT(numbersOf(any, "1"), ElementsAre(1));
  EXPECT_EQ(errorOf(any, " "), "expected numbers separated by blanks, found none");
}

TEST(ParseValue, PointsAreGroups) {
  const AttributeRow row{.name = "a", .type = ValueType::points, .count = 2};
  EXPECT_THAT(numbersOf(row, "1 2;3 4 ; 5 6"), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(errorOf(row, "1 2; 3"), "point 2: expected 2 numbers, found 1");
  EXPECT_EQ(errorOf(row, "1 2;"), "point 2: expected 2 numbers, found 0");
  EXPECT_EQ(errorOf(row, ""), "point 1: expected 2 numbers, found 0");
}

TEST(ParseValue, WordsOfEveryKind) {
  const auto of = [](ValueType type) { return AttributeRow{.name = "a", .type = type}; };
  EXPECT_EQ(errorOf(of(ValueType::text), ""), "none");
  EXPECT_EQ(errorOf(of(ValueType::identifier), "hand-2_b"), "none");
  EXPECT_EQ(errorOf(of(ValueType::identifier), "2b"),
            "'2b' is not a name: expected a letter, then letters, digits, '_' or '-'");
  EXPECT_EQ(errorOf(of(ValueType::identifier), "a.b"),
            "'a.b' is not a name: expected a letter, then letters, digits, '_' or '-'");
  EXPECT_THAT(numbersOf(of(ValueType::flag), "true"), ElementsAre(1));
  EXPECT_THAT(numbersOf(of(ValueType::flag), "false"), ElementsAre(0));
  EXPECT_EQ(errorOf(of(ValueType::flag), "1"), "'1' is not a flag: expected 'true' or 'false'");
  EXPECT_EQ(errorOf(of(ValueType::links), " "), "expected names of links or of their groups, separated by blanks");
  EXPECT_EQ(errorOf(of(ValueType::joints), ""), "expected names of joints or of their groups, separated by blanks");
  EXPECT_EQ(errorOf(of(ValueType::file), ""), "expected the name of a file");
  EXPECT_EQ(errorOf(of(ValueType::link), ""), "expected the name of a link");
  const AttributeRow port{.name = "a", .type = ValueType::port, .port_type = "scalar"};
  EXPECT_EQ(errorOf(port, "touch.held"), "none");
  EXPECT_EQ(errorOf(port, "touch"), "'touch' does not name a port: expected signal.port, such as 'touch.held'");
  EXPECT_EQ(errorOf(port, "a.b.c"), "'a.b.c' does not name a port: expected signal.port, such as 'touch.held'");
  const AttributeRow choice{.name = "a", .type = ValueType::choice, .choices = {"x", "y", "z"}};
  EXPECT_EQ(errorOf(choice, "y"), "none");
  EXPECT_EQ(errorOf(choice, "w"), "'w' is not one of the choices: expected 'x', 'y' or 'z'");
}

TEST(ParseValue, DoesNotCareForTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {
    if (!std::setlocale(LC_ALL, name)) continue;
    EXPECT_THAT(numbersOf(real, "0.5"), ElementsAre(0.5));
    EXPECT_EQ(formatNumber(0.5), "0.5");
  }
  std::setlocale(LC_ALL, before.c_str());
}

const ElementRow& exampleRow() {
  static const ElementRow row{.name = "pull",
                              .attributes = {{.name = "name", .type = ValueType::identifier, .required = true},
                                             {.name = "gain", .type = ValueType::real, .default_text = "2"},
                                             {.name = "axis", .type = ValueType::reals, .count = 3},
                                             {.name = "hold", .type = ValueType::flag, .default_text = "true"}}};
  return row;
}

TEST(MakeValues, FillsDefaultsAndTakesWhatIsGiven) {
  const ElementValues values = makeValues(exampleRow(), {{"name", "p"}, {"axis", "1 2 3"}});
  EXPECT_EQ(values.text("name"), "p");
  EXPECT_EQ(values.real("gain"), 2);
  EXPECT_EQ(values.vector3("axis"), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(values.flag("hold"));
  EXPECT_EQ(values.value("gain").origin.kind, Origin::Kind::table_default);
  EXPECT_EQ(values.value("axis").origin.kind, Origin::Kind::attribute);
}

TEST(MakeValues, RefusesInOneSentence) {
  const auto refusal = [](const std::map<std::string, std::string>& given) -> std::string {
    try {
      makeValues(exampleRow(), given);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(refusal({}), "<pull> needs the attribute 'name'");
  EXPECT_EQ(refusal({{"name", "p"}, {"gian", "1"}}), "<pull> has no attribute 'gian'");
  EXPECT_EQ(refusal({{"name", "p"}, {"gain", "x"}}),
            "<pull>: attribute 'gain': 'x' is not a number: expected a number");
}

TEST(ElementValues, AMistakeOfTheProgramIsALogicError) {
  const ElementValues values = makeValues(exampleRow(), {{"name", "p"}});
  EXPECT_FALSE(values.has("axis"));
  EXPECT_THROW(values.numbers("axis"), std::logic_error);
  EXPECT_THROW(values.real("nothing"), std::logic_error);
  EXPECT_THROW(values.vector3("gain"), std::logic_error);
  EXPECT_THROW(values.real("name"), std::logic_error);
}

}  // namespace
}  // namespace tactus::control
