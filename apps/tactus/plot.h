#pragma once

#include <optional>
#include <string>
#include <vector>

/// Plain SVG plots: no script, no style sheet from elsewhere.
namespace tactus::app {

/// Where a plot stands in its picture, in pixels.
struct Box {
  double x = 0, y = 0, width = 0, height = 0;
};

struct Line {
  std::string label;
  std::string colour;                                              ///< CSS
  std::vector<double> x;                                           ///< rising
  std::vector<double> y;
  std::vector<double> lower = {}, upper = {};                       ///< a band about it, as long as y, or none
};

/// Lines over a common rising axis, most often time.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Line> lines;
  std::optional<double> wanted;                                    ///< dashed level
  std::string wanted_label;
  bool from_zero = true;                                           ///< 0 belongs to the y axis
  bool log_y = false;                                              ///< decades; what is not positive leaves a gap
};

struct Marker {
  double x = 0, y = 0;
  bool ring = false;                                               ///< else a cross
  std::string label;
};

/// Points coloured by a third value, those with a high value drawn last.
struct PointPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<double> x, y, value;
  double value_max = 1;                                            ///< of the colour scale, which begins at 0
  bool equal_axes = false;                                         ///< one scale for both
  std::vector<Marker> markers;
};

/// Values of one condition.
struct Group {
  std::string label;
  std::vector<double> values;
  double lower_quartile = 0, median = 0, upper_quartile = 0;       ///< NaN without values
};

/// A lying box from quartile to quartile for each group, with its median, whiskers to the furthest values within 1.5
/// boxes (Tukey, Exploratory Data Analysis, 1977), and every value as a point.
struct GroupPlot {
  std::string title;
  std::string x_label;
  std::vector<Group> groups;                                       ///< from above
};

/// Pixels that a plot of these groups wants.
double heightOf(const GroupPlot& plot);

std::string draw(const GroupPlot& plot, const Box& box);
std::string draw(const LinePlot& plot, const Box& box);
std::string draw(const PointPlot& plot, const Box& box);
/// A sentence instead of a plot that has nothing to show.
std::string note(const std::string& text, const Box& box);
/// The colour scale of PointPlot from 0 to `value_max`.
std::string drawColourBar(const std::string& label, double value_max, const Box& box);
/// A whole SVG document of that size.
std::string svgDocument(double width, double height, const std::string& content);
/// Text for XML and HTML: &, < and > and quotes are replaced.
std::string escaped(const std::string& text);

}  // namespace tactus::app
