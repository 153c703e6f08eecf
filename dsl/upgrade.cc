#include "dsl/upgrade.h"

#include <algorithm>

#include "dsl/stack_document.h"

namespace tactus::dsl {
namespace {

class Renamer {
 public:
  Renamer(const control::ElementTable& table, Findings& findings) : table_(table), findings_(findings) {}

  void rename(XmlElement& element) {
    if (!table_.find(element.name))
      if (const control::ElementRow* row = table_.findFormer(element.name)) renameElement(element, row->name);
    if (const control::ElementRow* row = table_.find(element.name)) renameAttributes(element, *row);
    for (const auto& child : element.children) rename(*child);
  }

  std::vector<Edit> edits;

 private:
  void renameElement(XmlElement& element, const std::string& name) {
    findings_.warning(code::former_name, element,
                      "<" + element.name + "> is called <" + name + "> now; 'tactus migrate' rewrites it", name);
    const SourceText& text = element.source->text;
    edits.push_back({text.file(), element.at + 1, element.name.size(), name});
    // The end tag, where there is one: "</name" is the last one before the end.
    const std::string end_tag = "</" + element.name;
    const std::size_t last = text.text().rfind(end_tag, element.end);
    const bool self_closing = text.text().compare(element.end - 2, 2, "/>") == 0;
    if (!self_closing && last != std::string::npos) edits.push_back({text.file(), last + 2, element.name.size(), name});
    element.name = name;
  }

  void renameAttributes(XmlElement& element, const control::ElementRow& row) {
    for (XmlAttribute& attribute : element.attributes) {
      if (row.attribute(attribute.name)) continue;
      const control::AttributeRow* now = row.formerAttribute(attribute.name);
      if (!now) now = formerOption(element, row, attribute.name);
      if (!now || element.attribute(now->name)) continue;          // with both, the old one is an unknown attribute
      findings_.warningAtName(
          code::former_name, element, attribute,
          "attribute '" + attribute.name + "' is called '" + now->name + "' now; 'tactus migrate' rewrites it", now->name);
      edits.push_back({element.source->text.file(), attribute.name_at, attribute.name.size(), now->name});
      attribute.name = now->name;
    }
  }

  const control::AttributeRow* formerOption(const XmlElement& element, const control::ElementRow& row,
                                            const std::string& name) const {
    const XmlAttribute* back_end = row.takes_back_end_options ? element.attribute("backend") : nullptr;
    const control::ElementRow* options = back_end ? table_.findBackEnd(back_end->value) : nullptr;
    return options && !options->attribute(name) ? options->formerAttribute(name) : nullptr;
  }

  const control::ElementTable& table_;
  Findings& findings_;
};

}  // namespace

std::vector<Edit> useNewNames(XmlElement& root, const control::ElementTable& table, Findings& findings) {
  Renamer renamer(table, findings);
  renamer.rename(root);
  return std::move(renamer.edits);
}

Migration migrate(const std::string& file, const control::Registry& registry,
                  const std::function<void(const std::string& plugin)>& load_plugin) {
  Findings findings;
  StackDocument document = readDocument(file, {}, findings);
  if (!document.root) findings.throwErrors();
  loadPlugins(*document.root, load_plugin, findings);
  Findings renamings;
  std::map<std::string, std::vector<Edit>> edits;
  for (Edit& edit : useNewNames(*document.root, registry.elements(), renamings))
    edits[edit.file].push_back(std::move(edit));
  Migration migration;
  for (auto& [name, of_file] : edits) migration.files[name] = applyEdits(document.files.at(name), std::move(of_file));
  migration.changes = renamings.warnings();
  return migration;
}

std::string applyEdits(const std::string& text, std::vector<Edit> edits) {
  std::sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.at < b.at; });
  std::string out;
  std::size_t from = 0;
  for (const Edit& edit : edits) {
    if (edit.at < from) continue;                                  // the same again, of a file that is included twice
    out.append(text, from, edit.at - from).append(edit.text);
    from = edit.at + edit.size;
  }
  return out.append(text, from);
}

}  // namespace tactus::dsl
