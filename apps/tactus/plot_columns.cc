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
#include "apps/tactus/run_folder.h"
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
      plot.lines.push_back({"", colour, axis, table.numbers(columnOf(table, name))});
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
  writeWhole(file, runtime::readFile(drawn));
}

int plotColumns(const PlotArguments& arguments) {
  const std::string log = fs::is_directory(arguments.run) ? arguments.run + "/log.csv" : arguments.run;
  const std::string kind = fs::path(arguments.out).extension();
  if (!arguments.out.empty() && kind != ".svg" && kind != ".png")
    throw UsageError("--out " + arguments.out + ": a plot is an .svg or a .png");
  const runtime::CsvTable table = runtime::CsvTable::read(log);
  if (table.endsWithinLine())
    std::cerr << "tactus plot: warning: " << log << " ends within a line, which is left out\n";
  if (arguments.columns.empty()) {
    if (!arguments.out.empty())
      throw UsageError("--out " + arguments.out + ": which columns?  Without any, their names are listed");
    for (const std::string& name : table.columns()) std::cout << name << "\n";
    return exit_done;
  }
  const std::string svg = picture(table, arguments.columns);
  if (arguments.out.empty()) std::cout << svg;
  else if (kind == ".png") writePng(arguments.out, svg);
  else writeWhole(arguments.out, svg);
  return exit_done;
}

}  // namespace

void addPlot(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("plot", "Columns of a run's log over time, as SVG or PNG");
  const auto arguments = std::make_shared<PlotArguments>();
  command->add_option("RUN", arguments->run, "A run folder, or a CSV file whose first column is the axis")
      ->required()
      ->type_name("RUN");
  command
      ->add_option("COLUMN", arguments->columns, "A panel each; columns between commas share one; without any: names")
      ->type_name("COLUMN");
  command->add_option("--out", arguments->out, "File, .svg or .png; SVG on stdout without it")->type_name("FILE");
  command->footer(R"(Examples:
  tactus plot runs/first
  tactus plot runs/first task/palm/error level/1/rank > first.svg
  tactus plot runs/harder contact/mean_N,contact/max_N controller/scale --out harder.png)");
  command->callback([=, &context] { context.action = [=] { return plotColumns(*arguments); }; });
}

}  // namespace tactus::app
