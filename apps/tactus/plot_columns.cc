#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <iostream>
#include <memory>
#include <set>
#include <tuple>

#include "apps/tactus/command.h"
#include "apps/tactus/plot.h"
#include "apps/tactus/study_folder.h"
#include "apps/tactus/text.h"
#include "dsl/nearest_name.h"
#include "framework/runtime/csv_table.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/temporary_folder.h"

namespace tactus::app {
namespace {

namespace fs = std::filesystem;

constexpr double width = 1100, panel_height = 260;
/// Okabe and Ito's colours, which people who see few colours can tell apart; beyond these, others.
constexpr std::array colours{"#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#222222",
                             "#8a7a00", "#5b5bd6", "#7a7a74", "#8b4fb0", "#a0632b"};

struct PlotArguments {
  std::string run;
  std::vector<std::string> columns;                                ///< names separated by commas share a panel
  std::string out;
};

int columnOf(const runtime::CsvTable& table, const std::string& name) {
  const int column = table.column(name);
  if (column >= 0) return column;
  const std::string near = dsl::nearestName(name, table.columns());
  throw UsageError(table.path() + " has no column '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?") +
                   "\nits columns: " + joined(table.columns()));
}

/// What the column's name tells of its unit; "" where it does not.
std::string unitOf(const std::string& column) {
  const std::string last = column.substr(column.rfind('/') + 1);
  const auto isOne = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), last) != names.end();
  };
  if (column == "time") return "s";
  if (last.ends_with("_N")) return "N";
  if (last.ends_with("_m")) return "m";
  if (last.ends_with("_us")) return "µs";
  if (column.starts_with("q/")) return "rad";
  if (column.starts_with("qd/")) return "rad/s";
  if (column.starts_with("tau/") || column == "controller/torque_norm") return "N m";
  const bool place = column.starts_with("object/") || column.starts_with("link/") || column.starts_with("mark/");
  return place && isOne({"x", "y", "z"}) ? "m" : "";
}

std::string withUnit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " (" + unit + ")";
}

/// 0 belongs to the axis where the values come near it.
bool startsAtZero(const std::vector<Line>& lines) {
  double least = INFINITY, largest = -INFINITY;
  for (const Line& line : lines)
    for (const double value : line.y)
      if (std::isfinite(value)) std::tie(least, largest) = std::pair(std::min(least, value), std::max(largest, value));
  return least >= 0 && least < 0.3 * largest;
}

/// A condition's mean over its trials, row by row, in a band of a standard deviation (n − 1) to both sides; of what does not
/// reach as far in all trials, as far as the shortest goes.
Line meanOf(const std::vector<runtime::CsvTable>& logs, const std::string& name) {
  constexpr size_t points = 500;
  size_t rows = logs.front().rows();
  for (const runtime::CsvTable& log : logs) rows = std::min(rows, static_cast<size_t>(log.rows()));
  std::vector<std::vector<double>> values;
  for (const runtime::CsvTable& log : logs) values.push_back(log.numbers(columnOf(log, name)));
  const std::vector<double> axis = logs.front().numbers(0);
  Line line;
  const auto n = static_cast<double>(logs.size());
  for (size_t row = 0; row < rows; row += std::max<size_t>(1, rows / points)) {
    double mean = 0, squares = 0;
    for (const std::vector<double>& trial : values) mean += trial[row] / n;
    for (const std::vector<double>& trial : values) squares += (trial[row] - mean) * (trial[row] - mean);
    line.x.push_back(axis[row]);
    line.y.push_back(mean);
    if (logs.size() < 2) continue;
    const double deviation = std::sqrt(squares / (n - 1));
    line.lower.push_back(mean - deviation);
    line.upper.push_back(mean + deviation);
  }
  return line;
}

/// A panel a column, a line a condition of the study.
std::string pictureOfStudy(const StudyFolder& study, const std::vector<std::string>& columns) {
  const StudyPlan& plan = study.plan();
  std::vector<std::pair<std::string, std::vector<runtime::CsvTable>>> conditions;
  for (long number = 1; number <= plan.trials(); ++number) {
    const auto record = study.record(number);
    if (!record || record->failed()) continue;
    const std::string log = study.trialFolder(number) + "/log.csv";
    if (!fs::exists(log))
      throw runtime::FileError(log, "the study keeps figures alone, no logs: run it with keep=\"runs\"");
    const std::string label = plan.label(record->trial.levels);
    if (conditions.empty() || conditions.back().first != label) conditions.push_back({label, {}});
    conditions.back().second.push_back(runtime::CsvTable::read(log));
  }
  if (conditions.empty()) throw runtime::FileError(study.path(), "no trial of the study has finished");
  std::string svg;
  for (size_t i = 0; i < columns.size(); ++i) {
    const std::string& name = columns[i];
    const bool lowest = i + 1 == columns.size();
    LinePlot plot{name, lowest ? withUnit("time", "s") : "", unitOf(name), {}, {}, "", false};
    for (const auto& [label, logs] : conditions) {
      plot.lines.push_back(meanOf(logs, name));
      plot.lines.back().label = label + ", n = " + std::to_string(logs.size());
      plot.lines.back().colour = colours[(plot.lines.size() - 1) % colours.size()];
    }
    plot.from_zero = startsAtZero(plot.lines);
    svg += draw(plot, {0, panel_height * static_cast<double>(i), width, panel_height});
  }
  return svgDocument(width, panel_height * static_cast<double>(columns.size()), svg);
}

std::string picture(const runtime::CsvTable& table, const std::vector<std::string>& panels) {
  if (table.rows() == 0) return svgDocument(width, 60, note(table.path() + " has no rows.", {0, 0, width, 60}));
  const std::vector<double> axis = table.numbers(0);
  const std::string& axis_name = table.columns().front();
  std::string svg;
  for (size_t i = 0; i < panels.size(); ++i) {
    const bool lowest = i + 1 == panels.size();
    LinePlot plot{panels[i], lowest ? withUnit(axis_name, unitOf(axis_name)) : "", "", {}, {}, "", false};
    std::set<std::string> units;
    for (const std::string& name : split(panels[i], ',')) {
      const std::string colour = colours[plot.lines.size() % colours.size()];
      plot.lines.push_back({"", colour, axis, table.numbers(columnOf(table, name)), {}, {}});
      units.insert(unitOf(name));
    }
    if (units.size() == 1) plot.y_label = *units.begin();
    plot.from_zero = startsAtZero(plot.lines);
    // Keys where there is something to tell apart; else the title says it.
    if (plot.lines.size() > 1) {
      plot.title.clear();
      for (size_t line = 0; line < plot.lines.size(); ++line) plot.lines[line].label = split(panels[i], ',')[line];
    }
    svg += draw(plot, {0, panel_height * static_cast<double>(i), width, panel_height});
  }
  return svgDocument(width, panel_height * static_cast<double>(panels.size()), svg);
}

/// By rsvg-convert, which draws what browsers do; at twice the size, for print.
void writePng(const std::string& file, const std::string& svg) {
  const runtime::TemporaryFolder folder;
  const std::string source = folder.path + "/plot.svg";
  runtime::writeFile(source, svg);
  const std::string drawn = folder.path + "/plot.png";
  std::vector<std::string> words{"rsvg-convert", "--zoom=2", "--output=" + drawn, source};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t process = -1;
  int status = 0;
  if (::posix_spawnp(&process, argv[0], nullptr, nullptr, argv.data(), environ) != 0)
    throw runtime::FileError(file, "a PNG needs the program rsvg-convert (Debian: librsvg2-bin); an .svg needs nothing");
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw runtime::FileError(file, "rsvg-convert could not draw it");
  runtime::writeWhole(file, runtime::readFile(drawn));
}

int plotColumns(const PlotArguments& arguments) {
  const std::string log = fs::is_directory(arguments.run) ? arguments.run + "/log.csv" : arguments.run;
  const bool of_study = fs::exists(arguments.run + "/study.json");
  const std::string kind = fs::path(arguments.out).extension();
  if (!arguments.out.empty() && kind != ".svg" && kind != ".png")
    throw UsageError("--out " + arguments.out + ": a plot is an .svg or a .png");
  const auto write = [&](const std::string& svg) {
    if (arguments.out.empty()) std::cout << svg;
    else if (kind == ".png") writePng(arguments.out, svg);
    else runtime::writeWhole(arguments.out, svg);
    return exit_done;
  };
  if (of_study) {
    if (arguments.columns.empty()) throw UsageError("which columns of the study's trials?  tactus plot TRIAL lists them");
    return write(pictureOfStudy(StudyFolder(arguments.run), arguments.columns));
  }
  const runtime::CsvTable table = runtime::CsvTable::read(log);
  if (table.endsWithinLine())
    std::cerr << "tactus plot: warning: " << log << " ends within a line, which is left out\n";
  if (arguments.columns.empty()) {
    if (!arguments.out.empty())
      throw UsageError("--out " + arguments.out + ": which columns?  Without any, their names are listed");
    for (const std::string& name : table.columns()) std::cout << name << "\n";
    return exit_done;
  }
  return write(picture(table, arguments.columns));
}

}  // namespace

void addPlot(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("plot", "Columns of a run's log over time, or of a study's trials on average, as SVG or PNG");
  const auto arguments = std::make_shared<PlotArguments>();
  command->add_option("RUN", arguments->run, "A run folder, a study folder that keeps its runs, or a CSV file whose first column is the axis")
      ->required()
      ->type_name("RUN");
  command
      ->add_option("COLUMN", arguments->columns, "A panel each; columns between commas share one; without any: names")
      ->type_name("COLUMN");
  command->add_option("--out", arguments->out, "File, .svg or .png; SVG on stdout without it")->type_name("FILE");
  command->footer(R"(Examples:
  tactus plot runs/first
  tactus plot runs/first task/palm/error level/1/rank > first.svg
  tactus plot studies/explore_spheres-study measure/surface/covered --out coverage.svg
  tactus plot runs/harder contact/mean_N,contact/max_N controller/scale --out harder.png)");
  command->callback([=, &context] { context.action = [=] { return plotColumns(*arguments); }; });
}

}  // namespace tactus::app
