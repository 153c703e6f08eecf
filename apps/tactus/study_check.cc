#include "apps/tactus/study_check.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/tactus/command.h"
#include "apps/tactus/inputs.h"
#include "apps/tactus/session.h"
#include "apps/tactus/text.h"
#include "dsl/codes.h"
#include "dsl/nearest_name.h"
#include "dsl/source_text.h"
#include "framework/control/element_values.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

namespace fs = std::filesystem;

dsl::Diagnostic findingAt(const dsl::Study& study, const dsl::Code& code, const description::Place& place,
                          const std::string& name, const std::string& message, const std::string& suggestion) {
  dsl::Diagnostic finding;
  finding.code = code.id;
  finding.message = message;
  finding.suggestion = suggestion;
  finding.place = place;
  finding.length = static_cast<int>(dsl::countCharacters(name));
  if (const auto file = study.files.find(place.file); file != study.files.end())
    finding.source_line = dsl::SourceText(file->first, file->second).lineAt(place.line);
  return finding;
}

std::vector<std::string> parametersOf(const dsl::Stack& stack) {
  std::vector<std::string> names;
  for (const dsl::ResolvedElement& element : stack.elements)
    if (element.values.row().name == "parameter") names.push_back(element.values.text("name"));
  return names;
}

void checkNames(Program& program, const dsl::Study& study, const dsl::Stack& stack) {
  std::vector<dsl::Diagnostic> errors;
  const std::vector<std::string> parameters = parametersOf(stack);
  for (const dsl::StudyFactor& factor : study.factors)
    if (std::find(parameters.begin(), parameters.end(), factor.parameter) == parameters.end())
      errors.push_back(findingAt(study, dsl::code::unknown_parameter, factor.place, factor.parameter,
                                 "the stack '" + study.stack + "' has no parameter '" + factor.parameter + "'",
                                 dsl::nearestName(factor.parameter, parameters)));
  for (const dsl::PlacedName& back_end : study.back_ends) {
    try {
      program.backEndChoice(back_end.name);
    } catch (const UsageError& error) {
      const std::vector<std::string> known = program.registry().names(control::ElementKind::back_end);
      errors.push_back(findingAt(study, dsl::code::unknown_back_end, back_end.place, back_end.name, error.what(),
                                 dsl::nearestName(back_end.name, known)));
    }
  }
  if (!errors.empty()) throw dsl::InvalidStack(errors);
}

/// The path as seen from the study's folder, which may move with all that belongs to it.
std::string fromFolderOf(const dsl::Study& study, const std::string& file) {
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(fs::absolute(study.file).parent_path(), error);
  const fs::path path = fs::weakly_canonical(fs::absolute(file), error);
  return path.lexically_relative(folder).string();
}

/// Everything that decides a trial: study, stack with its includes and shapes, robot, plugins, and the program.
std::map<std::string, std::string> inputsOf(const Program& program, const dsl::Study& study, const dsl::Stack& stack) {
  std::map<std::string, std::string> inputs;
  for (const auto* files : {&study.files, &stack.files})
    for (const auto& [file, content] : *files) inputs[fromFolderOf(study, file)] = hashOf(content);
  for (const std::string& file : filesOfShapes(stack))
    inputs[fromFolderOf(study, file)] = hashOf(runtime::readFile(file));
  for (const runtime::LoadedPlugin& plugin : program.plugins().loaded())
    inputs["plugin '" + plugin.name + "'"] = hashOf(runtime::readFile(plugin.path));
  inputs["the program tactus"] = hashOfProgram();
  return inputs;
}

StackOptions optionsOf(const dsl::Study& study, const StudyPlan& plan, const std::vector<size_t>& levels) {
  StackOptions options;
  options.file = study.stack;
  for (size_t i = 0; i < study.factors.size(); ++i)
    options.set.push_back(study.factors[i].parameter + "=" + plan.level(levels, i));
  if (!study.back_ends.empty()) options.back_end = plan.level(levels, study.factors.size());
  options.duration = study.duration;
  return options;
}

}  // namespace

StudyPlan planOf(Program& program, const dsl::Study& study, std::vector<dsl::Diagnostic>& warnings) {
  StudyPlan plan;
  plan.name = study.name;
  plan.keeps_runs = study.keeps_runs;
  plan.first_seed = study.first_seed;
  plan.seeds = study.seeds;
  plan.comparisons = study.comparisons;
  for (const dsl::PlacedName& metric : study.metrics) plan.metrics.push_back(metric.name);
  for (const dsl::StudyFactor& factor : study.factors) plan.factors.push_back({factor.parameter, factor.values});

  const dsl::Stack stack = program.read({study.stack, {}, "", {}, {}}, &warnings);
  checkNames(program, study, stack);
  plan.factors.push_back({"backend", {}});
  for (const dsl::PlacedName& back_end : study.back_ends) plan.factors.back().levels.push_back(back_end.name);
  if (study.back_ends.empty()) plan.factors.back().levels.push_back(stack.back_end.row().name);

  std::set<std::string> figures;
  for (long condition = 0; condition < plan.conditions(); ++condition) {
    const Session session(program.read(optionsOf(study, plan, plan.levelsOf(condition))), program.registry());
    for (const std::string& name : session.metricNames()) figures.insert(name);
  }
  for (const dsl::StudyFactor& factor : study.factors)
    if (figures.count(factor.parameter))
      throw dsl::InvalidStack({findingAt(study, dsl::code::duplicate_name, factor.place, factor.parameter,
                                         "'" + factor.parameter + "' names a figure of the trials: give the stack's "
                                         "parameter another name", "")});
  const std::vector<std::string> known(figures.begin(), figures.end());
  for (const dsl::PlacedName& metric : study.metrics) {
    if (figures.count(metric.name)) continue;
    warnings.push_back(findingAt(study, dsl::code::unknown_figure, metric.place, metric.name,
                                 "no trial of this study has a figure '" + metric.name + "'",
                                 dsl::nearestName(metric.name, known)));
    warnings.back().severity = dsl::Severity::warning;
  }
  plan.inputs = inputsOf(program, study, stack);
  return plan;
}

std::vector<std::string> runArguments(const dsl::Study& study, const StudyPlan& plan, const Trial& trial) {
  const StackOptions options = optionsOf(study, plan, trial.levels);
  std::vector<std::string> arguments{"run", options.file, "--seed", std::to_string(trial.seed)};
  for (const std::string& setting : options.set) arguments.insert(arguments.end(), {"--set", setting});
  if (!options.back_end.empty()) arguments.insert(arguments.end(), {"--backend", options.back_end});
  if (options.duration) arguments.insert(arguments.end(), {"--duration", control::formatNumber(*options.duration)});
  return arguments;
}

}  // namespace tactus::app
