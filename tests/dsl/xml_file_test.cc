#include "dsl/xml_file.h"

#include <gtest/gtest.h>

#include "dsl/findings.h"

namespace tactus::dsl {
namespace {

std::unique_ptr<XmlElement> parse(const std::string& text, Findings& findings) {
  auto source = std::make_shared<XmlSource>();
  source->text = SourceText("f.xml", text);
  return parseXml(source, findings);
}

TEST(XmlFile, JoinsValuesWithPlaces) {
  Findings findings;
  const auto root = parse("<a>\n  <b c='1 &lt; 2'/>\n  <d><e f='&#xFC;'/></d>\n</a>", findings);
  ASSERT_TRUE(root);
  ASSERT_EQ(root->children.size(), 2u);
  EXPECT_EQ(root->children[0]->attribute("c")->value, "1 < 2");
  EXPECT_EQ(root->children[0]->place().line, 2);
  EXPECT_EQ(root->children[0]->place().column, 3);
  EXPECT_EQ(root->child("d")->child("e")->attribute("f")->value, "ü");
  EXPECT_EQ(root->child("d")->child("e")->parent, root->child("d"));
  EXPECT_EQ(root->attribute("c"), nullptr);
}

TEST(XmlFile, APathTellsElementsApartByNamePriorityOrClass) {
  Findings findings;
  const auto root =
      parse("<stack name='x'><level priority='2'><t name='n'/></level><defaults class='c'/></stack>", findings);
  EXPECT_EQ(root->path(), "/stack");
  EXPECT_EQ(root->child("level")->child("t")->path(), "/stack/level[@priority=2]/t[@name=n]");
  EXPECT_EQ(root->child("defaults")->path(), "/stack/defaults[@class=c]");
}

TEST(XmlFile, RefusesWhatIsNotUtf8AndWhatIsTooDeep) {
  Findings findings;
  EXPECT_FALSE(parse("<a>\n \xFF</a>", findings));
  ASSERT_EQ(findings.errors().size(), 1u);
  EXPECT_EQ(findings.errors()[0].code, "E005");
  EXPECT_EQ(findings.errors()[0].place.line, 2);
  EXPECT_EQ(findings.errors()[0].place.column, 2);

  std::string deep;
  for (int i = 0; i < 5000; ++i) deep += "<a>";
  for (int i = 0; i < 5000; ++i) deep += "</a>";
  Findings more;
  EXPECT_FALSE(parse(deep, more));
  ASSERT_EQ(more.errors().size(), 1u);
  EXPECT_EQ(more.errors()[0].code, "E003");
  EXPECT_EQ(more.errors()[0].message, "elements are nested too deeply");
}

}  // namespace
}  // namespace tactus::dsl
