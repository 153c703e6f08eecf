#include <algorithm>
#include <filesystem>

#include "dsl/read_stack.h"
#include "dsl/stack_document.h"
#include "dsl/typed_attributes.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ElementRow;
using control::ElementValues;
using control::ValueType;

std::string escape(const std::string& text) {
  std::string out;
  for (char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\n': out += "&#10;"; break;
      case '\r': out += "&#13;"; break;
      case '\t': out += "&#9;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string attributeText(const std::string& name, const std::string& value) {
  return " " + name + "=\"" + escape(value) + "\"";
}

/// Lists with single blanks, all else as it was.
std::string canonical(const AttributeRow& row, const std::string& text) {
  const bool list = row.type == ValueType::reals || row.type == ValueType::points || row.type == ValueType::links ||
                    row.type == ValueType::joints;
  if (!list) return text;
  std::string out;
  for (const std::string& word : splitWords(text)) out.append(out.empty() ? "" : " ").append(word);
  return out;
}

/// Attributes in the order of the row, defaults and classes written out.
std::string attributesOf(const ElementRow& row, const ElementValues& values) {
  std::string out;
  for (const AttributeRow& attribute : row.attributes) {
    if (!values.has(attribute.name) || attribute.type == ValueType::element_class) continue;
    out += attributeText(attribute.name, canonical(attribute, values.text(attribute.name)));
  }
  return out;
}

std::string leaf(const std::string& indent, const ElementValues& values) {
  return indent + "<" + values.row().name + attributesOf(values.row(), values) + "/>\n";
}

std::string numbersText(const Eigen::VectorXd& numbers) {
  std::string out;
  for (double number : numbers) out.append(out.empty() ? "" : " ").append(control::formatNumber(number));
  return out;
}

std::string objectText(const ObjectDescription& object) {
  std::string out = "    <object";
  out += attributesOf(object.values.row(), object.values) + ">\n";
  for (const ElementValues& shape : object.shapes) out += leaf("      ", shape);
  return out + "    </object>\n";
}

std::string levelText(const LevelDescription& level) {
  std::string out = "  <level";
  out += attributeText("priority", std::to_string(level.priority));
  if (level.weight) out += attributeText("weight", control::formatNumber(*level.weight));
  out += attributeText("strict", level.strict ? "true" : "false") + ">\n";
  for (const ElementInstance& task : level.tasks) out += leaf("    ", task.values);
  return out + "  </level>\n";
}

/// A model that was found beside the stack is named by its full path, so that the resolved stack can stand elsewhere.
std::string modelText(const Stack& stack) {
  for (const std::string& file : {stack.robot_model, stack.robot_model + ".urdf"})
    for (const auto& [reader, text] : stack.files)
      if (reader != stack.robot_file && pathBeside(reader, file) == stack.robot_file)
        return std::filesystem::absolute(stack.robot_file).string();
  return stack.robot_model;
}

}  // namespace

std::string writeResolved(const Stack& stack) {
  std::string out = "<?xml version=\"1.0\"?>\n<stack format=\"1\"" + attributeText("name", stack.name) + ">\n";
  for (const std::string& plugin : stack.plugins) out += "  <plugin" + attributeText("name", plugin) + "/>\n";
  out += "  <robot" + attributeText("model", modelText(stack)) + ">\n    <start" +
         attributeText("q", numbersText(stack.start_q)) + "/>\n  </robot>\n";
  out += "  <scene" + attributeText("gravity", numbersText(stack.gravity)) + ">\n";
  for (const ObjectDescription& object : stack.objects) out += objectText(object);
  out += "  </scene>\n";
  if (!stack.signals.empty()) {
    out += "  <signals>\n";
    for (const ElementInstance& signal : stack.signals) out += leaf("    ", signal.values);
    out += "  </signals>\n";
  }
  for (const LevelDescription& level : stack.levels) out += levelText(level);
  out += "  <controller" + attributesOf(stack.controller.values.row(), stack.controller.values) +
         attributesOf(stack.back_end.row(), stack.back_end) + (stack.alternatives.empty() ? "/>\n" : ">\n");
  for (const ElementValues& other : stack.alternatives)
    out += "    <alternative" + attributeText("backend", other.row().name) + attributesOf(other.row(), other) + "/>\n";
  if (!stack.alternatives.empty()) out += "  </controller>\n";
  out += "  <run" + attributeText("duration", control::formatNumber(stack.run.duration)) +
         attributeText("seed", std::to_string(stack.run.seed)) + ">\n    <record" +
         attributeText("columns", stack.run.columns) +
         attributeText("rate", control::formatNumber(stack.run.record_rate)) + "/>\n  </run>\n";
  return out + "</stack>\n";
}

}  // namespace tactus::dsl
