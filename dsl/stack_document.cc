#include "dsl/stack_document.h"

#include <algorithm>
#include <filesystem>

#include "dsl/nearest_name.h"
#include "dsl/typed_attributes.h"

namespace tactus::dsl {
namespace {

namespace fs = std::filesystem;

constexpr int most_includes = 200;
constexpr std::size_t most_of_a_file = 16 << 20;                   // bytes
constexpr std::size_t most_of_all = 64 << 20;

struct Parameter {
  std::string value;
  std::string setting;
  std::string origin;                                              // as a message names it
};

class DocumentReader {
 public:
  DocumentReader(const std::map<std::string, std::string>& set, const std::vector<std::string>& include_folders,
                 Findings& findings, const std::string& outermost)
      : set_(set), include_folders_(include_folders), findings_(findings), outermost_(outermost) {}

  StackDocument run(const std::string& file) {
    allowed_.push_back(identity(fs::absolute(file).parent_path().string()));
    for (const std::string& folder : include_folders_) allowed_.push_back(identity(folder));
    auto source = read(file, {});
    if (!source) {
      auto missing = std::make_shared<XmlSource>();
      missing->text = SourceText(file, "");
      findings_.error(code::unreadable_file, *missing, 0, 1, "the " + outermost_ + " '" + file + "' cannot be read");
      return std::move(document_);
    }
    if (tellTooLarge(*source)) return std::move(document_);
    document_.root = parseXml(source, findings_);
    if (!document_.root) return std::move(document_);
    if (document_.root->name != outermost_) {
      findings_.error(code::wrong_root, *document_.root,
                      "a " + outermost_ + " has <" + outermost_ + "> outermost, not <" + document_.root->name + ">",
                      nearestName(document_.root->name, {outermost_}));
      document_.root.reset();
      return std::move(document_);
    }
    open_files_.push_back(identity(file));
    splice(*document_.root);
    checkSettings();
    substitute(*document_.root);
    return std::move(document_);
  }

 private:
  static std::string identity(const std::string& file) {
    std::error_code error;
    const fs::path path = fs::weakly_canonical(file, error);
    return error ? file : path.string();
  }

  std::shared_ptr<XmlSource> read(const std::string& file, std::vector<description::Place> included_from) {
    auto text = readFile(file, most_of_a_file + 1);
    if (!text) return nullptr;
    bytes_ += text->size();
    document_.files.emplace(file, *text);
    if (!included_from.empty()) document_.included_from.emplace(file, included_from);
    auto source = std::make_shared<XmlSource>();
    source->text = SourceText(file, std::move(*text));
    source->included_from = std::move(included_from);
    return source;
  }

  /// Symbolic links are followed first: what counts is where the file really lies.
  bool isAllowed(const std::string& file) const {
    const std::string real = identity(file);
    return std::any_of(allowed_.begin(), allowed_.end(), [&](const std::string& folder) {
      return real.starts_with(folder.ends_with('/') ? folder : folder + "/");
    });
  }

  bool tellTooLarge(const XmlSource& source) {
    const bool file = source.text.text().size() > most_of_a_file;
    if (!file && bytes_ <= most_of_all) return false;
    const std::size_t most = file ? most_of_a_file : most_of_all;
    findings_.error(code::too_large, source, 0, 1,
                    std::string(file ? "the file has" : "the files of the stack have") + " more than " +
                        std::to_string(most >> 20) + " MiB");
    return true;
  }

  /// Notes parameters and replaces includes below `element`, in document order.
  void splice(XmlElement& element) {
    std::vector<std::unique_ptr<XmlElement>> children;
    children.swap(element.children);
    for (auto& child : children) {
      if (child->name == "include") {
        if (!include(element, *child)) element.incomplete = true;
      } else {
        if (child->name == "parameter" && element.name == "stack") define(*child);
        child->parent = &element;
        splice(*child);
        element.children.push_back(std::move(child));
      }
    }
  }

  /// False when it was refused, which has been told.
  bool include(XmlElement& element, XmlElement& directive) {
    refuseOtherAttributes(directive, {"file"}, findings_);
    for (const auto& child : directive.children)
      findings_.error(code::misplaced_element, *child, "<" + child->name + "> must not stand in <include>");
    if (!requireAttribute(directive, "file", findings_)) return false;
    substitute(directive);
    const XmlAttribute& given = *directive.attribute("file");
    if (++includes_ > most_includes)
      return refuse(directive, code::reference_cycle,
                    "a stack may have at most " + std::to_string(most_includes) + " includes");
    const std::string file = pathBeside(directive.source->text.file(), given.value);
    if (std::find(open_files_.begin(), open_files_.end(), identity(file)) != open_files_.end())
      return refuse(directive, code::reference_cycle,
                    "'" + given.value + "' includes itself, directly or through others");
    if (!isAllowed(file))
      return refuse(directive, code::include_outside,
                    "'" + given.value + "' lies outside of the stack's folder; when you trust it, allow "
                    "its folder in TACTUS_INCLUDE_PATH");
    std::vector<description::Place> way{directive.place()};
    way.insert(way.end(), directive.source->included_from.begin(), directive.source->included_from.end());
    const auto source = read(file, std::move(way));
    if (!source)
      return refuse(directive, code::unreadable_file,
                    "the file '" + given.value + "' cannot be read: looked for '" + file + "'");
    if (tellTooLarge(*source)) return false;
    auto root = parseXml(source, findings_);
    if (!root || !fitsInto(element, *root)) return false;
    open_files_.push_back(identity(file));
    splice(*root);
    open_files_.pop_back();
    for (auto& child : root->children) {
      child->parent = &element;
      element.children.push_back(std::move(child));
    }
    return true;
  }

  bool refuse(const XmlElement& directive, const Code& code, const std::string& message) {
    findings_.errorAtValue(code, directive, *directive.attribute("file"), message);
    return false;
  }

  /// An included file has the element that it extends outermost; what stands inside takes the include's place.
  bool fitsInto(const XmlElement& element, const XmlElement& root) {
    if (root.name != element.name) {
      findings_.error(code::wrong_root, root,
                      "a file included into <" + element.name + "> has <" + element.name + "> outermost, not <" +
                          root.name + ">");
      return false;
    }
    if (root.text_at != nowhere)
      findings_.error(code::stray_text, *root.source, root.text_at, 1, "text must not stand in <" + root.name + ">");
    for (const XmlAttribute& attribute : root.attributes) {
      if (isSchemaHint(attribute)) continue;
      if (root.name == "stack" && (attribute.name == "format" || attribute.name == "name")) {
        if (attribute.name == "format" && attribute.value != "1")
          findings_.errorAtValue(code::wrong_format, root, attribute,
                                 "format '" + attribute.value + "' is not one that this version reads: expected '1'");
      } else {
        findings_.errorAtName(code::unknown_attribute, root, attribute,
                              "the outermost element of an included file has no attribute '" + attribute.name + "'");
      }
    }
    return true;
  }

  void define(const XmlElement& element) {
    const XmlAttribute* name = element.attribute("name");
    const XmlAttribute* value = element.attribute("value");
    if (!name || !value) return;  // the grammar says so
    if (value->value.find("${") != std::string::npos)
      return findings_.errorAtValue(code::bad_value, element, *value,
                                    "the value of a parameter is taken as written: '${' has no meaning in it");
    const description::Place place = element.source->text.place(value->value_at);
    Parameter parameter{value->value, "",
                        "parameter '" + name->value + "' at " + place.file + ":" + std::to_string(place.line) + ":" +
                            std::to_string(place.column)};
    if (const auto given = set_.find(name->value); given != set_.end()) {
      const std::string setting = "--set " + given->first + "=" + given->second;
      parameter = {given->second, setting, setting};
    }
    if (!parameters_.emplace(name->value, parameter).second)
      findings_.errorAtValue(code::duplicate_name, element, *name,
                             "the stack has a parameter '" + name->value + "' already");
  }

  std::vector<std::string> parameterNames() const {
    std::vector<std::string> names;
    for (const auto& [name, parameter] : parameters_) names.push_back(name);
    return names;
  }

  void checkSettings() {
    for (const auto& [name, value] : set_) {
      if (value.find("${") != std::string::npos)
        findings_.error(code::bad_value, *document_.root,
                        "--set " + name + "=" + value + ": the value of a parameter is taken as written: '${' has no "
                        "meaning in it");
      if (!parameters_.count(name))
        findings_.error(code::unknown_parameter, *document_.root,
                        "--set " + name + "=" + value + ": the stack has no parameter '" + name + "'",
                        nearestName(name, parameterNames()));
    }
  }

  void substitute(XmlElement& element) {
    if (element.name != "parameter")
      for (XmlAttribute& attribute : element.attributes)
        if (attribute.value.find("${") != std::string::npos) substitute(element, attribute);
    for (auto& child : element.children) substitute(*child);
  }

  void substitute(const XmlElement& element, XmlAttribute& attribute) {
    const std::string written = attribute.value;
    std::string text, setting, origins;
    std::size_t at = 0;
    for (std::size_t open; (open = written.find("${", at)) != std::string::npos;) {
      const std::size_t close = written.find('}', open);
      if (close == std::string::npos)
        return findings_.errorAtValue(code::bad_value, element, attribute, "'${' is not closed by '}'");
      const std::string name = written.substr(open + 2, close - open - 2);
      const auto found = parameters_.find(name);
      if (found == parameters_.end()) {
        return sayUnknown(element, attribute, name);
      }
      text += written.substr(at, open - at) + found->second.value;
      if (setting.empty()) setting = found->second.setting;
      if (origins.find(found->second.origin) == std::string::npos)
        origins += (origins.empty() ? "" : ", ") + found->second.origin;
      at = close + 1;
    }
    attribute.value = text + written.substr(at);
    attribute.setting = setting;
    attribute.brought_by = origins;
  }

  /// Points at the ${…} itself.
  void sayUnknown(const XmlElement& element, const XmlAttribute& attribute, const std::string& name) {
    XmlAttribute reference = attribute;
    const std::string_view raw =
        std::string_view(element.source->text.text()).substr(attribute.value_at, attribute.value_size);
    if (const std::size_t shift = raw.find("${" + name + "}"); shift != std::string_view::npos) {
      reference.value_at += shift;
      reference.value_size = name.size() + 3;
    }
    findings_.errorAtValue(code::unknown_parameter, element, reference, "the stack has no parameter '" + name + "'",
                           nearestName(name, parameterNames()));
  }

  const std::map<std::string, std::string>& set_;
  const std::vector<std::string>& include_folders_;
  std::vector<std::string> allowed_;                               // their real paths, and the stack's own
  std::size_t bytes_ = 0;                                          // of all files
  Findings& findings_;
  const std::string& outermost_;
  StackDocument document_;
  std::map<std::string, Parameter> parameters_;
  std::vector<std::string> open_files_;
  int includes_ = 0;
};

}  // namespace

std::string pathBeside(const std::string& from, const std::string& file) {
  const fs::path path(file);
  return path.is_absolute() ? file : (fs::path(from).parent_path() / path).lexically_normal().string();
}

std::vector<std::string> loadPlugins(const XmlElement& root, const std::function<void(const std::string&)>& load,
                                     Findings& findings) {
  std::vector<std::string> loaded;
  bool failed = false;
  for (const auto& child : root.children) {
    const XmlAttribute* name = child->name == "plugin" ? child->attribute("name") : nullptr;
    if (!name || std::find(loaded.begin(), loaded.end(), name->value) != loaded.end()) continue;
    std::string reason = "this program loads no plugins";
    try {
      if (load) {
        load(name->value);
        loaded.push_back(name->value);
        continue;
      }
    } catch (const std::exception& error) {
      reason = error.what();
    }
    failed = true;
    Findings alone;
    alone.errorAtValue(code::plugin_failed, *child, *name,
                       "the plugin '" + name->value + "' cannot be loaded: " + reason);
    Diagnostic diagnostic = alone.errors().front();
    diagnostic.exit_code = 4;
    findings.add(std::move(diagnostic));
  }
  if (failed) findings.throwErrors();
  return loaded;
}

StackDocument readDocument(const std::string& file, const std::map<std::string, std::string>& set,
                           const std::vector<std::string>& include_folders, Findings& findings,
                           const std::string& outermost) {
  return DocumentReader(set, include_folders, findings, outermost).run(file);
}

}  // namespace tactus::dsl
