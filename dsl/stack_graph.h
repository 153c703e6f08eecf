#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "dsl/stack.h"

/// Which element of a stack reads which port: sensors and signals on the left, tasks in their levels on the right.
namespace tactus::dsl {

struct GraphNode {
  enum class Kind { sensor, signal, level, controller, task, measure, recorder } kind = Kind::signal;
  std::string name;                                                ///< of a level: its priority
  std::string element;                                             ///< "contacts", "level", "posture"
  description::Place place;
  int level = -1;                                                  ///< of a task or controller: index of its level's node
  bool used = true;                                                ///< false: a signal that reads and is read by nothing
  std::vector<control::PortRow> ports;                             ///< of a sensor or signal
};

struct GraphEdge {
  int from = 0;                                                    ///< node of a sensor or signal
  std::string port;
  int to = 0;
  std::string attribute;                                           ///< by which it is read
  bool by_default = false;                                         ///< the table says so, not the stack
};

struct StackGraph {
  std::string stack;
  std::vector<GraphNode> nodes;                        ///< sensors, signals, each level before what it holds, measures, recorders
  std::vector<GraphEdge> edges;
};

StackGraph graphOf(const Stack& stack);

/// For Graphviz.
std::string graphToDot(const StackGraph& graph);
/// A drawing by itself: no style sheet, script or program from elsewhere.
std::string graphToSvg(const StackGraph& graph);
/// {stack, nodes: [{id, kind, name, element, file, line, column, level?, used?, ports?}],
///  edges: [{from, port, type, unit, to, attribute, by_default}]}
nlohmann::ordered_json graphToJson(const StackGraph& graph);

}  // namespace tactus::dsl
