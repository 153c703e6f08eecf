// What a picture shows is looked at by people; what can be tested is that nothing is lost and nothing is malformed.

#include "apps/tactus/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr Box box{0, 0, 600, 300};

void expectWellFormed(const std::string& svg) {
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(svg.c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Plot, ABandIsClosedBelowItsLineAndWidensTheAxis) {
  LinePlot plot{"", "", "", {{"", "blue", {0, 1, 2}, {1, 1, 1}, {0.5, 0, 0.5}, {1.5, 7, 1.5}}}, {}, "", true};
  const std::string svg = svgDocument(600, 300, draw(plot, box));
  expectWellFormed(svg);
  EXPECT_THAT(svg, HasSubstr("Z' fill='blue' fill-opacity='0.18'"));
  EXPECT_THAT(svg, HasSubstr(">6<")) << "the axis goes on to the upper bound";
}

TEST(Plot, LinesHaveTitleAndUnits) {
  LinePlot plot{"Forces", "time (s)", "force (N)", {{"mean", "blue", {0, 1, 2}, {0, 0.5, 0.4}}}, 0.5, "wanted", true};
  const std::string svg = svgDocument(600, 300, draw(plot, box));
  expectWellFormed(svg);
  for (const char* text : {"Forces", "time (s)", "force (N)", "mean", "wanted"}) EXPECT_THAT(svg, HasSubstr(text));
}

TEST(Plot, DecadesLeaveAGapWhereThereIsNoLogarithm) {
  LinePlot plot{"Times", "time (s)", "µs", {{"", "blue", {0, 1, 2, 3, 4}, {1e-5, 10, 0, -3, 1000}}}, {}, "", true, true};
  const std::string svg = svgDocument(600, 300, draw(plot, box));
  expectWellFormed(svg);
  for (const char* label : {">1e-4<", ">100<"}) EXPECT_THAT(svg, HasSubstr(label));
}

TEST(Plot, APeakOfOneSampleIsNotThinnedAway) {
  Line line{"", "blue", {}, {}};
  for (int i = 0; i < 100000; ++i) {
    line.x.push_back(i);
    line.y.push_back(i == 54321 ? 10 : 1);
  }
  const std::string svg = svgDocument(600, 300, draw(LinePlot{"t", "x", "y", {line}, {}, "", true}, box));
  expectWellFormed(svg);
  EXPECT_LT(svg.size(), 40000u);
  // 10 is 1/1.06 of the axis: 34 px of margin, 222 px of axis.
  EXPECT_THAT(svg, HasSubstr(" 46.6"));
}

/// How many pieces the only line has, and how many of them are dots.
std::pair<size_t, size_t> piecesOf(const std::vector<double>& y) {
  std::vector<double> x(y.size());
  for (size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i);
  const std::string svg = draw(LinePlot{"t", "x", "y", {{"", "blue", x, y}}, {}, "", false}, box);
  expectWellFormed(svgDocument(600, 300, svg));
  const size_t from = svg.rfind("<path d='", svg.find("stroke='blue'"));
  const std::string d = svg.substr(from + 9, svg.find('\'', from + 9) - from - 9);
  size_t dots = 0;
  for (size_t at = 0; (at = d.find("h0", at)) != std::string::npos; ++at) ++dots;
  return {static_cast<size_t>(std::count(d.begin(), d.end(), 'M')), dots};
}

TEST(Plot, WhatIsNoNumberIsAGapAndAValueAloneADot) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(piecesOf({1, 2, nan, 3, 2, INFINITY, 4}), (std::pair<size_t, size_t>{3, 1}));
  EXPECT_EQ(piecesOf({nan, nan}), (std::pair<size_t, size_t>{0, 0}));
  // Thinned, too: a gap of a tenth of the axis stays, and single samples without a number take no peak away.
  std::vector<double> many(100000, 1.0);
  std::fill(many.begin() + 40000, many.begin() + 50000, nan);
  for (size_t i = 0; i < many.size(); i += 3) many[i] = nan;
  many[70000] = 10;
  EXPECT_EQ(piecesOf(many), (std::pair<size_t, size_t>{2, 0}));
}

TEST(Plot, AConstantHasARangeOfItsOwnSize) {
  for (const auto& [value, label] : {std::pair{1e-6, ">1e-06<"}, {4e6, ">4e+06<"}, {0.0, ">0.0<"}, {-3.0, ">-3<"}}) {
    const std::string svg =
        draw(LinePlot{"t", "x", "y", {{"", "blue", {0, 1, 2}, {value, value, value}}}, {}, "", false}, box);
    expectWellFormed(svgDocument(600, 300, svg));
    EXPECT_THAT(svg, HasSubstr(label));
  }
}

TEST(Plot, KeysThatFillALineGoOnInTheNext) {
  LinePlot plot{"", "x", "y", {}, {}, "", false};
  for (int i = 0; i < 9; ++i)
    plot.lines.push_back({"a/name/of/some/length/" + std::to_string(i), "blue", {0, 1}, {0, 1}});
  const std::string svg = draw(plot, box);
  expectWellFormed(svgDocument(600, 300, svg));
  for (size_t at = 0; (at = svg.find("h20'", at)) != std::string::npos; ++at) {
    const size_t from = svg.rfind("<path d='M", at) + 10;
    EXPECT_GE(std::stod(svg.substr(from)), 0) << "a key left of the picture";
  }
}

TEST(Plot, NothingOneValueAndNotANumberCanBeDrawn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& y : {std::vector<double>{}, {1}, {nan, nan}, {1, nan, 2}, {5, 5, 5}}) {
    std::vector<double> x(y.size());
    for (size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i);
    expectWellFormed(svgDocument(600, 300, draw(LinePlot{"t", "x", "y", {{"", "blue", x, y}}, {}, "", false}, box)));
  }
  expectWellFormed(svgDocument(600, 300, draw(PointPlot{"t", "x", "y", {}, {}, {}, 1, true, {}}, box)));
}

TEST(Plot, ValuesBeyondEveryAxisLeaveAGap) {
  for (const std::vector<double>& y :
       {std::vector<double>{1e300, -1e300, 1}, {1e20, 1e20, 1e20}, {1e17, 1e17 + 16, 1e17}, {0, 1e-300, 0},
        {1e11, 1e11 + 1e-4, 1e11}, {1e12, -1e12, 0}}) {
    expectWellFormed(svgDocument(600, 300, draw(LinePlot{"t", "x", "y", {{"", "blue", {0, 1, 2}, y}}, 1e300, "w", false}, box)));
    expectWellFormed(svgDocument(600, 300, draw(PointPlot{"t", "x", "y", y, {0, 1, 2}, y, 1, true, {{1e300, 0, true, "m"}}}, box)));
  }
}

TEST(Plot, EqualAxesHaveOneScale) {
  PointPlot plot{"t", "x", "y", {0, 1}, {0, 0}, {0, 0}, 1, true, {{0, 0, true, "here"}, {1, 1, false, "there"}}};
  const std::string svg = svgDocument(600, 600, draw(plot, {0, 0, 600, 600}));
  expectWellFormed(svg);
  EXPECT_THAT(svg, HasSubstr("here"));
  EXPECT_THAT(svg, HasSubstr("there"));
}

TEST(Plot, NamesCannotBreakTheFile) {
  EXPECT_EQ(escaped("<a & 'b' \"c\">"), "&lt;a &amp; &#39;b&#39; &quot;c&quot;&gt;");
  expectWellFormed(svgDocument(1, 1, draw(LinePlot{"</svg><script>", "&", "'", {}, {}, "", true}, box)));
}

}  // namespace
}  // namespace tactus::app
