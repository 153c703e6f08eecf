#include <algorithm>
#include <iostream>
#include <map>

#include "apps/tactus/command.h"
#include "apps/tactus/program.h"
#include "apps/tactus/text.h"

namespace tactus::app {
namespace {

using Words = std::vector<std::string>;

enum class Files { none, folders, all };

/// What may stand in one place.
struct Values {
  Words words;
  Files files = Files::none;
};

struct OptionWords {
  Words names;                                                     ///< "--json", "-h"
  std::string description;
  bool takes_value = false;
  Values values;
};

struct CommandWords {
  Words path;                                                      ///< {"golden", "record"}; {} = the program itself
  std::vector<std::pair<std::string, std::string>> commands;       ///< names of those inside, and what they do
  std::vector<OptionWords> options;
  Values values;                                                   ///< of what is no option
};

/// Words that only the loaded plugins know.
struct Dynamic {
  Words elements;
  Words back_ends;
};

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

Dynamic dynamicWords() {
  Program program;
  program.loadFolders();                                           // `tactus plugins list` tells what is refused
  Dynamic words;
  words.back_ends = program.registry().names(control::ElementKind::back_end);
  for (const control::ElementRow& row : program.registry().elements().rows()) words.elements.push_back(row.name);
  std::sort(words.elements.begin(), words.elements.end());
  words.elements.erase(std::unique(words.elements.begin(), words.elements.end()), words.elements.end());
  return words;
}

/// What the name that help shows for a value says of it: "xsd|json|md", BACKEND, DIR, "NAME|FILE".
Values valuesOf(const std::string& shown, const Dynamic& dynamic) {
  if (shown == "BACKEND") return {dynamic.back_ends, Files::none};
  if (shown == "DIR") return {{}, Files::folders};
  Values values;
  for (const std::string& word : split(shown, '|')) {
    static const Words files{"FILE", "PATH", "STACK", "RUN", "CASE", "TICK", "MODEL"};
    if (std::find(files.begin(), files.end(), word) != files.end()) values.files = Files::all;
    if (word == "TYPE") values.words = dynamic.elements;
    // Small letters alone are to be written as they are.
    const bool small = std::all_of(word.begin(), word.end(), [](char c) { return c >= 'a' && c <= 'z'; });
    if (small && !word.empty()) values.words.push_back(word);
  }
  return values;
}

OptionWords wordsOf(const CLI::Option& option, const Dynamic& dynamic) {
  OptionWords words{{}, firstLine(option.get_description()), option.get_items_expected_max() > 0, {}};
  for (const std::string& name : option.get_lnames()) words.names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) words.names.push_back("-" + name);
  if (words.takes_value) words.values = valuesOf(option.get_type_name(), dynamic);
  return words;
}

/// The tree of commands as a list, a command before those inside it.
void gather(const CLI::App& command, const Words& path, const Dynamic& dynamic, std::vector<CommandWords>& into) {
  CommandWords words{path, {}, {}, {}};
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) {
      words.options.push_back(wordsOf(*option, dynamic));
    } else {
      const std::string type = option->get_type_name();
      words.values = valuesOf(type.empty() ? option->get_name(true) : type, dynamic);
    }
  }
  const auto inner = command.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* one : inner) words.commands.emplace_back(one->get_name(), firstLine(one->get_description()));
  into.push_back(std::move(words));
  for (const CLI::App* one : inner) {
    Words inside = path;
    inside.push_back(one->get_name());
    gather(*one, inside, dynamic, into);
  }
}

Words optionNames(const CommandWords& command) {
  Words names;
  for (const OptionWords& option : command.options) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

Words commandNames(const CommandWords& command) {
  Words names;
  for (const auto& [name, description] : command.commands) names.push_back(name);
  return names;
}

/// In single quotes, for bash and zsh.
std::string inQuotes(const std::string& text) {
  std::string out = "'";
  for (char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

// --- bash -----------------------------------------------------------------------------------------------------------

std::string bashValues(const Values& values) {
  static const std::map<Files, const char*> kinds{{Files::none, ""}, {Files::folders, "-d"}, {Files::all, "-f"}};
  return "values=" + inQuotes(joined(values.words, " ")) + " files=" + inQuotes(kinds.at(values.files)) + " ;;\n";
}

std::string bashCommands(const std::vector<CommandWords>& commands) {
  std::string out;
  for (const CommandWords& command : commands)
    out += "    " + inQuotes(joined(command.path, " ")) + ")\n      commands=" +
           inQuotes(joined(commandNames(command), " ")) + "\n      options=" +
           inQuotes(joined(optionNames(command), " ")) + "\n      " + bashValues(command.values);
  return out;
}

/// A pattern of `case` for each option that takes a value.
std::string bashOptions(const std::vector<CommandWords>& commands) {
  std::string out;
  for (const CommandWords& command : commands)
    for (const OptionWords& option : command.options) {
      if (!option.takes_value) continue;
      Words patterns;
      for (const std::string& name : option.names) patterns.push_back(inQuotes(joined(command.path, " ") + ":" + name));
      out += "    " + joined(patterns, " | ") + ") " + bashValues(option.values);
    }
  return out;
}

/// Words before the cursor lead down the tree; what stands after an option that takes a value is its value.  Readline
/// parts words at '=', so `--backend=n` comes as three.
std::string bashScript(const std::vector<CommandWords>& commands) {
  return R"(# Completion of tactus for bash, made by 'tactus completion bash'.

# What the command $1 takes: sub-commands, options, and what is neither.
_tactus_command() {
  case "$1" in
)" + bashCommands(commands) + R"(  esac
}

# What the option $2 of the command $1 takes; fails where it takes no value.
_tactus_option() {
  case "$1:$2" in
)" + bashOptions(commands) + R"(    *) return 1 ;;
  esac
}

_tactus() {
  local current=${COMP_WORDS[COMP_CWORD]} at='' option='' word i
  local commands='' options='' values='' files=''
  _tactus_command ''
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if [[ $word == '=' ]]; then
      continue
    elif [[ -n $option ]]; then
      option=''
    elif _tactus_option "$at" "$word"; then
      option=$word
    elif [[ " $commands " == *" $word "* ]]; then
      at=${at:+$at }$word
    fi
    _tactus_command "$at"
  done
  if [[ $current == '=' ]]; then current=''; fi
  COMPREPLY=()
  if [[ -n $option ]]; then
    _tactus_option "$at" "$option"
  elif [[ $current == -* ]]; then
    values=$options files=''
  elif [[ -n $commands ]]; then
    values=$commands files=''
  fi
  mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
  if [[ -n $files && ${#COMPREPLY[@]} == 0 ]]; then
    mapfile -t COMPREPLY < <(compgen "$files" -- "$current")
    compopt -o filenames 2> /dev/null
  fi
}
complete -F _tactus tactus
)";
}

// --- zsh ------------------------------------------------------------------------------------------------------------

/// As an entry of _describe or _arguments: colons and brackets part the fields there.
std::string zshText(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zshAction(const Values& values) {
  if (values.files == Files::folders) return "_files -/";
  if (values.words.empty()) return values.files == Files::all ? "_files" : " ";
  if (values.files == Files::none) return "(" + joined(values.words, " ") + ")";
  return "{compadd -- " + joined(values.words, " ") + "; _files}";
}

/// Each command is a function; one with sub-commands calls theirs with the words from the sub-command on.
std::string zshFunction(const CommandWords& command) {
  Words name = command.path;
  name.insert(name.begin(), "_tactus");
  const std::string function = joined(name, "_");
  std::string out = function + "() {\n";
  if (!command.commands.empty()) {
    out += "  local curcontext=\"$curcontext\" state line\n  typeset -A opt_args\n  local -a commands=(\n";
    for (const auto& [inner, description] : command.commands)
      out += "    " + inQuotes(zshText(inner) + ":" + zshText(description)) + "\n";
    out += "  )\n";
  }
  out += "  _arguments -C -S";
  for (const OptionWords& option : command.options)
    for (const std::string& spelling : option.names) {
      std::string entry = "*" + spelling + (option.takes_value && spelling.starts_with("--") ? "=" : "") + "[" +
                          zshText(option.description) + "]";
      if (option.takes_value) entry += ":value:" + zshAction(option.values);
      out += " \\\n    " + inQuotes(entry);
    }
  if (command.commands.empty())
    return out + " \\\n    " + inQuotes("*:argument:" + zshAction(command.values)) + "\n}\n\n";
  out += " \\\n    '1:command:{_describe command commands}' '*::argument:->inner'\n"
         "  [[ $state == inner ]] || return\n  case $words[1] in\n";
  for (const auto& [inner, description] : command.commands)
    out += "    " + inner + ") " + function + "_" + inner + " ;;\n";
  return out + "  esac\n}\n\n";
}

/// As a file of $fpath the script is the function itself; read by `source` it says whose completion that is.
std::string zshScript(const std::vector<CommandWords>& commands) {
  std::string out = "#compdef tactus\n# Completion of tactus for zsh, made by 'tactus completion zsh'.\n\n";
  for (const CommandWords& command : commands) out += zshFunction(command);
  return out + "if [[ $funcstack[1] == _tactus ]]; then\n  _tactus \"$@\"\nelse\n  compdef _tactus tactus\nfi\n";
}

// --- fish -----------------------------------------------------------------------------------------------------------

std::string fishQuoted(const std::string& text) {
  std::string out = "'";
  for (char c : text) out += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
  return out + "'";
}

std::string fishValues(const Values& values) {
  if (values.files == Files::folders) return " -x -a '(__fish_complete_directories)'";
  std::string out = values.files == Files::none ? " -x" : " -r -F";
  return values.words.empty() ? out : out + " -a " + fishQuoted(joined(values.words, " "));
}

std::string fishScript(const std::vector<CommandWords>& commands) {
  std::string out = R"(# Completion of tactus for fish, made by 'tactus completion fish'.

# Do the words before the cursor lead to the command $argv[2..-1]?  With 'to', and no further; with 'in', or further.
function __tactus_leads
    set -l way
    for word in (commandline -opc)[2..-1]
        string match -q -- '-*' $word; or set -a way $word
    end
    test "$way" = "$argv[2..-1]"; and return
    test $argv[1] = in; and string match -q -- "$argv[2..-1] *" "$way"
end

)";
  for (const CommandWords& command : commands) {
    const std::string kind = command.commands.empty() ? "in" : "to";
    const std::string way = "__tactus_leads " + kind + (command.path.empty() ? "" : " ") + joined(command.path, " ");
    const std::string start = "complete -c tactus -n " + fishQuoted(way);
    for (const auto& [inner, description] : command.commands)
      out += start + " -a " + inner + " -d " + fishQuoted(description) + "\n";
    if (command.values.files == Files::none) out += start + " -f\n";
    if (!command.values.words.empty()) out += start + " -a " + fishQuoted(joined(command.values.words, " ")) + "\n";
    for (const OptionWords& option : command.options) {
      out += start;
      for (const std::string& name : option.names)
        out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (option.takes_value) out += fishValues(option.values);
      out += " -d " + fishQuoted(option.description) + "\n";
    }
  }
  return out;
}

using Script = std::string (*)(const std::vector<CommandWords>&);

const std::map<std::string, Script>& shells() {
  static const std::map<std::string, Script> scripts{{"bash", bashScript}, {"zsh", zshScript}, {"fish", fishScript}};
  return scripts;
}

int complete(const CLI::App& program, const std::string& shell) {
  const auto script = shells().find(shell);
  if (script == shells().end()) throw UsageError("completion is for 'bash', 'zsh' or 'fish', not for '" + shell + "'");
  std::vector<CommandWords> commands;
  gather(program, {}, dynamicWords(), commands);
  std::cout << script->second(commands);
  return exit_done;
}

}  // namespace

void addCompletion(CLI::App& program, Context& context) {
  CLI::App* command =
      program.add_subcommand("completion", "A script that lets the shell complete commands and options");
  const auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")->required()->type_name("bash|zsh|fish");
  command->footer(R"(Elements and back ends are those that are there when the script is made, those of plugins in
TACTUS_PLUGIN_PATH among them.

Examples:
  tactus completion bash > ~/.local/share/bash-completion/completions/tactus
  tactus completion zsh > ~/.zfunc/_tactus     # with fpath+=~/.zfunc before compinit in ~/.zshrc
  tactus completion fish > ~/.config/fish/completions/tactus.fish

For one session of bash: source <(tactus completion bash))");
  command->callback([=, &program, &context] { context.action = [=, &program] { return complete(program, *shell); }; });
}

}  // namespace tactus::app
