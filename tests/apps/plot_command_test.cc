// Columns of a log as a picture.

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

struct Logged {
  TemporaryFolder folder;
  std::string run = folder.file("run");
  Logged() { EXPECT_EQ(tactus({"run", data("press.xml"), "--out", run}).exit_code, 0); }
};

TEST(PlotCommand, DrawsAPanelForEachArgument) {
  const Logged logged;
  const Outcome one = tactus({"plot", logged.run, "task/bow/error"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_THAT(one.out, StartsWith("<svg "));
  EXPECT_THAT(one.out, HasSubstr(">task/bow/error<"));
  EXPECT_THAT(one.out, HasSubstr(" 1100 260'"));
  const Outcome two = tactus({"plot", logged.run, "q/hip,q/knee", "contact/mean_N", "--out", logged.folder.file("a.svg")});
  EXPECT_EQ(two.exit_code, 0) << two.err;
  const std::string svg = contentOf(logged.folder.file("a.svg"));
  for (const char* text : {">q/hip<", ">q/knee<", ">contact/mean_N<", " 1100 520'", "#0072b2", "#e69f00"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_NE(one.out, tactus({"plot", logged.run + "/log.csv", "q/hip"}).out);
}

TEST(PlotCommand, ListsColumnsWhereNoneIsNamed) {
  const Logged logged;
  const Outcome outcome = tactus({"plot", logged.run});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("time\nlevel/1/rank\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\nq/hip\n"));
  EXPECT_EQ(tactus({"plot", logged.run, "--out", logged.folder.file("a.svg")}).exit_code, 2);
}

TEST(PlotCommand, UnitsThatNamesTell) {
  const Logged logged;
  const std::string svg = tactus({"plot", logged.run, "contact/mean_N,contact/max_N", "q/hip", "qd/hip,tau/hip"}).out;
  EXPECT_THAT(svg, HasSubstr(">N</text>"));
  EXPECT_THAT(svg, HasSubstr(">rad</text>"));
  EXPECT_THAT(svg, HasSubstr(">time (s)</text>"));
  EXPECT_THAT(svg, Not(HasSubstr(">rad/s</text>"))) << "two units have no common name";
}

TEST(PlotCommand, OfWhatACutOffRunLeft) {
  const Logged logged;
  const std::string log = logged.folder.write("a.csv", "time,x\n0,1\n1,nan\n2,3\n3,");
  const Outcome outcome = tactus({"plot", log, "x"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("a.csv ends within a line, which is left out"));
  EXPECT_THAT(tactus({"plot", logged.folder.write("b.csv", "time,x\n"), "x"}).out, HasSubstr("has no rows"));
}

TEST(PlotCommand, MeansOfAStudyInABandForEachCondition) {
  const TemporaryFolder folder;
  folder.write("stack.xml", contentOf(data("press.xml")));
  const auto study = [&](const std::string& keep) {
    const std::string file = folder.write(
        keep + ".xml", "<study format=\"1\" name=\"s\" stack=\"" + data("press.xml") + "\" keep=\"" + keep +
                           "\"><seeds from=\"1\" count=\"2\"/><backends names=\"null-space qp\"/></study>");
    EXPECT_EQ(tactus({"study", file, "--jobs", "1", "--out", folder.file(keep)}).exit_code, 0);
    return folder.file(keep);
  };
  const std::string runs = study("runs");
  const Outcome outcome = tactus({"plot", runs, "contact/mean_N"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* text : {">contact/mean_N<", "null-space", "qp", ", n = 2<", "fill-opacity='0.18'", ">time (s)<"})
    EXPECT_THAT(outcome.out, HasSubstr(text));
  EXPECT_EQ(tactus({"plot", runs}).exit_code, 2) << "no column";
  const Outcome unknown = tactus({"plot", runs, "contact/mean"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'contact/mean_N'?"));
  const Outcome bare = tactus({"plot", study("metrics"), "contact/mean_N"});
  EXPECT_EQ(bare.exit_code, 6);
  EXPECT_THAT(bare.err, HasSubstr("the study keeps figures alone, no logs: run it with keep=\"runs\""));
}

TEST(PlotCommand, RefusesWhatItCannotDraw) {
  const Logged logged;
  const Outcome unknown = tactus({"plot", logged.run, "q/hipp"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("has no column 'q/hipp'; did you mean 'q/hip'?"));
  EXPECT_EQ(tactus({"plot", logged.run, "q/hip", "--out", "a.gif"}).exit_code, 2);
  EXPECT_EQ(tactus({"plot", logged.folder.file("none"), "q/hip"}).exit_code, 6);
  Settings bare;
  bare.environment = {"PATH=/nowhere"};
  const Outcome png = tactus({"plot", logged.run, "q/hip", "--out", logged.folder.file("a.png")}, bare);
  EXPECT_EQ(png.exit_code, 6);
  EXPECT_THAT(png.err, HasSubstr("a PNG needs the program rsvg-convert (Debian: librsvg2-bin)"));
}

TEST(PlotCommand, MakesAPng) {
  if (std::system("command -v rsvg-convert > /dev/null") != 0) GTEST_SKIP() << "rsvg-convert is not installed";
  const Logged logged;
  const Outcome outcome = tactus({"plot", logged.run, "q/hip", "--out", logged.folder.file("a.png")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(contentOf(logged.folder.file("a.png")), StartsWith("\x89PNG"));
}

}  // namespace
}  // namespace tactus::testing
