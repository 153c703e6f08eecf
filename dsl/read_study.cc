#include "dsl/read_study.h"

#include <algorithm>
#include <filesystem>

#include "dsl/element_checker.h"
#include "dsl/nearest_name.h"
#include "dsl/stack_document.h"
#include "dsl/typed_attributes.h"

namespace tactus::dsl {
namespace {

constexpr const char* by_back_end = "backend";
/// Names of other columns of the results.
const std::vector<std::string> taken_names{by_back_end, "seed", "trial", "status", "exit_code", "fallback_ticks"};

std::vector<std::string> splitAt(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t from = 0;;) {
    const std::size_t end = text.find(separator, from);
    std::string part = text.substr(from, end - from);
    part.erase(0, part.find_first_not_of(" \t\n"));
    part.erase(part.find_last_not_of(" \t\n") + 1);
    if (!part.empty()) parts.push_back(std::move(part));
    if (end == std::string::npos) return parts;
    from = end + 1;
  }
}

/// Values that stand between blanks, or between semicolons where there are any.
std::vector<std::string> splitValues(const std::string& text) {
  return text.find(';') == std::string::npos ? splitWords(text) : splitAt(text, ';');
}

class StudyReader {
 public:
  StudyReader(const std::string& file, const control::Registry& registry) : registry_(registry) { study_.file = file; }

  Study run(const std::vector<std::string>& include_folders) {
    StackDocument document = readDocument(study_.file, {}, include_folders, findings_, "study");
    study_.files = std::move(document.files);
    if (!document.root) findings_.throwErrors();
    const CheckedElement root = ElementChecker(registry_.elements(), findings_).check(*document.root);
    if (root.values.has("format") && root.values.integer("format") != 1)
      findings_.errorAtValue(code::wrong_format, *root.xml, *root.xml->attribute("format"),
                             "format '" + root.values.text("format") +
                                 "' is not one that this version reads: expected '1'");
    study_.name = root.values.has("name") ? root.values.text("name")
                                          : std::filesystem::path(study_.file).stem().string();
    if (root.values.has("stack")) study_.stack = pathBeside(study_.file, root.values.text("stack"));
    if (root.values.has("duration")) study_.duration = root.values.real("duration");
    if (root.values.has("keep")) study_.keeps_runs = root.values.text("keep") == "runs";
    for (const CheckedElement* element : root.all("factor")) readFactor(*element);
    for (const CheckedElement* element : root.all("seeds")) readSeeds(*element);
    for (const CheckedElement* element : root.all("backends")) readBackEnds(*element);
    for (const CheckedElement* element : root.all("metric")) readMetric(*element);
    for (const CheckedElement* element : root.all("compare")) readComparison(*element);
    checkSize(root);
    findings_.throwErrors();
    return std::move(study_);
  }

 private:
  static description::Place placeOf(const CheckedElement& element, const char* attribute) {
    return element.values.value(attribute).origin.place;
  }

  /// Levels are told apart by what is written.
  void checkLevels(const CheckedElement& element, const char* attribute, const std::vector<std::string>& levels) {
    const XmlAttribute& written = *element.xml->attribute(attribute);
    if (levels.empty())
      findings_.errorAtValue(code::bad_value, *element.xml, written,
                             std::string("attribute '") + attribute + "': expected one value at least");
    for (std::size_t i = 0; i < levels.size(); ++i)
      if (std::find(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(i), levels[i]) !=
          levels.begin() + static_cast<std::ptrdiff_t>(i))
        findings_.errorAtValue(code::duplicate_name, *element.xml, written,
                               "'" + levels[i] + "' stands here twice: every value is tried once with each seed");
  }

  void readFactor(const CheckedElement& element) {
    if (!element.values.has("parameter") || !element.values.has("values")) return;
    StudyFactor factor{element.values.text("parameter"), splitValues(element.values.text("values")),
                       placeOf(element, "parameter"), placeOf(element, "values")};
    const XmlAttribute& name = *element.xml->attribute("parameter");
    if (std::find(taken_names.begin(), taken_names.end(), factor.parameter) != taken_names.end())
      findings_.errorAtValue(code::duplicate_name, *element.xml, name,
                             "'" + factor.parameter + "' names another column of the results: give the stack's "
                             "parameter another name");
    for (const StudyFactor& other : study_.factors)
      if (other.parameter == factor.parameter)
        findings_.errorAtValue(code::duplicate_name, *element.xml, name,
                               "the study has a factor '" + factor.parameter + "' already");
    checkLevels(element, "values", factor.values);
    study_.factors.push_back(std::move(factor));
  }

  void readSeeds(const CheckedElement& element) {
    if (!element.values.has("from") || !element.values.has("count")) return;
    study_.first_seed = static_cast<std::uint64_t>(element.values.integer("from"));
    study_.seeds = element.values.integer("count");
    if (static_cast<double>(study_.first_seed) + study_.seeds - 1 > 2147483647)
      findings_.errorAtValue(code::bad_value, *element.xml, *element.xml->attribute("count"),
                             "attribute 'count': the last seed would be beyond 2147483647");
  }

  void readBackEnds(const CheckedElement& element) {
    if (!element.values.has("names")) return;
    const std::vector<std::string> names = splitWords(element.values.text("names"));
    for (const std::string& name : names) study_.back_ends.push_back({name, placeOf(element, "names")});
    checkLevels(element, "names", names);
  }

  void readMetric(const CheckedElement& element) {
    if (!element.values.has("name")) return;
    const PlacedName metric{element.values.text("name"), placeOf(element, "name")};
    for (const PlacedName& other : study_.metrics)
      if (other.name == metric.name)
        findings_.errorAtValue(code::duplicate_name, *element.xml, *element.xml->attribute("name"),
                               "the study reports '" + metric.name + "' already");
    study_.metrics.push_back(metric);
  }

  void readComparison(const CheckedElement& element) {
    if (!element.values.has("metric") || !element.values.has("by") || !element.values.has("baseline")) return;
    StudyComparison comparison{element.values.text("metric"), element.values.text("by"), element.values.text("baseline"),
                               {}};
    if (element.values.has("over")) comparison.over = splitValues(element.values.text("over"));
    if (!study_.metrics.empty()) {
      std::vector<std::string> reported;
      for (const PlacedName& metric : study_.metrics) reported.push_back(metric.name);
      expectOneOf(element, "metric", comparison.metric, reported, "the study reports no metric");
    }
    std::vector<std::string> factors;
    for (const StudyFactor& factor : study_.factors) factors.push_back(factor.parameter);
    if (!study_.back_ends.empty()) factors.push_back(by_back_end);
    if (!expectOneOf(element, "by", comparison.by, factors, "the study has no factor")) return;
    std::vector<std::string> levels;
    for (const StudyFactor& factor : study_.factors)
      if (factor.parameter == comparison.by) levels = factor.values;
    if (comparison.by == by_back_end)
      for (const PlacedName& back_end : study_.back_ends) levels.push_back(back_end.name);
    if (!expectOneOf(element, "baseline", comparison.baseline, levels, "'" + comparison.by + "' has no level")) return;
    std::erase(factors, comparison.by);
    for (const std::string& factor : comparison.over)
      if (!expectOneOf(element, "over", factor, factors, "there is no other factor")) return;
    study_.comparisons.push_back(std::move(comparison));
  }

  /// An attribute that only the table gives is told at its element.
  bool expectOneOf(const CheckedElement& element, const char* attribute, const std::string& name,
                   const std::vector<std::string>& names, const std::string& refusal) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return true;
    std::string listed;
    for (const std::string& one : names) listed += (listed.empty() ? "" : ", ") + one;
    const std::string message = refusal + " '" + name + "'; there " + (names.empty() ? "is none" : "is " + listed);
    if (const XmlAttribute* written = element.xml->attribute(attribute))
      findings_.errorAtValue(code::bad_value, *element.xml, *written, message, nearestName(name, names));
    else
      findings_.error(code::bad_value, *element.xml, message);
    return false;
  }

  void checkSize(const CheckedElement& root) {
    double trials = study_.seeds;
    for (const StudyFactor& factor : study_.factors) trials *= static_cast<double>(factor.values.size());
    trials *= static_cast<double>(std::max<std::size_t>(1, study_.back_ends.size()));
    if (trials > most_trials)
      findings_.error(code::bad_value, *root.xml,
                      "the study has " + control::formatNumber(trials) + " trials, and may have " +
                          std::to_string(most_trials));
  }

  const control::Registry& registry_;
  Findings findings_;
  Study study_;
};

}  // namespace

Study readStudy(const std::string& file, const control::Registry& registry,
                const std::vector<std::string>& include_folders) {
  return StudyReader(file, registry).run(include_folders);
}

bool isStudy(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;  // a pipe is read once
  auto text = readFile(file);
  if (!text) return false;
  auto source = std::make_shared<XmlSource>();
  source->text = SourceText(file, std::move(*text));
  Findings ignored;
  const auto root = parseXml(source, ignored);
  return root && root->name == "study";
}

}  // namespace tactus::dsl
