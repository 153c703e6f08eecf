#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>

#include "apps/tactus/command.h"
#include "apps/tactus/text.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/version.h"

namespace tactus::app {
namespace {

/// Text as troff prints it unchanged: no line of it is a request, no character an escape.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool first = out.empty() || out.back() == '\n';
    if (first && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::vector<std::string> paragraphs(const std::string& text) {
  std::vector<std::string> found;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find("\n\n", at), text.size());
    if (end > at) found.push_back(text.substr(at, end - at));
    at = end + 2;
  }
  return found;
}

/// The description as it goes on after "name - ".
std::string summaryOf(const CLI::App& command) {
  std::string text = command.get_description();
  if (const std::string own = "Tactus: "; text.starts_with(own)) return text.substr(own.size());
  // "Run" begins with a small letter then, "XML" stays.
  if (text.size() > 1 && std::islower(static_cast<unsigned char>(text[1])))
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

std::string spelling(const CLI::Option& option) {
  if (option.get_positional()) return "\\fI" + escaped(option.get_name(true)) + "\\fR";
  std::string names;
  for (const std::string& name : option.get_snames())
    names += (names.empty() ? "" : ", ") + ("\\fB\\-" + escaped(name)) + "\\fR";
  for (const std::string& name : option.get_lnames())
    names += (names.empty() ? "" : ", ") + ("\\fB\\-\\-" + escaped(name)) + "\\fR";
  const std::string type = option.get_items_expected_max() > 0 ? option.get_type_name() : "";
  return names + (type.empty() ? "" : " \\fI" + escaped(type) + "\\fR");
}

std::vector<const CLI::App*> commandsOf(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

class Page {
 public:
  Page(const CLI::App& command, const std::vector<std::string>& path) : command_(command), path_(path) {}

  static std::string name(const std::vector<std::string>& path) { return joined(path, "-"); }

  std::string text() const {
    std::string out = ".TH " + upper(name(path_)) + " 1 \"\" \"Tactus " TACTUS_VERSION "\" \"User Commands\"\n";
    out += ".SH NAME\n" + escaped(name(path_)) + " \\- " + escaped(summaryOf(command_)) + "\n";
    out += ".SH SYNOPSIS\n" + synopsis();
    out += options("ARGUMENTS", true) + commands() + options("OPTIONS", false) + footer() + seeAlso();
    return out;
  }

 private:
  std::string synopsis() const {
    std::string out = ".B " + escaped(joined(path_, " ")) + "\n";
    if (!commandsOf(command_).empty()) return out + ".I COMMAND\n";
    out += "[\\fIOPTIONS\\fR]";
    for (const CLI::Option* option : command_.get_options()) {
      if (!option->get_positional()) continue;
      const std::string word = spelling(*option) + (option->get_items_expected_max() > 1 ? "..." : "");
      out += " " + (option->get_required() ? word : "[" + word + "]");
    }
    return out + "\n";
  }

  std::string options(const char* heading, bool positional) const {
    std::string out;
    for (const CLI::Option* option : command_.get_options())
      if (option->get_positional() == positional)
        out += ".TP\n" + spelling(*option) + "\n" + escaped(option->get_description()) + "\n";
    return out.empty() ? "" : std::string(".SH ") + heading + "\n" + out;
  }

  std::string commands() const {
    std::string out;
    for (const CLI::App* inner : commandsOf(command_))
      out += ".TP\n\\fB" + escaped(inner->get_name()) + "\\fR\n" + escaped(inner->get_description()) + "\n";
    return out.empty() ? "" : ".SH COMMANDS\n" + out;
  }

  /// "Examples:" and "Exit codes:" begin sections of their own.
  std::string footer() const {
    std::string notes, sections;
    for (const std::string& paragraph : paragraphs(command_.get_footer())) {
      static const std::string examples = "Examples:\n", codes = "Exit codes: ";
      if (paragraph.starts_with(examples))
        sections += ".SH EXAMPLES\n.nf\n" + escaped(paragraph.substr(examples.size())) + "\n.fi\n";
      else if (paragraph.starts_with(codes))
        sections += ".SH \"EXIT STATUS\"\n" + escaped(paragraph.substr(codes.size())) + "\n";
      else
        notes += (notes.empty() ? ".SH NOTES\n" : ".PP\n") + escaped(paragraph) + "\n";
    }
    return notes + sections;
  }

  std::string seeAlso() const {
    std::vector<std::string> pages;
    if (path_.size() > 1) pages.push_back(page({path_.begin(), path_.end() - 1}));
    for (const CLI::App* inner : commandsOf(command_)) {
      std::vector<std::string> further = path_;
      further.push_back(inner->get_name());
      pages.push_back(page(further));
    }
    return pages.empty() ? "" : ".SH \"SEE ALSO\"\n" + joined(pages, ",\n") + "\n";
  }

  static std::string page(const std::vector<std::string>& path) { return "\\fB" + escaped(name(path)) + "\\fR(1)"; }
  static std::string upper(std::string text) {
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
  }

  const CLI::App& command_;
  std::vector<std::string> path_;
};

void writePages(const CLI::App& command, std::vector<std::string> path, const std::string& folder) {
  path.push_back(command.get_name());
  runtime::writeFile(folder + "/" + Page::name(path) + ".1", Page(command, path).text());
  for (const CLI::App* inner : commandsOf(command)) writePages(*inner, path, folder);
}

int man(const CLI::App& program, const std::vector<std::string>& words, const std::string& folder) {
  if (!folder.empty()) {
    if (!words.empty()) throw UsageError("--out writes the pages of all commands: name none");
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw runtime::FileError(folder, "cannot be created", error.value());
    writePages(program, {}, folder);
    return exit_done;
  }
  const CLI::App* command = &program;
  std::vector<std::string> path{program.get_name()};
  for (const std::string& word : words) {
    const auto inside = commandsOf(*command);
    const auto found = std::find_if(inside.begin(), inside.end(),
                                    [&](const CLI::App* inner) { return inner->get_name() == word; });
    if (found == inside.end()) throw UsageError("there is no command '" + joined(words, " ") + "'");
    command = *found;
    path.push_back(word);
  }
  std::cout << Page(*command, path).text();
  return exit_done;
}

}  // namespace

void addMan(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("man", "A command's manual page, from what its help says");
  const auto words = std::make_shared<std::vector<std::string>>();
  const auto folder = std::make_shared<std::string>();
  command->add_option("COMMAND", *words, "Words of a command, such as golden record; none: the program itself")
      ->type_name("");
  command->add_option("--out", *folder, "Write the pages of all commands into this folder instead")->type_name("DIR");
  command->footer(R"(The page is troff: `tactus man run | man -l -` shows it.  An installed Tactus has the pages of all
commands: `man tactus-run`.

Examples:
  tactus man run | man -l -
  tactus man --out ~/.local/share/man/man1)");
  command->callback(
      [=, &program, &context] { context.action = [=, &program] { return man(program, *words, *folder); }; });
}

}  // namespace tactus::app
