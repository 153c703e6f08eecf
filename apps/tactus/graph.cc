#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/tactus/command.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/text.h"
#include "dsl/compile.h"
#include "dsl/stack_graph.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

struct GraphArguments : StackArguments {
  std::string format;                                              ///< "" = by the file's name, svg without one
  std::string out;
};

int graph(const GraphArguments& arguments, bool json) {
  const size_t dot = arguments.out.rfind('.');
  const std::string by_name = dot == std::string::npos ? "svg" : arguments.out.substr(dot + 1);
  const std::string form = json ? "json" : arguments.format.empty() ? by_name : arguments.format;
  if (form != "svg" && form != "dot" && form != "json")
    throw UsageError("a graph is 'svg', 'dot' or 'json', not '" + form + "'");
  Program program(arguments.plugins);
  const dsl::Stack stack = readAloud(program, arguments.stack);
  dsl::compile(stack, program.registry());                         // tells circles, which a drawing would hide
  const dsl::StackGraph drawn = dsl::graphOf(stack);
  const std::string text = form == "svg"   ? dsl::graphToSvg(drawn)
                           : form == "dot" ? dsl::graphToDot(drawn)
                                           : jsonText(dsl::graphToJson(drawn), 2) + "\n";
  if (arguments.out.empty()) {
    std::cout << text;
  } else {
    runtime::writeFile(arguments.out, text);
    std::cerr << arguments.out << "\n";
  }
  return exit_done;
}

}  // namespace

void addGraph(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("graph", "Draw which task and signal reads which port");
  const auto arguments = std::make_shared<GraphArguments>();
  command->add_option("STACK", arguments->stack.file, "The stack's XML file")->required()->type_name("");
  command->add_option("--format", arguments->format, "svg, dot (for Graphviz) or json; not given: by the name of --out, or svg")
      ->type_name("svg|dot|json");
  command->add_option("--out", arguments->out, "Write it to this file instead of printing")->type_name("FILE");
  command->add_option("--set", arguments->stack.set, "Give a <parameter> of the stack another value")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  declarePlugins(*command, arguments->plugins);
  command->add_flag("--json", context.json, "The same as --format json: {stack, nodes, edges}");
  command->footer(R"(Signals stand on the left, tasks in their levels on the right.  Dashed lines are read by default; a signal
with an orange frame is not used.

Examples:
  tactus graph examples/explore_table/stack.xml --out graph.svg
  tactus graph stack.xml --format dot | dot -Tpdf > graph.pdf
  tactus graph stack.xml --json)");
  command->callback([=, &context] { context.action = [=, &context] { return graph(*arguments, context.json); }; });
}

}  // namespace tactus::app
