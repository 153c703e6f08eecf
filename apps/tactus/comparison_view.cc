#include "apps/tactus/comparison_view.h"

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "apps/tactus/html.h"
#include "apps/tactus/plot.h"
#include "apps/tactus/text.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

/// Okabe and Ito's colours, which people who see few colours can tell apart; the reference is black.
constexpr std::array colours{"#222222", "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#b8a800"};

std::string colourOf(size_t back_end) { return colours[back_end % colours.size()]; }

/// One column for each back end; headings are rows of one cell.
class Table {
 public:
  explicit Table(const ordered_json& comparison) : back_ends_(comparison["backends"]) {
    std::vector<std::string> head{""};
    for (const ordered_json& back_end : back_ends_) head.push_back(back_end["backend"].get<std::string>());
    rows_.push_back(head);
  }
  void heading(const std::string& text) { rows_.push_back({text}); }
  void row(const std::string& label, const std::string& pointer) {
    std::vector<std::string> cells{"  " + label};
    for (const ordered_json& back_end : back_ends_) {
      const ordered_json::json_pointer at(pointer);
      const bool known = back_end.contains(at) && back_end[at].is_number();
      cells.push_back(known ? rounded(back_end[at].get<double>()) : "–");
    }
    rows_.push_back(cells);
  }
  void rowsOf(const std::string& pointer) {
    const ordered_json& first = back_ends_.front()[ordered_json::json_pointer(pointer)];
    for (const auto& [name, value] : first.items()) row(name, pointer + "/" + name);
  }
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }

 private:
  const ordered_json& back_ends_;
  std::vector<std::vector<std::string>> rows_;
};

std::vector<std::vector<std::string>> tableRows(const ordered_json& comparison) {
  Table table(comparison);
  table.heading("same " + std::to_string(comparison["sampled_ticks"].get<size_t>()) + " tick problems of " +
                comparison["reference"].get<std::string>());
  table.row("torque difference, mean (M⁻¹ norm)", "/same_states/torque_difference/mean");
  table.row("torque difference, max", "/same_states/torque_difference/max");
  table.row("relative, mean", "/same_states/torque_difference_relative/mean");
  table.row("relative, max", "/same_states/torque_difference_relative/max");
  table.row("constraint violation, max (relative)", "/same_states/violation_max");
  table.row("KKT stationarity, max", "/same_states/kkt_max/stationarity");
  table.row("not solved", "/same_states/unsolved");
  table.row("other active rows, ticks", "/same_states/other_active_rows");
  table.row("other joints at torque limits, ticks", "/same_states/other_limits");
  table.row("solve, median (µs)", "/same_states/solve_us/median");
  table.row("solve, p99 (µs)", "/same_states/solve_us/p99");
  table.heading("closed loop");
  table.row("duration (s)", "/closed_loop/duration_s");
  table.row("× real time", "/closed_loop/realtime_factor");
  table.row("tick, median (µs)", "/closed_loop/tick_us/median");
  table.row("tick, p99 (µs)", "/closed_loop/tick_us/p99");
  for (const char* count : {"fallbacks", "infeasible", "limited"}) {
    table.row(count, std::string("/closed_loop/") + count);
  }
  table.row("KKT stationarity, max", "/closed_loop/kkt_max/stationarity");
  table.row("KKT primal, max", "/closed_loop/kkt_max/primal");
  table.rowsOf("/closed_loop/metrics");
  table.heading("mean task error in closed loop");
  table.rowsOf("/closed_loop/task_errors");
  return table.rows();
}

std::string furthestHeading(const ordered_json& back_end, const ordered_json& comparison) {
  return "where " + back_end["backend"].get<std::string>() + " is furthest from " +
         comparison["reference"].get<std::string>();
}

std::string tableHtml(const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<table>\n<tr><th></th>";
  for (size_t i = 1; i < rows[0].size(); ++i)
    html += "<th class='number'><span style='color:" + colourOf(i - 1) + "'>■</span> " + escaped(rows[0][i]) + "</th>";
  html += "</tr>\n";
  for (size_t r = 1; r < rows.size(); ++r) {
    const std::vector<std::string>& cells = rows[r];
    if (cells.size() == 1) {
      html += "<tr><th colspan='" + std::to_string(rows[0].size()) + "'>" + escaped(cells[0]) + "</th></tr>\n";
      continue;
    }
    html += "<tr><td class='task'>" + escaped(cells[0]) + "</td>";
    for (size_t i = 1; i < cells.size(); ++i) html += "<td class='number'>" + escaped(cells[i]) + "</td>";
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

struct Curves {
  std::string title;
  std::string y_label;
  bool decades = false;
};

double numberOf(const ordered_json& value) { return value.is_number() ? value.get<double>() : NAN; }

/// One line for each back end from `first` on, of points that `sample` takes from it.
LinePlot plotOf(const ordered_json& comparison, const Curves& curves, size_t first,
                const std::function<void(const ordered_json& back_end, Line& line)>& sample) {
  LinePlot plot{curves.title, "time (s)", curves.y_label, {}, {}, "", true, curves.decades};
  const ordered_json& back_ends = comparison["backends"];
  for (size_t i = first; i < back_ends.size(); ++i) {
    Line line{"", colourOf(i), {}, {}};
    sample(back_ends[i], line);
    plot.lines.push_back(line);
  }
  return plot;
}

/// Of each tick problem that all back ends solved.
LinePlot sameStates(const ordered_json& comparison, const Curves& curves, size_t first,
                    const std::function<double(const ordered_json& tick)>& value) {
  return plotOf(comparison, curves, first, [&](const ordered_json& back_end, Line& line) {
    for (const ordered_json& tick : back_end["same_states"]["ticks"]) {
      line.x.push_back(tick["time"].get<double>());
      line.y.push_back(value(tick));
    }
  });
}

LinePlot closedLoop(const ordered_json& comparison, const Curves& curves, const std::string& trace) {
  return plotOf(comparison, curves, 0, [&](const ordered_json& back_end, Line& line) {
    const ordered_json& traces = back_end["closed_loop"]["traces"];
    for (const ordered_json& time : traces["time"]) line.x.push_back(time.get<double>());
    if (!traces.contains(trace)) return;
    for (const ordered_json& value : traces[trace]) line.y.push_back(numberOf(value));
  });
}

double boundsApart(const ordered_json& tick) {
  double count = 0;
  for (const char* list : {"active_here", "active_there", "limits_here", "limits_there"})
    count += static_cast<double>(tick[list].size());
  return count;
}

std::string stacked(const std::vector<LinePlot>& plots) {
  constexpr double width = 1100, height = 230;
  std::string svg;
  for (size_t i = 0; i < plots.size(); ++i)
    svg += draw(plots[i], {0, height * static_cast<double>(i), width, height});
  return svgDocument(width, height * static_cast<double>(plots.size()), svg);
}

std::string section(const std::string& heading, const std::string& said, const std::string& content) {
  return "<section><h2>" + escaped(heading) + "</h2>\n<p>" + escaped(said) + "</p>\n" + content + "</section>\n";
}

std::string legend(const ordered_json& comparison) {
  std::string html = "<p>";
  const ordered_json& back_ends = comparison["backends"];
  for (size_t i = 0; i < back_ends.size(); ++i)
    html += "<span style='color:" + colourOf(i) + "'>■</span> " + escaped(back_ends[i]["backend"].get<std::string>()) +
            (i == 0 ? " (reference)" : "") + "&emsp;";
  return html + "</p>\n";
}

std::string reasons(const ordered_json& comparison) {
  std::string html;
  for (const ordered_json& back_end : comparison["backends"]) {
    const ordered_json& lines = back_end["same_states"]["furthest"];
    if (lines.empty()) continue;
    html += "<h2>" + escaped(furthestHeading(back_end, comparison)) + "</h2>\n<ul>";
    for (const ordered_json& line : lines) html += "<li>" + escaped(line.get<std::string>()) + "</li>\n";
    html += "</ul>\n";
  }
  return html.empty() ? "" : "<section>" + html + "</section>\n";
}

std::string warnings(const ordered_json& comparison) {
  std::string html;
  const auto add = [&](const ordered_json& back_end, const std::string& text) {
    html += "<p class='missed'>" + escaped(back_end["backend"].get<std::string>() + ": " + text) + "</p>\n";
  };
  for (const ordered_json& back_end : comparison["backends"]) {
    const ordered_json& loop = back_end["closed_loop"];
    if (loop["status"] != "done") add(back_end, loop["status"].get<std::string>());
    for (const ordered_json& warning : loop["warnings"]) add(back_end, warning.get<std::string>());
  }
  return html.empty() ? "" : "<section>" + html + "</section>\n";
}

}  // namespace

std::string comparisonText(const ordered_json& comparison) {
  std::string text = textTable(tableRows(comparison));
  for (const ordered_json& back_end : comparison["backends"]) {
    const ordered_json& lines = back_end["same_states"]["furthest"];
    if (lines.empty()) continue;
    text += furthestHeading(back_end, comparison) + "\n";
    for (const ordered_json& line : lines) text += "  " + line.get<std::string>() + "\n";
  }
  return text;
}

std::string comparisonPage(const ordered_json& comparison) {
  const std::string reference = comparison["reference"].get<std::string>();
  const std::string title = comparison["stack"].get<std::string>() + ", seed " +
                            std::to_string(comparison["seed"].get<std::uint64_t>()) + ": back ends compared";
  std::string html = warnings(comparison);
  html += "<section>" + legend(comparison) + tableHtml(tableRows(comparison)) + "</section>\n";
  html += section("The same tick problems",
                  "Every back end solves the recorded problems of " + reference + "'s run, each with its own warm start.",
                  stacked({sameStates(comparison, {"Torque apart from " + reference, "relative, M⁻¹ norm", true}, 1,
                                      [](const ordered_json& tick) { return numberOf(tick["relative"]); }),
                           sameStates(comparison, {"Rows and joints at a bound in one of the two alone", "number"}, 1,
                                      boundsApart),
                           sameStates(comparison, {"Time of the solve", "µs", true}, 0,
                                      [](const ordered_json& tick) { return numberOf(tick["solve_us"]); })}));
  html += reasons(comparison);
  html += section("Closed loop",
                  "Every back end has run the stack itself; each point is the largest of its ticks.",
                  stacked({closedLoop(comparison, {"Links in contact", "number"}, "links"),
                           closedLoop(comparison, {"Largest desired contact force", "N"}, "force_max_N"),
                           closedLoop(comparison, {"Time of a tick", "µs", true}, "tick_max_us")}));
  return htmlPage(title, html);
}

std::string unfinishedPage() {
  return htmlPage("Back ends compared", "<section><p class='missed'>The comparison has not ended, or was cut off: "
                                        "nothing is known yet.</p></section>\n");
}

}  // namespace tactus::app
