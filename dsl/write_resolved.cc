#include <algorithm>
#include <filesystem>

#include "dsl/file_value.h"
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

bool isReference(ValueType type) {
  return type == ValueType::port || type == ValueType::link || type == ValueType::links || type == ValueType::joints ||
         type == ValueType::object;
}

/// The table may name by default what this stack does not have; written out, that would be an error.
bool isWritten(const AttributeRow& row, const control::Value& value, const std::vector<const ElementInstance*>& sources) {
  if (row.type == ValueType::element_class) return false;
  if (value.origin.kind != control::Origin::Kind::table_default || !isReference(row.type)) return true;
  if (std::find(row.choices.begin(), row.choices.end(), value.text) != row.choices.end()) return true;
  const std::size_t dot = value.text.find('.');
  return row.type == ValueType::port && dot != std::string::npos &&
         std::any_of(sources.begin(), sources.end(), [&](const ElementInstance* source) {
           const std::vector<control::PortRow> ports = source->values.ports();
           return source->name == value.text.substr(0, dot) &&
                  std::any_of(ports.begin(), ports.end(), [&](const control::PortRow& port) {
                    return port.name == value.text.substr(dot + 1) && port.type == row.port_type;
                  });
         });
}

/// A file that was found beside the stack is named by its full path, so that the resolved stack can stand elsewhere.
std::string fileText(const control::Value& value) {
  const std::string file = fileOf(value);
  return std::filesystem::exists(file) ? file : value.text;
}

/// Attributes in the order of the row, defaults and classes written out.
std::string attributesOf(const ElementRow& row, const ElementValues& values,
                         const std::vector<const ElementInstance*>& sources = {}) {
  std::string out;
  for (const AttributeRow& attribute : row.attributes) {
    if (!values.has(attribute.name) || !isWritten(attribute, values.value(attribute.name), sources)) continue;
    const control::Value& value = values.value(attribute.name);
    const bool is_file = attribute.type == ValueType::file;
    out += attributeText(attribute.name, is_file ? fileText(value) : canonical(attribute, value.text));
  }
  return out;
}

std::string leaf(const std::string& indent, const ElementValues& values,
                 const std::vector<const ElementInstance*>& sources = {}) {
  const std::string start = indent + "<" + values.row().name + attributesOf(values.row(), values, sources);
  if (values.children.empty()) return start + "/>\n";
  std::string out = start + ">\n";
  for (const ElementValues& child : values.children) out += leaf(indent + "  ", child, sources);
  return out + indent + "</" + values.row().name + ">\n";
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
  for (const ElementValues& waypoint : object.values.children) out += leaf("      ", waypoint);
  return out + "    </object>\n";
}

std::string levelText(const LevelDescription& level, const std::vector<const ElementInstance*>& sources) {
  std::string out = "  <level" + attributesOf(level.element.values.row(), level.element.values, sources) + ">\n";
  if (level.controller) out += leaf("    ", level.controller->values, sources);
  for (const ElementInstance& task : level.tasks) out += leaf("    ", task.values, sources);
  return out + "  </level>\n";
}

std::string targetText(const TargetDescription& target) {
  std::string out = "    <target" + attributeText("metric", target.metric);
  if (target.lower) out += attributeText("lower", control::formatNumber(*target.lower));
  if (target.upper) out += attributeText("upper", control::formatNumber(*target.upper));
  return out + "/>\n";
}

/// A model that was found beside the stack is named by its full path, so that the resolved stack can stand elsewhere.
std::string modelText(const Stack& stack) {
  for (const std::string& file : {stack.robot_model, stack.robot_model + ".urdf"})
    for (const auto& [reader, text] : stack.files)
      if (reader != stack.robot_file && pathBeside(reader, file) == stack.robot_file)
        return std::filesystem::absolute(stack.robot_file).string();
  return stack.robot_model;
}

std::string startJitterText(const Stack& stack) {
  const StartJitter& jitter = stack.start_jitter;
  std::string text;
  if (!jitter.joints.isZero(0)) text += attributeText("jitter", numbersText(jitter.joints));
  if (jitter.link >= 0)
    text += attributeText("frame", stack.robot.links[static_cast<std::size_t>(jitter.link)].name) +
            attributeText("frame-jitter", numbersText(jitter.pose));
  return text;
}

}  // namespace

std::string writeResolved(const Stack& stack) {
  std::string out = "<?xml version=\"1.0\"?>\n<stack format=\"1\"" + attributeText("name", stack.name) + ">\n";
  for (const std::string& plugin : stack.plugins) out += "  <plugin" + attributeText("name", plugin) + "/>\n";
  const bool touches_itself = stack.self_contact != "none";
  out += "  <robot" + attributeText("model", modelText(stack)) +
         (touches_itself ? attributeText("self-contact", stack.self_contact) : "") + ">\n    <start" +
         attributeText("q", numbersText(stack.start_q)) + startJitterText(stack) + "/>\n  </robot>\n";
  out += "  <scene" + attributeText("gravity", numbersText(stack.gravity)) + ">\n";
  for (const ObjectDescription& object : stack.objects) out += objectText(object);
  for (const PairDescription& pair : stack.pairs) out += leaf("    ", pair.values);
  out += "  </scene>\n";
  const std::vector<const ElementInstance*> sources = stack.sources();
  const auto list = [&](const std::string& name, const std::vector<ElementInstance>& elements) {
    if (elements.empty()) return;
    out += "  <" + name + ">\n";
    for (const ElementInstance& element : elements) out += leaf("    ", element.values, sources);
    out += "  </" + name + ">\n";
  };
  list("sensors", stack.sensors);
  list("faults", stack.fault_elements);
  list("signals", stack.signals);
  for (const LevelDescription& level : stack.levels) out += levelText(level, sources);
  out += "  <controller" + attributesOf(stack.controller.values.row(), stack.controller.values) +
         attributesOf(stack.back_end.row(), stack.back_end) + (stack.alternatives.empty() ? "/>\n" : ">\n");
  for (const ElementValues& other : stack.alternatives)
    out += "    <alternative" + attributeText("backend", other.row().name) + attributesOf(other.row(), other) + "/>\n";
  if (!stack.alternatives.empty()) out += "  </controller>\n";
  out += "  <run" + attributeText("duration", control::formatNumber(stack.run.duration)) +
         attributeText("seed", std::to_string(stack.run.seed)) +
         (stack.run.count_while.empty() ? "" : attributeText("count-while", stack.run.count_while)) + ">\n    <record" +
         attributeText("columns", stack.run.columns) +
         attributeText("rate", control::formatNumber(stack.run.record_rate)) + "/>\n";
  for (const ElementInstance& measure : stack.run.measures) out += leaf("    ", measure.values, sources);
  for (const ElementInstance& recorder : stack.run.recorders) out += leaf("    ", recorder.values, sources);
  for (const TargetDescription& target : stack.run.targets) out += targetText(target);
  return out + "  </run>\n</stack>\n";
}

}  // namespace tactus::dsl
