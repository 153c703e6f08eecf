#include "apps/tactus/study_page.h"

#include <algorithm>

#include "apps/tactus/html.h"
#include "apps/tactus/plot.h"
#include "apps/tactus/text.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

constexpr double plot_width = 1100;

/// Every row of a table of results; numbers to four digits, columns that are empty throughout left out.
std::string htmlTable(const ordered_json& table) {
  if (table.empty()) return "";
  std::vector<std::string> keys;
  for (const auto& [key, value] : table.front().items())
    if (std::any_of(table.begin(), table.end(), [&](const ordered_json& row) { return !row[key].is_null(); }))
      keys.push_back(key);
  std::string html = "<div style='overflow-x:auto'><table><tr>";
  for (const std::string& key : keys) html += "<th>" + escaped(key) + "</th>";
  html += "</tr>\n";
  for (const ordered_json& row : table) {
    html += "<tr>";
    for (const std::string& key : keys) {
      const ordered_json& value = row[key];
      if (value.is_string()) html += "<td>" + escaped(value.get<std::string>()) + "</td>";
      else if (value.is_boolean()) html += value.get<bool>() ? "<td>yes</td>" : "<td>no</td>";
      else html += "<td class='number'>" + (value.is_null() ? "–" : rounded(value.get<double>())) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string section(const std::string& title, const std::string& body) {
  return body.empty() ? "" : "<section><h2>" + escaped(title) + "</h2>\n" + body + "</section>\n";
}

GroupPlot groupsOf(const StudyResults& results, size_t metric) {
  GroupPlot plot{results.metrics[metric], "", {}};
  for (long condition = 0; condition < results.plan.conditions(); ++condition) {
    const ConditionFigures& one = results.figures(metric, condition);
    const std::string label = results.plan.label(results.plan.levelsOf(condition));
    plot.groups.push_back({label + " (" + std::to_string(one.figures.n) + ")", one.values, one.figures.lower_quartile,
                           one.figures.median, one.figures.upper_quartile});
  }
  return plot;
}

}  // namespace

std::string plotFile(const std::string& metric) {
  std::string name = metric;
  for (char& c : name)
    if (c == '/' || c == '\\' || c == '\0') c = '-';
  return name + ".svg";
}

std::string boxPlotOf(const StudyResults& results, size_t metric) {
  const GroupPlot plot = groupsOf(results, metric);
  const double height = heightOf(plot);
  return svgDocument(plot_width, height, draw(plot, {0, 0, plot_width, height}));
}

std::string studyPage(const StudyResults& results) {
  const StudyPlan& plan = results.plan;
  std::string html = section(
      "Trials", "<p>" + std::to_string(results.finished()) + " of " + std::to_string(plan.trials()) + " finished, " +
                    std::to_string(results.failed()) + " failed; " + std::to_string(plan.conditions()) +
                    " conditions, " + counted(static_cast<size_t>(plan.seeds), "seed", "seeds") + " from " +
                    std::to_string(plan.first_seed) + ".</p>\n");
  std::string remarks;
  for (const std::string& remark : remarksOf(results)) remarks += "<li>" + escaped(remark) + "</li>\n";
  html += section("To be known", remarks.empty() ? "" : "<ul>" + remarks + "</ul>\n");
  html += section("Comparisons, paired by seed", htmlTable(comparisonTable(results)));
  for (size_t i = 0; i < results.metrics.size(); ++i) html += "<section>" + boxPlotOf(results, i) + "</section>\n";
  html += section("Figures of each condition", htmlTable(conditionTable(results)));
  html += section("All trials", htmlTable(trialTable(results)));
  return htmlPage(results.plan.name, html);
}

}  // namespace tactus::app
