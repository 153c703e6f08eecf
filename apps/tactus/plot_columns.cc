#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <iostream>
#include <memory>

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
/// Okabe and Ito's colours, which people who see few colours can tell apart.
constexpr std::array colours{"#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#222222"};

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

std::string picture(const runtime::CsvTable& table, const std::vector<std::string>& panels) {
  const std::vector<double> time = table.numbers(0);
  std::string svg;
  for (size_t i = 0; i < panels.size(); ++i) {
    LinePlot plot{panels[i], i + 1 == panels.size() ? table.columns().front() : "", "", {}, {}, "", false};
    for (const std::string& name : split(panels[i], ',')) {
      const std::string colour = colours[plot.lines.size() % colours.size()];
      plot.lines.push_back({"", colour, time, table.numbers(columnOf(table, name))});
    }
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
  std::vector<std::string> words{"rsvg-convert", "--zoom=2", "--output=" + file, source};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t process = -1;
  int status = 0;
  if (::posix_spawnp(&process, argv[0], nullptr, nullptr, argv.data(), environ) != 0)
    throw runtime::FileError(file, "a PNG needs the program rsvg-convert (Debian: librsvg2-bin); an .svg needs nothing");
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw runtime::FileError(file, "rsvg-convert could not write it");
}

int plotColumns(const PlotArguments& arguments) {
  const std::string log = fs::is_directory(arguments.run) ? arguments.run + "/log.csv" : arguments.run;
  const std::string kind = fs::path(arguments.out).extension();
  if (!arguments.out.empty() && kind != ".svg" && kind != ".png")
    throw UsageError("--out " + arguments.out + ": a plot is an .svg or a .png");
  const std::string svg = picture(runtime::CsvTable::read(log), arguments.columns);
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
  command->add_option("COLUMN", arguments->columns, "A panel each; columns separated by commas share one")
      ->required()
      ->type_name("COLUMN");
  command->add_option("--out", arguments->out, "File, .svg or .png; SVG on stdout without it")->type_name("FILE");
  command->footer(R"(Examples:
  tactus plot runs/first task/palm/error level/1/rank > first.svg
  tactus plot runs/harder contact/mean_N,contact/max_N controller/scale --out harder.png)");
  command->callback([=, &context] { context.action = [=] { return plotColumns(*arguments); }; });
}

}  // namespace tactus::app
