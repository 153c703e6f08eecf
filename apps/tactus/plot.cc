#include "apps/tactus/plot.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

namespace tactus::app {
namespace {

constexpr double margin_left = 62, margin_right = 18, margin_top = 34, margin_bottom = 44;
constexpr double row_height = 34;                                   // of a GroupPlot
constexpr int colours = 32;

/// A number with few digits, enough for a pixel.
std::string px(double value) {
  char text[32];
  const double tenth = std::round(value * 10) / 10;
  return {text, std::to_chars(text, text + sizeof text, tenth == 0 ? 0 : tenth).ptr};
}

std::string pair(double x, double y) { return px(x) + " " + px(y); }

std::string fixed(double value, int decimals) {
  char text[64];
  return {text,
          std::to_chars(text, text + sizeof text, value == 0 ? 0 : value, std::chars_format::fixed, decimals).ptr};
}

/// With an exponent where it is shorter so: 2e+06, 1.5e-07.
std::string general(double value, int digits) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value == 0 ? 0 : value, std::chars_format::general,
                              std::clamp(digits, 1, 17)).ptr};
}

/// 10ⁿ as people write it: 0.01, 1, 1000, 1e-7.
std::string decade(long n) {
  if (n < -3 || n > 4) return "1e" + std::to_string(n);
  return fixed(std::pow(10.0, static_cast<double>(n)), static_cast<int>(std::max(0L, -n)));
}

/// What is larger, or not finite, has no place on an axis: a gap is left.
constexpr double largest_drawn = 1e12;
bool isDrawn(double value) { return std::abs(value) <= largest_drawn; }

struct Range {
  double lower = INFINITY, upper = -INFINITY;
  void add(double value) {
    if (!isDrawn(value)) return;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  double length() const { return upper - lower; }
  /// Something to draw even when there is no value, or only one, or when all are one up to rounding.
  void makeDrawable() {
    if (!(lower <= upper)) *this = {0, 1};
    const double least = std::max(1e-12, 1e-9 * std::max(std::abs(lower), std::abs(upper)));
    if (length() <= 0) {
      const double half = lower == 0 ? 0.5 : std::max(std::abs(lower) / 2, least);
      *this = {lower - half, upper + half};
    } else if (length() < least) {
      *this = {lower - least / 2, upper + least / 2};
    }
  }
  void widen(double fraction) { *this = {lower - fraction * length(), upper + fraction * length()}; }
};

/// 1, 2 or 5 times a power of ten, about `count` of which fill the range.
double niceStep(const Range& range, int count) {
  const double raw = range.length() / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * 0.999) return factor * power;
  }
  return 10 * power;
}

/// The frame of a plot: from values to pixels, axes with ticks and labels.
class Frame {
 public:
  /// `decades`: y is the decimal logarithm of what the labels say.
  Frame(const Box& box, Range x, Range y, bool decades = false) : box_(box), x_(x), y_(y), decades_(decades) {
    area_ = {box.x + margin_left, box.y + margin_top, box.width - margin_left - margin_right,
             box.height - margin_top - margin_bottom};
  }
  void makeEqual() {
    const double scale = std::min(area_.width / x_.length(), area_.height / y_.length());
    const auto stretch = [](Range& range, double length) {
      const double middle = (range.lower + range.upper) / 2;
      range = {middle - length / 2, middle + length / 2};
    };
    stretch(x_, area_.width / scale);
    stretch(y_, area_.height / scale);
  }
  double px_x(double value) const { return area_.x + (value - x_.lower) / x_.length() * area_.width; }
  double px_y(double value) const { return area_.y + area_.height - (value - y_.lower) / y_.length() * area_.height; }
  const Box& area() const { return area_; }

  std::string axes(const std::string& title, const std::string& x_label, const std::string& y_label) const {
    return background() + xTicks() + yTicks() + labels(title, x_label, y_label);
  }
  std::string background() const {
    return "<rect x='" + px(area_.x) + "' y='" + px(area_.y) + "' width='" + px(area_.width) + "' height='" +
           px(area_.height) + "' fill='#fbfbfa' stroke='#c9c9c4'/>\n";
  }
  std::string xTicks() const {
    std::string svg;
    eachTick(x_, static_cast<int>(std::max(2.0, area_.width / 80)), false, [&](double value, const std::string& text) {
      const std::string at = px(px_x(value));
      svg += "<path d='M" + at + " " + px(area_.y) + "v" + px(area_.height) +
             "' stroke='#e7e7e2' fill='none'/><text x='" + at + "' y='" + px(area_.y + area_.height + 16) +
             "' text-anchor='middle' fill='#555'>" + text + "</text>\n";
    });
    return svg;
  }
  std::string yTicks() const {
    std::string svg;
    const auto count = static_cast<int>(std::max(2.0, area_.height / 32));
    eachTick(y_, count, decades_, [&](double value, const std::string& text) {
      svg += "<path d='M" + px(area_.x) + " " + px(px_y(value)) + "h" + px(area_.width) +
             "' stroke='#e7e7e2' fill='none'/>" + yLabel(value, text);
    });
    return svg;
  }
  /// A text left of the axis.
  std::string yLabel(double value, const std::string& text) const {
    return "<text x='" + px(area_.x - 7) + "' y='" + px(px_y(value) + 4) + "' text-anchor='end' fill='#555'>" +
           escaped(text) + "</text>\n";
  }
  std::string labels(const std::string& title, const std::string& x_label, const std::string& y_label) const {
    const double middle = area_.y + area_.height / 2;
    return "<text x='" + px(area_.x) + "' y='" + px(box_.y + 20) + "' font-size='14' font-weight='600' fill='#222'>" +
           escaped(title) + "</text>\n<text x='" + px(area_.x + area_.width / 2) + "' y='" +
           px(box_.y + box_.height - 8) + "' text-anchor='middle' fill='#333'>" + escaped(x_label) +
           "</text>\n<text transform='translate(" + px(box_.x + 16) + " " + px(middle) +
           ") rotate(-90)' text-anchor='middle' fill='#333'>" + escaped(y_label) + "</text>\n";
  }

 private:
  template <class Draw>
  static void eachTick(const Range& range, int count, bool decades, Draw draw) {
    const double step = decades ? std::max(1.0, niceStep(range, count)) : niceStep(range, count);
    const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
    const double largest = std::max(std::abs(range.lower), std::abs(range.upper));
    const bool short_enough = decimals <= 5 && largest < 1e6;
    const int digits = static_cast<int>(std::ceil(std::log10(largest / step))) + 1;
    for (double k = std::ceil(range.lower / step - 1e-9); k * step <= range.upper + 1e-9 * step; ++k)
      draw(k * step, decades        ? decade(std::lround(k * step))
                     : short_enough ? fixed(k * step, decimals)
                                    : general(k * step, digits));
  }

  Box box_, area_;
  Range x_, y_;
  bool decades_;
};

/// At most two points a pixel: the least and the largest value of each bucket, so that no peak is lost.  A bucket
/// without a value to draw is a gap.
Line thinned(const Line& line, size_t buckets) {
  if (line.x.size() <= 2 * buckets || !line.lower.empty()) return line;
  Line thin{line.label, line.colour, {}, {}, {}, {}};
  const auto keep = [&](size_t i) {
    thin.x.push_back(line.x[i]);
    thin.y.push_back(line.y[i]);
  };
  for (size_t b = 0; b < buckets; ++b) {
    const size_t from = b * line.x.size() / buckets, to = (b + 1) * line.x.size() / buckets;
    size_t least = to, largest = to;
    for (size_t i = from; i < to; ++i) {
      if (!isDrawn(line.y[i])) continue;
      if (least == to || line.y[i] < line.y[least]) least = i;
      if (largest == to || line.y[i] > line.y[largest]) largest = i;
    }
    if (least == to) {
      keep(from);
      continue;
    }
    keep(std::min(least, largest));
    if (least != largest) keep(std::max(least, largest));
  }
  return thin;
}

/// y as decimal logarithms; what has none is NaN.
LinePlot inDecades(LinePlot plot) {
  const auto logarithm = [](double value) { return value > 0 ? std::log10(value) : NAN; };
  for (Line& line : plot.lines)
    for (std::vector<double>* values : {&line.y, &line.lower, &line.upper})
      for (double& value : *values) value = logarithm(value);
  if (plot.wanted) plot.wanted = logarithm(*plot.wanted);
  plot.from_zero = false;
  return plot;
}

/// Pieces between gaps; one that is a single value is a dot.
std::string path(const Line& line, const Frame& frame) {
  std::string d;
  size_t in_piece = 0;
  const auto endPiece = [&] {
    if (in_piece == 1) d += "h0";
    in_piece = 0;
  };
  for (size_t i = 0; i < line.x.size(); ++i) {
    if (!isDrawn(line.y[i]) || !isDrawn(line.x[i])) {
      endPiece();
      continue;
    }
    d += in_piece++ > 0 ? 'L' : 'M';
    d += pair(frame.px_x(line.x[i]), frame.px_y(line.y[i]));
  }
  endPiece();
  return "<path d='" + d + "' fill='none' stroke='" + line.colour +
         "' stroke-width='1.4' stroke-linejoin='round' stroke-linecap='round'/>\n";
}

/// The ground between the bounds of a line's band, over the points where it has both.
std::string band(const Line& line, const Frame& frame) {
  std::string there, back;
  for (size_t i = 0; i < line.lower.size(); ++i) {
    if (!isDrawn(line.x[i]) || !isDrawn(line.lower[i]) || !isDrawn(line.upper[i])) continue;
    there += (there.empty() ? 'M' : 'L') + pair(frame.px_x(line.x[i]), frame.px_y(line.upper[i]));
    back = 'L' + pair(frame.px_x(line.x[i]), frame.px_y(line.lower[i])) + back;
  }
  if (there.empty()) return "";
  return "<path d='" + there + back + "Z' fill='" + line.colour + "' fill-opacity='0.18' stroke='none'/>\n";
}

/// Viridis, by linear interpolation between nine of its colours.
std::string viridis(double fraction) {
  constexpr std::array<std::array<int, 3>, 9> stops{{{68, 1, 84},
                                                     {71, 44, 122},
                                                     {59, 81, 139},
                                                     {44, 113, 142},
                                                     {33, 144, 141},
                                                     {39, 173, 129},
                                                     {92, 200, 99},
                                                     {170, 220, 50},
                                                     {253, 231, 37}}};
  const double at = std::clamp(fraction, 0.0, 1.0) * (stops.size() - 1);
  const size_t i = std::min(static_cast<size_t>(at), stops.size() - 2);
  std::string colour = "#";
  for (size_t c = 0; c < 3; ++c) {
    const int value =
        static_cast<int>(std::lround(stops[i][c] + (at - static_cast<double>(i)) * (stops[i + 1][c] - stops[i][c])));
    colour += "0123456789abcdef"[value / 16];
    colour += "0123456789abcdef"[value % 16];
  }
  return colour;
}

/// A label at (x, y) that stays readable on any ground.
std::string haloText(double x, double y, const std::string& text) {
  return "<text x='" + px(x) + "' y='" + px(y) +
         "' fill='#222' stroke='#fff' stroke-width='3' paint-order='stroke'>" + escaped(text) + "</text>\n";
}

/// One row of a GroupPlot, at that height.
std::string drawGroup(const Group& group, double at, const Frame& frame) {
  constexpr double half_box = 9, point_spread = 12, golden = 0.6180339887498949;
  std::string svg = frame.yLabel(at, group.label);
  std::vector<double> values;
  for (const double value : group.values)
    if (isDrawn(value)) values.push_back(value);
  if (values.empty() || !isDrawn(group.median)) return svg;
  const double y = frame.px_y(at), reach = 1.5 * (group.upper_quartile - group.lower_quartile);
  double lowest = group.lower_quartile, highest = group.upper_quartile;
  for (const double value : values) {
    if (value >= group.lower_quartile - reach) lowest = std::min(lowest, value);
    if (value <= group.upper_quartile + reach) highest = std::max(highest, value);
  }
  const auto line = [&](double from, double to, double dy, const char* width) {
    return "M" + pair(frame.px_x(from), y - dy) + "L" + pair(frame.px_x(to), y + dy) +
           "' stroke='#333' stroke-width='" + width + "' fill='none'/>\n";
  };
  const double left = frame.px_x(group.lower_quartile), right = frame.px_x(group.upper_quartile);
  svg += "<path d='" + line(lowest, group.lower_quartile, 0, "1.2") + "<path d='" +
         line(group.upper_quartile, highest, 0, "1.2") + "<rect x='" + px(left) + "' y='" + px(y - half_box) +
         "' width='" + px(std::max(0.5, right - left)) + "' height='" + px(2 * half_box) +
         "' fill='#cfe0ee' stroke='#333'/>\n<path d='" + line(group.median, group.median, half_box, "2.4");
  // Points of the same index stand at the same height in every row, spread evenly.
  std::string points;
  for (size_t i = 0; i < values.size(); ++i) {
    const double turn = golden * static_cast<double>(i + 1);
    points += "M" + pair(frame.px_x(values[i]), y + point_spread * (turn - std::floor(turn) - 0.5)) + "h0";
  }
  return svg + "<path d='" + points +
         "' fill='none' stroke='#d55e00' stroke-opacity='0.75' stroke-width='4.5' stroke-linecap='round'/>\n";
}

std::string drawMarker(const Marker& marker, const Frame& frame) {
  const double x = frame.px_x(marker.x), y = frame.px_y(marker.y);
  const std::string shape =
      marker.ring ? "<circle cx='" + px(x) + "' cy='" + px(y) + "' r='9' fill='none'"
                  : "<path d='M" + px(x - 6) + " " + px(y - 6) + "l12 12m0 -12l-12 12' fill='none'";
  return shape + " stroke='#d62728' stroke-width='2.2'/>\n" +
         haloText(x + 13, y + (marker.ring ? -7 : 14), marker.label);
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&': safe += "&amp;"; break;
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      case '"': safe += "&quot;"; break;
      case '\'': safe += "&#39;"; break;
      default: safe += c;
    }
  }
  return safe;
}

std::string draw(const LinePlot& given, const Box& box) {
  const LinePlot plot = given.log_y ? inDecades(given) : given;
  Range x, y;
  for (const Line& line : plot.lines) {
    for (const double value : line.x) x.add(value);
    for (const std::vector<double>* values : {&line.y, &line.lower, &line.upper})
      for (const double value : *values) y.add(value);
  }
  if (plot.wanted) y.add(*plot.wanted);
  if (plot.from_zero) y.add(0);
  x.makeDrawable();
  y.makeDrawable();
  y.upper += 0.06 * y.length();
  if (y.lower < 0 || (!plot.from_zero && !plot.log_y)) y.lower -= 0.06 * y.length();

  // Keys from the right, on the line of the title and, where they are many, on more lines below it.
  constexpr double key_height = 18;
  const double right = box.x + box.width - margin_right;
  double key = right, key_y = box.y + 20;
  std::string keys;
  const auto addKey = [&](const std::string& label, const std::string& stroke) {
    const double width = 7.0 * static_cast<double>(label.size()) + 34;
    if (key < right && key - width < box.x + margin_left / 2) {
      key = right;
      key_y += key_height;
    }
    key -= width;
    keys += "<path d='M" + px(key) + " " + px(key_y - 4) + "h20' fill='none' " + stroke + "/><text x='" + px(key + 25) +
            "' y='" + px(key_y) + "' fill='#333'>" + escaped(label) + "</text>\n";
  };
  const bool wanted = plot.wanted && isDrawn(*plot.wanted);
  const std::string dashed = "stroke='#444' stroke-width='1.4' stroke-dasharray='6 4'";
  if (wanted) addKey(plot.wanted_label, dashed);
  for (auto line = plot.lines.rbegin(); line != plot.lines.rend(); ++line) {
    if (!line->label.empty()) addKey(line->label, "stroke='" + line->colour + "' stroke-width='2.5'");
  }

  const double extra = key_y - box.y - 20;
  const Frame frame({box.x, box.y + extra, box.width, box.height - extra}, x, y, plot.log_y);
  std::string svg = frame.axes(plot.title, plot.x_label, plot.y_label);
  for (const Line& line : plot.lines) svg += band(line, frame);
  for (const Line& line : plot.lines) svg += path(thinned(line, static_cast<size_t>(frame.area().width)), frame);
  if (wanted)
    svg += "<path d='M" + px(frame.area().x) + " " + px(frame.px_y(*plot.wanted)) + "h" + px(frame.area().width) +
           "' fill='none' " + dashed + "/>\n";
  return svg + keys;
}

double heightOf(const GroupPlot& plot) {
  return row_height * static_cast<double>(std::max<size_t>(1, plot.groups.size())) + margin_top + margin_bottom;
}

std::string draw(const GroupPlot& plot, const Box& box) {
  Range x;
  size_t longest = 0;
  for (const Group& group : plot.groups) {
    for (const double value : group.values) x.add(value);
    longest = std::max(longest, group.label.size());
  }
  x.makeDrawable();
  x.widen(0.04);
  // Half of the picture at most for labels.
  const double label_width = std::min(box.width / 2, 6.5 * static_cast<double>(longest) + 14) - margin_left;
  const Frame frame({box.x + std::max(0.0, label_width), box.y, box.width - std::max(0.0, label_width), box.height}, x,
                    {0, static_cast<double>(std::max<size_t>(1, plot.groups.size()))});
  std::string svg = frame.background() + frame.xTicks() + frame.labels(plot.title, plot.x_label, "");
  for (size_t i = 0; i < plot.groups.size(); ++i)
    svg += drawGroup(plot.groups[i], static_cast<double>(plot.groups.size() - i) - 0.5, frame);
  return svg;
}

std::string draw(const PointPlot& plot, const Box& box) {
  Range x, y;
  for (const double value : plot.x) x.add(value);
  for (const double value : plot.y) y.add(value);
  for (const Marker& marker : plot.markers) {
    x.add(marker.x);
    y.add(marker.y);
  }
  x.makeDrawable();
  y.makeDrawable();
  x.widen(0.05);
  y.widen(0.08);
  Frame frame(box, x, y);
  if (plot.equal_axes) frame.makeEqual();

  // One path for each colour; points that would cover the same pixel are drawn once.
  std::array<std::string, colours> paths;
  std::set<std::pair<long, long>> covered[colours];
  for (size_t i = 0; i < plot.x.size(); ++i) {
    if (!isDrawn(plot.x[i]) || !isDrawn(plot.y[i]) || !isDrawn(plot.value[i])) continue;
    const double fraction = plot.value_max > 0 ? plot.value[i] / plot.value_max : 0;
    const auto colour = static_cast<size_t>(std::clamp(fraction, 0.0, 1.0) * (colours - 1));
    const double at_x = frame.px_x(plot.x[i]), at_y = frame.px_y(plot.y[i]);
    if (!covered[colour].insert({std::lround(at_x), std::lround(at_y)}).second) continue;
    paths[colour] += 'M';
    paths[colour] += pair(at_x, at_y) + "h0";
  }
  std::string svg = frame.axes(plot.title, plot.x_label, plot.y_label);
  for (size_t colour = 0; colour < paths.size(); ++colour) {
    if (paths[colour].empty()) continue;
    svg += "<path d='" + paths[colour] + "' fill='none' stroke='" +
           viridis(static_cast<double>(colour) / (colours - 1)) + "' stroke-width='3.2' stroke-linecap='round'/>\n";
  }
  for (const Marker& marker : plot.markers) {
    if (isDrawn(marker.x) && isDrawn(marker.y)) svg += drawMarker(marker, frame);
  }
  return svg;
}

std::string note(const std::string& text, const Box& box) {
  return "<text x='" + px(box.x + box.width / 2) + "' y='" + px(box.y + box.height / 2) +
         "' text-anchor='middle' fill='#555'>" + escaped(text) + "</text>\n";
}

std::string drawColourBar(const std::string& label, double value_max, const Box& box) {
  std::string svg;
  const double step = box.width / colours;
  for (int i = 0; i < colours; ++i) {
    svg += "<rect x='" + px(box.x + i * step) + "' y='" + px(box.y) + "' width='" + px(step + 0.5) + "' height='" +
           px(box.height) + "' fill='" + viridis(static_cast<double>(i) / (colours - 1)) + "'/>";
  }
  const auto text = [&](double x, const std::string& anchor, const std::string& content) {
    svg += "<text x='" + px(x) + "' y='" + px(box.y + box.height + 15) + "' text-anchor='" + anchor + "' fill='#333'>" +
           escaped(content) + "</text>\n";
  };
  text(box.x, "start", "0");
  text(box.x + box.width / 2, "middle", label);
  text(box.x + box.width, "end", fixed(value_max, value_max < 10 ? 1 : 0));
  return svg;
}

std::string svgDocument(double width, double height, const std::string& content) {
  return "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " + px(width) + " " + px(height) + "' width='" +
         px(width) + "' height='" + px(height) +
         "' font-family=\"system-ui, 'DejaVu Sans', 'Liberation Sans', sans-serif\" font-size='12'>\n"
         "<rect width='100%' height='100%' fill='#fff'/>\n" +
         content + "</svg>\n";
}

}  // namespace tactus::app
