#include "apps/tactus/report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

#include "apps/tactus/command.h"
#include "apps/tactus/html.h"
#include "apps/tactus/json_place.h"
#include "apps/tactus/plot.h"
#include "apps/tactus/replay_data.h"
#include "apps/tactus/replay_page.h"
#include "apps/tactus/run_folder.h"
#include "apps/tactus/screenshot.h"
#include "apps/tactus/targets.h"
#include "apps/tactus/text.h"
#include "apps/tactus/touched_cloud.h"
#include "apps/tactus/xray_view.h"
#include "framework/control/element_values.h"
#include "framework/runtime/csv_table.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using runtime::CsvTable;

constexpr const char* blue = "#1f6fb4";
constexpr const char* orange = "#e07b1a";
constexpr const char* grey = "#9a9a94";

/// What the report is made of.
struct RunData : RunRecord {
  std::string xray_path;
  ordered_json xray;                                               ///< null where there is none
  JsonPlace xrays() const { return {xray_path, xray}; }
};

RunData readRunFolder(const std::string& folder) {
  RunData data{readRunRecord(folder), folder + "/" + xray_file, {}};
  if (fs::exists(data.xray_path)) data.xray = readJson(data.xray_path);
  return data;
}

Line logLine(const CsvTable& log, const std::string& column, const std::string& label, const std::string& colour) {
  return {label, colour, log.numbers("time"), log.numbers(column)};
}

std::string drawContactNumber(const RunData& data, const Box& box) {
  LinePlot plot{"Links in contact", "time (s)", "number", {}, {}, "", true};
  plot.lines.push_back(logLine(data.log, "contact/links", "", blue));
  return draw(plot, box);
}

std::string drawForces(const RunData& data, const Box& box) {
  LinePlot plot{"Contact forces", "time (s)", "force (N)", {}, {}, "wanted", true};
  plot.lines.push_back(logLine(data.log, "contact/undesired_max_N", "undesired, largest", grey));
  plot.lines.push_back(logLine(data.log, "contact/max_N", "desired, largest", orange));
  plot.lines.push_back(logLine(data.log, "contact/mean_N", "desired, mean", blue));
  plot.wanted = data.run().at("wanted_force_N").number();
  return draw(plot, box);
}

std::string drawContacts(const RunData& data) {
  if (data.log.rows() == 0) return svgDocument(1100, 60, note("No tick was logged.", {0, 0, 1100, 60}));
  return svgDocument(1100, 560, drawContactNumber(data, {0, 0, 1100, 240}) + drawForces(data, {0, 240, 1100, 320}));
}

/// Where features were found and where they really are, seen along one axis of the world.
std::vector<Marker> featureMarkers(const RunData& data, size_t horizontal, size_t vertical, double plane) {
  std::vector<Marker> markers;
  const auto add = [&](const JsonPlace& point, bool ring, const std::string& label) {
    if (!point.exists()) return;
    std::vector<double> p_W;
    for (const JsonPlace& coordinate : point.items()) p_W.push_back(coordinate.number().value_or(NAN));
    p_W.resize(3, NAN);
    markers.push_back({p_W[horizontal], vertical == 2 ? (p_W[2] - plane) * 1000 : p_W[vertical], ring, label});
  };
  for (const JsonPlace& feature : data.run().at("features").items()) {
    const std::string name = feature.at("name").text();
    add(feature.at("truth_W"), true, name + ", true top");
    add(feature.at("position_W"), false, name + ", found");
  }
  return markers;
}

std::string drawTouchedPoints(const RunData& data) {
  if (data.touched.rows() == 0) return svgDocument(1100, 60, note("Nothing was touched.", {0, 0, 1100, 60}));
  const TouchedCloud cloud = touchedCloud(data.touched);
  const auto view = [&](const std::string& title, const std::string& x_label, const std::string& y_label,
                        const std::vector<double>& x, const std::vector<double>& y, size_t horizontal,
                        size_t vertical) {
    return PointPlot{title,           x_label,          y_label, x, y, cloud.height_mm, cloud.height_max, vertical != 2,
                     featureMarkers(data, horizontal, vertical, cloud.plane)};
  };
  const std::string above = "height (mm)";
  return svgDocument(
      1100, 560,
      draw(view("Touched points from above", "x (m)", "y (m)", cloud.x, cloud.y, 0, 1), {0, 0, 560, 510}) +
          drawColourBar("height above the lowest plane (mm)", cloud.height_max, {62, 520, 480, 12}) +
          draw(view("From the side: x and height", "x (m)", above, cloud.x, cloud.height_mm, 0, 2),
               {560, 0, 540, 280}) +
          draw(view("From the side: y and height", "y (m)", above, cloud.y, cloud.height_mm, 1, 2),
               {560, 280, 540, 280}));
}

/// One small plot for the error of each task.
std::string drawTaskErrors(const RunData& data) {
  constexpr double width = 550, height = 210;
  std::string svg;
  int count = 0;
  for (const std::string& column : data.log.columns()) {
    if (!column.starts_with("task/") || !column.ends_with("/error")) continue;
    const std::string task = column.substr(5, column.size() - 5 - 6);
    LinePlot plot{"Error of task " + task, "time (s)", "error", {logLine(data.log, column, "", blue)}, {}, "", true};
    svg += draw(plot, {width * (count % 2), height * (count / 2), width, height});
    ++count;
  }
  return svgDocument(2 * width, height * ((count + 1) / 2), svg);
}

std::string number(const JsonPlace& value, int digits = 4) { return rounded(value.number().value_or(NAN), digits); }

std::string metricsTable(const JsonPlace& run) {
  const bool has_targets = !run.at("wanted").members().empty();
  std::string html = std::string("<table><tr><th>metric</th><th>value</th>") +
                     (has_targets ? "<th>wanted</th><th></th>" : "") + "</tr>\n";
  const auto addRow = [&](const std::string& name, const JsonPlace& value) {
    html += "<tr><td>" + escaped(name) + "</td><td class='number'>" + number(value) + "</td>";
    if (const JsonPlace wanted = run.at("wanted").at(name); wanted.exists()) {
      const Target target = targetFromJson(wanted);
      const bool met = target.metBy(value.number().value_or(NAN));
      html += "<td class='number'>" + escaped(target.text()) + "</td><td class='" +
              (met ? std::string("met'>met") : std::string("missed'>missed")) + "</td>";
    } else if (has_targets) {
      html += "<td></td><td></td>";
    }
    html += "</tr>\n";
  };
  for (const auto& [name, value] : run.at("metrics").members()) addRow(name, value);
  return html + "</table>\n";
}

/// What was asked to go wrong, and when it did; nothing where nothing was.
std::string faultsTable(const JsonPlace& run) {
  std::string rows;
  const auto cell = [](const JsonPlace& time, const std::string& none) {
    return "<td class='number'>" + (time.number() ? number(time, 8) : none) + "</td>";
  };
  for (const JsonPlace& fault : run.at("faults").items())
    rows += "<tr><td>" + escaped(fault.at("name").text()) + "</td><td>" + escaped(fault.at("kind").text()) + "</td>" +
            cell(fault.at("began_s"), "never") + cell(fault.at("ended_s"), "–") + "</tr>\n";
  if (rows.empty()) return "";
  return "<section><table><tr><th>fault</th><th>kind</th><th>began (s)</th><th>ended (s)</th></tr>\n" + rows +
         "</table></section>\n";
}

std::string facts(const JsonPlace& run) {
  const JsonPlace tick = run.at("tick_us"), ticks = run.at("ticks");
  std::vector<std::pair<std::string, std::string>> rows{
      {"back end", run.at("backend").text()},
      {"seed", number(run.at("seed"), 10)},
      {"status", run.at("status").text()},
      {"simulated", number(run.at("duration_s")) + " s, " + number(run.at("realtime_factor"), 3) + " × real time"},
      {"tick", number(tick.at("median")) + " µs median, " + number(tick.at("p99")) + " µs p99"},
      {"fallbacks", number(ticks.at("fallback"), 10)},
      {"ticks with limited torque", number(ticks.at("limited"), 10)}};
  for (const auto& [name, value] : run.at("backend_options").members()) rows.emplace_back(name, value.text());
  std::string html = "<table>\n";
  for (const auto& [name, value] : rows) {
    html += "<tr><td>" + escaped(name) + "</td><td>" + escaped(value) + "</td></tr>\n";
  }
  return html + "</table>\n";
}

/// What a reader must know before the figures.
std::string warnings(const RunData& data) {
  std::string html;
  const auto add = [&](const std::string& text) { html += "<p class='missed'>" + escaped(text) + "</p>\n"; };
  if (data.cut_off) add("This run was cut off, or is still going: what it had written is shown.");
  if (data.run().at("message").exists()) add(data.run().at("message").text());
  for (const JsonPlace& warning : data.run().at("warnings").items()) add(warning.text());
  for (const std::string& warning : data.warnings) add(warning + ".");
  return html.empty() ? "" : "<section>" + html + "</section>\n";
}

std::string xrayTable(const JsonPlace& xray) {
  std::string html = "<h2>Priority x-ray at t = " + number(xray.at("time"), 6) + " s: " +
                     escaped(xray.at("why").text()) + "</h2>\n<table>\n";
  bool head = true;
  for (const std::vector<std::string>& row : xrayRows(xray)) {
    const std::string cell = head ? "th" : "td";
    html += "<tr>";
    for (size_t i = 0; i < row.size(); ++i) {
      const size_t indent = row[i].find_first_not_of(' ');
      const bool task = i == 0 && indent != std::string::npos && indent > 0;
      html += "<" + cell + (i == 0 ? (task ? " class='task'" : "") : " class='number'") + ">" + escaped(row[i]) + "</" +
              cell + ">";
    }
    html += "</tr>\n";
    head = false;
  }
  html += "</table>\n<ul>";
  for (const std::string& sentence : xraySentences(xray)) html += "<li>" + escaped(sentence) + "</li>\n";
  return html + "</ul>\n";
}

/// What higher levels took from lower ones; runs that were cut off have none.
std::string xrays(const RunData& data) {
  std::string html;
  for (const JsonPlace& xray : data.xrays().at("xrays").items()) html += xrayTable(xray);
  return html.empty() ? "" : "<section>" + html + "</section>\n";
}

/// "runs/one/" is "one".
std::string nameOf(const std::string& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

/// The replay of one run, or of two on one clock.
std::string replay(const std::vector<const RunData*>& runs) {
  std::string html = "<section id='replay'><noscript>The replay needs JavaScript.</noscript></section>\n";
  for (const RunData* data : runs)
    html += replayScript(replayData(*data, nameOf(data->folder), most_replay_characters / runs.size()));
  return html;
}

std::string withScript(const std::string& body) {
  return body + "<script>" + std::string(replayPage().script) + "</script>\n";
}

std::string page(const RunData& data, const std::string& contacts, const std::string& touched) {
  std::string html = warnings(data) + replay({&data}) + faultsTable(data.run());
  html += "<section class='columns'><div>" + metricsTable(data.run()) + "</div><div>" + facts(data.run()) +
          "</div></section>\n";
  html += "<section>" + contacts + "</section>\n";
  if (data.touched.rows() > 0) html += "<section>" + touched + "</section>\n";
  if (data.log.rows() > 0) html += "<section>" + drawTaskErrors(data) + "</section>\n";
  html += xrays(data);
  return htmlPage(data.run().at("stack").text(), withScript(html), std::string(replayPage().style));
}

std::string titleOf(const RunData& data) {
  return nameOf(data.folder) + ": " + data.run().at("stack").text() + " with " + data.run().at("backend").text() +
         ", seed " + number(data.run().at("seed"), 10);
}

std::string pageOfTwo(const RunData& one, const RunData& other) {
  std::string html = replay({&one, &other}) + "<section class='columns'>";
  for (const RunData* data : {&one, &other})
    html += "<div><h2>" + escaped(titleOf(*data)) + "</h2>" + warnings(*data) + metricsTable(data->run()) +
            facts(data->run()) + "</div>";
  html += "</section>\n";
  return htmlPage(nameOf(one.folder) + " beside " + nameOf(other.folder), withScript(html), std::string(replayPage().style));
}

struct ReportArguments {
  std::string folder;
  std::string beside;                                              ///< another run's folder
  std::string png;                                                 ///< folder, or a file that ends in .png
  std::string camera = "overview";
  std::optional<double> at;                                        ///< s
};

/// A file gets the scene, a folder all pictures.
void writePictures(const ReportArguments& arguments, const std::string& page) {
  constexpr double at_first = 0.6;                                 // of the run: most are busy then
  const RunData data = readRunFolder(arguments.folder);
  const double at = arguments.at.value_or(at_first * data.run().at("duration_s").number().value_or(0));
  const std::string scene =
      "#figure=scene&at=" + control::formatNumber(at) + "&camera=" + arguments.camera;
  const int width = arguments.beside.empty() ? 1200 : 1600;
  const auto take = [&](const std::string& address, const std::string& png, PictureSize size) {
    takeScreenshot(address, png, size);
    std::cerr << png << "\n";
  };
  if (arguments.png.ends_with(".png")) return take(fileAddress(page) + scene, arguments.png, {width, 800});
  std::error_code error;
  fs::create_directories(arguments.png, error);
  if (error) throw runtime::FileError(arguments.png, "cannot be made a folder: " + error.message());
  take(fileAddress(page) + scene, arguments.png + "/scene.png", {width, 800});
  take(fileAddress(page) + "#figure=plots&at=" + control::formatNumber(at), arguments.png + "/plots.png", {900, 1000});
  if (!arguments.beside.empty()) return;
  for (const std::string name : {"contacts", "touched_points"})
    take(fileAddress(arguments.folder + "/" + name + ".svg"), arguments.png + "/" + name + ".png", {1100, 560});
}

}  // namespace

void writeReport(const std::string& folder) {
  const RunData data = readRunFolder(folder);
  for (const std::string& warning : data.warnings) std::cerr << "warning: " << warning << "\n";
  const std::string contacts = drawContacts(data);
  const std::string touched = drawTouchedPoints(data);
  runtime::writeWhole(folder + "/contacts.svg", contacts);
  runtime::writeWhole(folder + "/touched_points.svg", touched);
  runtime::writeWhole(folder + "/report.html", page(data, contacts, touched));
}

std::string writeReportOfTwo(const std::string& folder, const std::string& other) {
  const std::string file = folder + "/beside-" + nameOf(other) + ".html";
  runtime::writeFile(file, pageOfTwo(readRunFolder(folder), readRunFolder(other)));
  return file;
}

void addReport(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("report", "Make the report of a run folder again");
  const auto arguments = std::make_shared<ReportArguments>();
  command->add_option("RUN", arguments->folder, "Folder of a run")->required()->type_name("");
  command->add_option("--beside", arguments->beside, "Another run's folder: both side by side, on one clock")
      ->type_name("RUN");
  command
      ->add_option("--png", arguments->png,
                   "Pictures for papers: a folder for all of them, or a file .png for the scene; needs Chromium")
      ->type_name("DIR|FILE");
  command->add_option("--at", arguments->at, "Time of the scene in --png, s; 0.6 of the run without it")
      ->type_name("SECONDS");
  command->add_option("--camera", arguments->camera, "Of the scene in --png: overview, front, side, top, hand")
      ->check(CLI::IsMember({"overview", "front", "side", "top", "hand"}))
      ->type_name("NAME");
  command->footer(R"(report.html replays the run: robot, objects, forces, touched points, what tasks steer for, and plots that
follow.  It is one file, which opens without a network.

Examples:
  tactus report runs/explore-table-null-space-seed1
  tactus report runs/soft --beside runs/hard
  tactus report runs/soft --png figures
  tactus report runs/soft --png scene.png --at 12.5 --camera hand)");
  command->callback([=, &context] {
    context.action = [=] {
      std::string file = arguments->folder + "/report.html";
      if (arguments->beside.empty()) writeReport(arguments->folder);
      else file = writeReportOfTwo(arguments->folder, arguments->beside);
      std::cerr << file << "\n";
      if (!arguments->png.empty()) writePictures(*arguments, file);
      return exit_done;
    };
  });
}

}  // namespace tactus::app
