#include "framework/control/element_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tactus::control {
namespace {

ElementRow row(const std::string& name, std::vector<AttributeRow> attributes = {}) {
  return {.name = name, .kind = ElementKind::task, .description = "A row.", .attributes = std::move(attributes)};
}

std::string refusal(ElementRow wrong) {
  ElementTable table;
  try {
    table.add(std::move(wrong));
  } catch (const std::invalid_argument& error) {
    EXPECT_TRUE(table.rows().empty());
    return error.what();
  }
  return "none";
}

TEST(ElementTable, FindsWhatWasAdded) {
  ElementTable table;
  table.add(row("pull", {{.name = "gain", .type = ValueType::real, .default_text = "1"}}));
  table.add(row("acme.wiggle"));
  ASSERT_TRUE(table.find("pull"));
  EXPECT_EQ(table.find("pull")->attribute("gain")->default_text, "1");
  EXPECT_EQ(table.find("pull")->attribute("gian"), nullptr);
  EXPECT_TRUE(table.find("acme.wiggle"));
  EXPECT_EQ(table.find("push"), nullptr);
}

TEST(ElementTable, RowsStayWhereTheyAre) {
  ElementTable table;
  table.add(row("first"));
  const ElementRow* first = table.find("first");
  for (int i = 0; i < 1000; ++i) table.add(row("row" + std::to_string(i)));
  EXPECT_EQ(table.find("first"), first);
}

TEST(ElementTable, BackEndsHaveNamesOfTheirOwn) {
  ElementTable table;
  ElementRow back_end = row("pull");
  back_end.kind = ElementKind::back_end;
  table.add(row("pull"));
  EXPECT_EQ(table.findBackEnd("pull"), nullptr);
  EXPECT_NO_THROW(table.add(back_end));
  EXPECT_NE(table.findBackEnd("pull"), table.find("pull"));
  EXPECT_THROW(table.add(back_end), std::invalid_argument);
}

TEST(ElementTable, RefusesANameThatIsTaken) {
  ElementTable table;
  table.add(row("pull"));
  try {
    table.add(row("pull"));
    FAIL() << "taken twice";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "element 'pull' is in the table already");
  }
}

TEST(ElementTable, RefusesRowsThatContradictThemselves) {
  EXPECT_EQ(refusal(row("two words")), "'two words' is not a name for an element");
  EXPECT_EQ(refusal(row(".x")), "'.x' is not a name for an element");
  EXPECT_EQ(refusal(row("x.")), "'x.' is not a name for an element");
  EXPECT_EQ(refusal(row("x", {{.name = "a"}, {.name = "a"}})), "<x>: attribute 'a' stands twice");
  EXPECT_EQ(refusal(row("x", {{.name = "a", .type = ValueType::real, .default_text = "-1", .lower = 0}})),
            "<x>: attribute 'a': its default is not valid: '-1' is out of range: expected a number ≥ 0");
  EXPECT_EQ(refusal(row("x", {{.name = "a", .default_text = "b", .required = true}})),
            "<x>: attribute 'a' is required and has a default");
  EXPECT_EQ(refusal(row("x", {{.name = "a", .type = ValueType::choice}})),
            "<x>: attribute 'a' is a choice without choices");
  EXPECT_EQ(refusal(row("x", {{.name = "a", .type = ValueType::port}})),
            "<x>: attribute 'a' is a port without a port type");
  EXPECT_EQ(refusal(row("x", {{.name = "a", .type = ValueType::points}})),
            "<x>: attribute 'a' has points without a count");
  EXPECT_EQ(refusal(row("x", {{.name = "a", .type = ValueType::real, .lower = 1, .upper = 0}})),
            "<x>: attribute 'a' has an empty range");
  ElementRow with_port = row("x");
  with_port.ports = {{"p", "scalar", "", ""}};
  EXPECT_EQ(refusal(with_port), "<x>: only signals and sensors have ports");
  ElementRow sensor = row("x", {{.name = "a", .type = ValueType::port, .port_type = "scalar"}});
  sensor.kind = ElementKind::sensor;
  EXPECT_EQ(refusal(sensor), "<x>: attribute 'a': a sensor stands before all signals and reads no ports");
  sensor.attributes.clear();
  sensor.ports = {{"p", "contact-set", "", ""}};
  EXPECT_EQ(refusal(sensor), "<x>: port 'p' of a sensor is a scalar or a vector");
  ElementRow with_child = row("x");
  with_child.children = {{"y", 2, 1}};
  EXPECT_EQ(refusal(with_child), "<x>: child 'y' has an empty range");
}

}  // namespace
}  // namespace tactus::control
