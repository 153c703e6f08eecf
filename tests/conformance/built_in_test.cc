// Every built-in task, signal and shape, and every shipped plugin, keeps the laws.
//
// Strategy: one stack holds instances that use every attribute; a test fails when a type has none.

#include <gtest/gtest.h>

#include <set>

#include "conformance/bench.h"
#include "conformance/conformance.h"

namespace tactus::conformance {
namespace {

const std::string kStack = TACTUS_SOURCE_DIR "/tests/conformance/every_element.xml";

std::vector<std::string> allButShapesAndBackEnds(const control::Registry& registry) {
  std::vector<std::string> names;
  for (const control::ElementRow& row : registry.elements().rows())
    if (row.kind != control::ElementKind::structure && row.kind != control::ElementKind::shape &&
        row.kind != control::ElementKind::back_end)
      names.push_back(row.name);
  return names;
}

TEST(BuiltIns, KeepTheLaws) {
  Workshop workshop;
  const dsl::Stack stack = workshop.read(kStack);
  const Report report = checkElements(workshop.registry(), allButShapesAndBackEnds(workshop.registry()), &stack);
  EXPECT_TRUE(report.conforms()) << report.text();
  std::set<std::string> not_asked;
  for (const Finding& finding : report.findings)
    if (finding.outcome == Outcome::not_asked) not_asked.insert(finding.law);
  EXPECT_EQ(not_asked, std::set<std::string>{"bias"}) << report.text();
}

TEST(BuiltIns, ConformWithoutAStackToo) {
  Workshop workshop;
  const Report report = checkElements(workshop.registry(), allButShapesAndBackEnds(workshop.registry()));
  EXPECT_TRUE(report.conforms()) << report.text();
}

TEST(BuiltIns, HaveAnInstanceInTheStackOfThisTest) {
  Workshop workshop;
  const dsl::Stack stack = workshop.read(kStack);
  std::set<std::string> there;
  for (const dsl::ResolvedElement& element : stack.elements) there.insert(element.values.row().name);
  for (const std::string& name : allButShapesAndBackEnds(workshop.registry())) EXPECT_TRUE(there.contains(name)) << name;
}

TEST(Shapes, KeepTheLaws) {
  Workshop workshop;
  const dsl::Stack stack = workshop.read(TACTUS_SOURCE_DIR "/tests/conformance/every_shape.xml");
  const std::vector<std::string> shapes = workshop.registry().names(control::ElementKind::shape);
  std::set<std::string> there;
  for (const auto& object : stack.objects)
    for (const auto& values : object.shapes) there.insert(values.row().name);
  EXPECT_EQ(there, std::set<std::string>(shapes.begin(), shapes.end())) << "each has an instance";

  const Report report = checkElements(workshop.registry(), shapes, &stack);
  EXPECT_TRUE(report.conforms()) << report.text();
  for (const Finding& finding : report.findings)
    if (finding.outcome == Outcome::not_asked) {
      const bool of_plane = finding.element == "plane" && finding.law == "bounding";
      EXPECT_TRUE(of_plane || finding.law == "convex") << finding.element << ": " << finding.law;
    }
}

TEST(Shapes, AreMadeFromTheirDefaultsWhereNothingElseIsNeeded) {
  Workshop workshop;
  const Report report = checkElements(workshop.registry(), {"box", "cone", "ellipsoid", "torus"});
  EXPECT_TRUE(report.conforms()) << report.text();
  EXPECT_FALSE(checkElements(workshop.registry(), {"mesh"}).conforms());
}

TEST(BackEnds, KeepTheLaws) {
  Workshop workshop;
  const Report report = checkElements(workshop.registry(), workshop.registry().names(control::ElementKind::back_end));
  EXPECT_TRUE(report.conforms()) << report.text();
}

}  // namespace
}  // namespace tactus::conformance
