#include "dsl/stack_graph.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "dsl/source_text.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::Origin;
using control::PortRow;
using control::ValueType;
using nlohmann::ordered_json;

/// Reads, and is no part of the controller.
bool isWatcher(const GraphNode& node) {
  return node.kind == GraphNode::Kind::measure || node.kind == GraphNode::Kind::recorder;
}

std::string kindOf(const GraphNode& node) {
  switch (node.kind) {
    case GraphNode::Kind::sensor: return "sensor";
    case GraphNode::Kind::signal: return "signal";
    case GraphNode::Kind::level: return "level";
    case GraphNode::Kind::controller: return "controller";
    case GraphNode::Kind::task: return "task";
    case GraphNode::Kind::measure: return "measure";
    case GraphNode::Kind::recorder: return "recorder";
  }
  return "";
}

/// Ids are those of the log: "signal/touch", "level/1", "task/hold".
std::string idOf(const GraphNode& node) { return kindOf(node) + "/" + node.name; }

bool isSource(const GraphNode& node) {
  return node.kind == GraphNode::Kind::sensor || node.kind == GraphNode::Kind::signal;
}

const PortRow* portOf(const GraphNode& node, const std::string& name) {
  const auto found = std::find_if(node.ports.begin(), node.ports.end(), [&](const PortRow& row) { return row.name == name; });
  return found == node.ports.end() ? nullptr : &*found;
}

class Builder {
 public:
  explicit Builder(const Stack& stack) : stack_(stack) { graph_.stack = stack.name; }

  StackGraph run() {
    const auto addSource = [this](GraphNode::Kind kind, const ElementInstance& source) {
      sources_[source.name] = add(kind, source, source.name);
      graph_.nodes.back().ports = source.values.ports();
    };
    for (const ElementInstance& sensor : stack_.sensors) addSource(GraphNode::Kind::sensor, sensor);
    for (const ElementInstance& signal : stack_.signals) addSource(GraphNode::Kind::signal, signal);
    for (const ElementInstance* source : stack_.sources()) read(*source, sources_[source->name]);
    for (const LevelDescription& level : stack_.levels) {
      const int node = add(GraphNode::Kind::level, level.element, std::to_string(level.priority));
      read(level.element, node);
      const auto addReader = [&](GraphNode::Kind kind, const ElementInstance& element) {
        const int id = add(kind, element, element.name);
        graph_.nodes.back().level = node;
        read(element, id);
      };
      if (level.controller) addReader(GraphNode::Kind::controller, *level.controller);
      for (const ElementInstance& task : level.tasks) addReader(GraphNode::Kind::task, task);
    }
    for (const ElementInstance& measure : stack_.run.measures)
      read(measure, add(GraphNode::Kind::measure, measure, measure.name));
    for (const ElementInstance& recorder : stack_.run.recorders)
      read(recorder, add(GraphNode::Kind::recorder, recorder, recorder.name));
    for (auto& node : graph_.nodes) node.used = node.kind != GraphNode::Kind::signal;
    for (const GraphEdge& edge : graph_.edges)
      for (const int end : {edge.from, edge.to}) graph_.nodes[static_cast<std::size_t>(end)].used = true;
    return std::move(graph_);
  }

 private:
  int add(GraphNode::Kind kind, const ElementInstance& element, const std::string& name) {
    GraphNode node;
    node.kind = kind;
    node.name = name;
    node.element = element.values.row().name;
    node.place = element.place;
    graph_.nodes.push_back(std::move(node));
    return static_cast<int>(graph_.nodes.size()) - 1;
  }

  void read(const ElementInstance& element, int to) { read(element.values, to); }

  void read(const control::ElementValues& values, int to) {
    for (const control::ElementValues& child : values.children) read(child, to);
    for (const AttributeRow& row : values.row().attributes) {
      if (row.type != ValueType::port || !values.has(row.name)) continue;
      const control::Value& value = values.value(row.name);
      const std::size_t dot = value.text.find('.');
      const auto signal = sources_.find(value.text.substr(0, dot));
      if (dot == std::string::npos || signal == sources_.end()) continue;  // a word, or a default without its signal
      const std::string port = value.text.substr(dot + 1);
      if (!portOf(graph_.nodes[static_cast<std::size_t>(signal->second)], port)) continue;
      graph_.edges.push_back(
          {signal->second, port, to, row.name, value.origin.kind == Origin::Kind::table_default});
    }
  }

  const Stack& stack_;
  StackGraph graph_;
  std::map<std::string, int> sources_;
};

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

// ---- The drawing.

constexpr double box_width = 200, row_height = 17, title_height = 40, gap = 22, column_gap = 130, margin = 24;

std::string px(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, std::round(value * 10) / 10).ptr};
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else out += c;
  }
  return out;
}

std::string textAt(double x, double y, const std::string& text, const std::string& style) {
  return "<text x='" + px(x) + "' y='" + px(y) + "' " + style + ">" + escaped(text) + "</text>\n";
}

/// Same port types have the same colour.
std::string colourOf(const std::string& type) {
  static const std::map<std::string, std::string> known{{"contact-set", "#0072b2"}, {"missing-set", "#d55e00"},
                                                        {"touched-points", "#009e73"}, {"frame-set", "#8a6d00"},
                                                        {"feature", "#cc79a7"},     {"scalar", "#666666"},
                                                        {"vector", "#5b4bb5"}};
  const auto found = known.find(type);
  return found == known.end() ? "#222222" : found->second;
}

class Drawing {
 public:
  explicit Drawing(const StackGraph& graph) : graph_(graph), boxes_(graph.nodes.size()) {}

  std::string run() {
    for (std::size_t i = 0; i < boxes_.size(); ++i) collectRows(i);
    placeSignals();
    placeTasks();
    std::string svg;
    for (const GraphEdge& edge : graph_.edges) svg += draw(edge);
    for (std::size_t i = 0; i < boxes_.size(); ++i) svg += draw(i);
    return "<svg xmlns='http://www.w3.org/2000/svg' width='" + px(width_) + "' height='" + px(height_) + "' viewBox='0 0 " +
           px(width_) + " " + px(height_) +
           "' font-family='system-ui, DejaVu Sans, Liberation Sans, sans-serif' font-size='12'>\n"
           "<rect width='100%' height='100%' fill='#ffffff'/>\n" + svg + "</svg>\n";
  }

 private:
  struct Box {
    double x = 0, y = 0, width = box_width, height = 0;
    std::vector<std::string> rows;                                 // ports of a signal, attributes of a reader
  };

  const GraphNode& node(std::size_t i) const { return graph_.nodes[i]; }

  /// Inputs first, then outputs.
  void collectRows(std::size_t i) {
    std::vector<std::string>& rows = boxes_[i].rows;
    const auto add = [&](const std::string& row) {
      if (std::find(rows.begin(), rows.end(), row) == rows.end()) rows.push_back(row);
    };
    for (const GraphEdge& edge : graph_.edges)
      if (edge.to == static_cast<int>(i)) add("> " + edge.attribute);
    for (const PortRow& port : node(i).ports) add(port.name);
    boxes_[i].height = title_height + row_height * static_cast<double>(rows.size()) + (rows.empty() ? 0 : 6);
  }

  /// Columns by how many signals stand before one.
  void placeSignals() {
    std::vector<int> depth(graph_.nodes.size(), 0);
    for (std::size_t round = 0; round < graph_.nodes.size(); ++round)
      for (const GraphEdge& edge : graph_.edges)
        if (isSource(node(static_cast<std::size_t>(edge.to))))
          depth[static_cast<std::size_t>(edge.to)] =
              std::min(std::max(depth[static_cast<std::size_t>(edge.to)], depth[static_cast<std::size_t>(edge.from)] + 1),
                       static_cast<int>(graph_.nodes.size()));
    std::map<int, double> bottom;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (!isSource(node(i))) continue;
      double& y = bottom.try_emplace(depth[i], margin).first->second;
      boxes_[i].x = margin + depth[i] * (box_width + column_gap);
      boxes_[i].y = y;
      y += boxes_[i].height + gap;
      tasks_x_ = std::max(tasks_x_, boxes_[i].x + box_width + column_gap);
      height_ = std::max(height_, y);
    }
  }

  void placeTasks() {
    double y = margin;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (node(i).kind != GraphNode::Kind::level) continue;
      Box& level = boxes_[i];
      level.x = tasks_x_;
      level.y = y;
      level.width = box_width + 2 * gap;
      y += level.height;
      for (std::size_t k = i + 1; k < boxes_.size() && node(k).level == static_cast<int>(i); ++k) {
        boxes_[k].x = tasks_x_ + gap;
        boxes_[k].y = y;
        y += boxes_[k].height + gap / 2;
      }
      level.height = y + gap / 2 - level.y;
      y += gap / 2 + gap;
    }
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (!isWatcher(node(i))) continue;
      boxes_[i].x = tasks_x_ + gap / 2;
      boxes_[i].y = y;
      y += boxes_[i].height + gap;
    }
    width_ = tasks_x_ + box_width + 2 * gap + margin;
    height_ = std::max(height_, y) + margin - gap;
  }

  double rowY(std::size_t i, const std::string& row) const {
    const auto& rows = boxes_[i].rows;
    const auto index = std::find(rows.begin(), rows.end(), row) - rows.begin();
    return boxes_[i].y + title_height + row_height * (static_cast<double>(index) + 0.5);
  }

  std::string draw(const GraphEdge& edge) const {
    const auto from = static_cast<std::size_t>(edge.from), to = static_cast<std::size_t>(edge.to);
    const double x0 = boxes_[from].x + box_width, y0 = rowY(from, edge.port);
    const double x1 = boxes_[to].x, y1 = rowY(to, "> " + edge.attribute);
    const double bend = std::max(50.0, (x1 - x0) / 2);
    const std::string type = portOf(node(from), edge.port)->type;
    return "<path d='M" + px(x0) + " " + px(y0) + "C" + px(x0 + bend) + " " + px(y0) + " " + px(x1 - bend) + " " + px(y1) +
           " " + px(x1) + " " + px(y1) + "' fill='none' stroke='" + colourOf(type) + "' stroke-width='1.6'" +
           (edge.by_default ? " stroke-dasharray='5 4'" : "") + "><title>" +
           escaped(node(from).name + "." + edge.port + " (" + type + ") → " + node(to).name + " " + edge.attribute) +
           "</title></path>\n";
  }

  std::string draw(std::size_t i) const {
    const Box& box = boxes_[i];
    const GraphNode& n = node(i);
    const bool level = n.kind == GraphNode::Kind::level;
    std::string svg = "<rect x='" + px(box.x) + "' y='" + px(box.y) + "' width='" + px(box.width) + "' height='" +
                      px(box.height) + "' rx='7' fill='" +
                      (level ? "none" : isSource(n) ? "#eef4f8" : "#f7f4ea") + "' stroke='" +
                      (n.used ? "#9aa5ad" : "#d55e00") + "'" + (level ? " stroke-dasharray='2 3'" : "") + "/>\n";
    svg += textAt(box.x + 10, box.y + 17, level ? "level " + n.name : n.name, "font-weight='600' fill='#222'");
    if (!level) svg += textAt(box.x + 10, box.y + 32, n.element + (n.used ? "" : ", not used"), "fill='#666'");
    for (const std::string& row : box.rows) {
      const bool input = row.starts_with("> ");
      const double y = rowY(i, row) + 4;
      if (input) {
        svg += textAt(box.x + 10, y, row.substr(2), "fill='#333'");
        continue;
      }
      const PortRow& port = *portOf(n, row);
      const std::string unit = port.unit.empty() || port.unit == "1" ? "" : " (" + port.unit + ")";
      svg += textAt(box.x + box.width - 10, y, row + unit, "text-anchor='end' fill='" + colourOf(port.type) + "'");
    }
    return svg;
  }

  const StackGraph& graph_;
  std::vector<Box> boxes_;
  double tasks_x_ = margin;
  double width_ = 0, height_ = margin;
};

}  // namespace

StackGraph graphOf(const Stack& stack) { return Builder(stack).run(); }

std::string graphToDot(const StackGraph& graph) {
  std::string out = "digraph " + quoted(graph.stack) + " {\n  rankdir=LR;\n  node [shape=box, fontname=\"sans-serif\"];\n";
  const auto node = [&](std::size_t i, const std::string& indent) {
    const GraphNode& n = graph.nodes[i];
    out += indent + quoted(idOf(n)) + " [label=" + quoted(n.name + "\n" + n.element) +
           (isSource(n) ? ", style=rounded" : "") + (n.used ? "" : ", color=orange") + "];\n";
  };
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    if (isSource(graph.nodes[i]) || isWatcher(graph.nodes[i])) node(i, "  ");
    if (graph.nodes[i].kind != GraphNode::Kind::level) continue;
    out += "  subgraph " + quoted("cluster_" + graph.nodes[i].name) + " {\n    label=" +
           quoted("level " + graph.nodes[i].name) + ";\n";
    node(i, "    ");
    for (std::size_t k = i + 1; k < graph.nodes.size() && graph.nodes[k].level == static_cast<int>(i); ++k) node(k, "    ");
    out += "  }\n";
  }
  for (const GraphEdge& edge : graph.edges)
    out += "  " + quoted(idOf(graph.nodes[static_cast<std::size_t>(edge.from)])) + " -> " +
           quoted(idOf(graph.nodes[static_cast<std::size_t>(edge.to)])) + " [label=" +
           quoted(edge.port + " → " + edge.attribute) + (edge.by_default ? ", style=dashed" : "") + "];\n";
  return out + "}\n";
}

std::string graphToSvg(const StackGraph& graph) { return Drawing(graph).run(); }

ordered_json graphToJson(const StackGraph& graph) {
  ordered_json nodes = ordered_json::array(), edges = ordered_json::array();
  for (const GraphNode& node : graph.nodes) {
    ordered_json json{{"id", idOf(node)}, {"name", node.name}, {"element", node.element}, {"file", node.place.file},
                      {"line", node.place.line}, {"column", node.place.column}};
    json["kind"] = kindOf(node);
    if (node.level >= 0) json["level"] = graph.nodes[static_cast<std::size_t>(node.level)].name;
    if (isSource(node)) {
      json["used"] = node.used;
      json["ports"] = ordered_json::array();
      for (const PortRow& port : node.ports) {
        ordered_json row{{"name", port.name}, {"type", port.type}, {"unit", port.unit}};
        if (port.dimension > 0) row["dimension"] = port.dimension;
        json["ports"].push_back(row);
      }
    }
    nodes.push_back(json);
  }
  for (const GraphEdge& edge : graph.edges) {
    const GraphNode& from = graph.nodes[static_cast<std::size_t>(edge.from)];
    const PortRow& port = *portOf(from, edge.port);
    edges.push_back({{"from", idOf(from)}, {"port", edge.port}, {"type", port.type}, {"unit", port.unit},
                     {"to", idOf(graph.nodes[static_cast<std::size_t>(edge.to)])}, {"attribute", edge.attribute},
                     {"by_default", edge.by_default}});
  }
  return {{"stack", graph.stack}, {"nodes", nodes}, {"edges", edges}};
}

}  // namespace tactus::dsl
