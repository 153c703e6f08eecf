#include <filesystem>
#include <iostream>

#include "apps/tactus/command.h"
#include "apps/tactus/errors.h"
#include "apps/tactus/program.h"
#include "apps/tactus/stack_arguments.h"
#include "dsl/schema.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

struct SchemaArguments {
  std::string form;
  std::string out;
  std::vector<std::string> plugins;
};

int schema(const SchemaArguments& arguments) {
  Program program(arguments.plugins);
  for (const std::string& refusal : program.loadFolders()) std::cerr << "refused: " << refusal << "\n";
  const control::ElementTable& table = program.registry().elements();
  std::map<std::string, std::string> files;
  if (arguments.form == "xsd") {
    files["stack.xsd"] = dsl::schemaXsd(table);
  } else if (arguments.form == "json") {
    files["stack.json"] = dsl::schemaJson(table);
  } else if (arguments.form == "md") {
    files = dsl::referencePages(table);
  } else {
    throw UsageError("a schema is 'xsd', 'json' or 'md', not '" + arguments.form + "'");
  }
  if (!arguments.out.empty()) {
    std::error_code error;
    std::filesystem::create_directories(arguments.out, error);
    if (error) throw runtime::FileError(arguments.out, "create", error.value());
  }
  for (const auto& [name, text] : files) {
    if (arguments.out.empty()) {
      std::cout << text;
      continue;
    }
    const std::string path = arguments.out + "/" + name;
    runtime::writeFile(path, text);
    std::cerr << path << "\n";
  }
  return exit_done;
}

}  // namespace

void addSchema(CLI::App& program, Context& context) {
  CLI::App* command =
      program.add_subcommand("schema", "Everything that may stand in a stack: for editors, programs and readers");
  const auto arguments = std::make_shared<SchemaArguments>();
  command->add_option("FORM", arguments->form, "xsd (XML Schema), json, or md (the reference manual)")
      ->required()
      ->type_name("xsd|json|md");
  command->add_option("--out", arguments->out, "Write files into this folder instead of printing")->type_name("DIR");
  declarePlugins(*command, arguments->plugins);
  command->footer(R"(The elements of plugins belong to it: those of --plugin and of the plugin folders.

Examples:
  tactus schema xsd > stack.xsd
  tactus schema md --out docs/reference
  tactus schema json --plugin build/acme.so)");
  command->callback([=, &context] { context.action = [=] { return schema(*arguments); }; });
}

}  // namespace tactus::app
