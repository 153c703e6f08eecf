#pragma once

#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/control/back_end.h"
#include "framework/control/contact_set.h"
#include "framework/control/element_table.h"
#include "framework/control/element_values.h"
#include "framework/control/signal.h"
#include "framework/control/task.h"
#include "framework/description/robot.h"
#include "framework/description/scene.h"
#include "framework/dynamics/model.h"

namespace tactus::control {

/// A value that only the factory could judge to be wrong; becomes a diagnostic at the attribute.
class ElementError : public std::runtime_error {
 public:
  ElementError(std::string attribute, const std::string& message, std::vector<std::string> candidates = {})
      : std::runtime_error(message), attribute(std::move(attribute)), candidates(std::move(candidates)) {}
  /// At an attribute of an element inside; "" = at that element as a whole.
  ElementError(const ElementValues& child, std::string attribute, const std::string& message,
               std::vector<std::string> candidates = {});

  std::string attribute;                                           ///< "" = the element as a whole
  std::vector<std::string> candidates;                             ///< valid names, for the nearest one
  description::Place place;                                        ///< of what is wrong inside; line 0 = see `attribute`
  std::string text;                                                ///< that stands there
};

/// What a factory may look at while a stack is compiled.
class BuildContext {
 public:
  using PortLookup = std::function<const void*(const std::string& attribute, const std::string& reference,
                                               const std::string& port_type)>;
  BuildContext(const ElementValues& values, const description::Robot& robot, const dynamics::Model& model,
               double control_period, PortLookup ports)
      : values(values), robot(robot), model(model), control_period(control_period), ports_(std::move(ports)) {}

  const ElementValues& values;
  const description::Robot& robot;
  const dynamics::Model& model;
  double control_period;                                           ///< s

  /// The signal output that the attribute names; throws ElementError when there is none or its type is another.
  template <class T>
  const T& port(const std::string& attribute) const {
    return *static_cast<const T*>(ports_(attribute, values.text(attribute), PortType<T>::name));
  }
  /// The same of an element inside.
  template <class T>
  const T& port(const ElementValues& child, const std::string& attribute) const {
    try {
      return *static_cast<const T*>(ports_(attribute, child.text(attribute), PortType<T>::name));
    } catch (const ElementError& error) {
      throw ElementError(child, attribute, error.what(), error.candidates);
    }
  }
  /// Index into Model::frames() of the link that the attribute names.
  int frame(const std::string& attribute) const;
  /// Frames of links and link groups, in link order, each once.  Words among the row's `choices` add none, here
  /// and in `joints`: they are the element's own.
  std::vector<int> frames(const std::string& attribute) const;
  /// Indices into q of joints and joint groups, rising, each once.
  std::vector<int> joints(const std::string& attribute) const;

 private:
  PortLookup ports_;
};

/// When a task or a level takes part (see ActiveWhen): `active`, `active-from`, `active-until`, `active-ramp`.
std::vector<AttributeRow> activityAttributes();

using TaskFactory = std::function<std::unique_ptr<Task>(const BuildContext&)>;
using SignalFactory = std::function<std::unique_ptr<Signal>(const BuildContext&)>;
/// Values are those of the back end's row.
using BackEndFactory = std::function<std::unique_ptr<BackEnd>(const ElementValues&)>;

/// Element rows with what makes them.  A plain value: a plugin registers into a copy, which replaces the
/// original only when all of it went well.
class Registry {
 public:
  void addStructure(ElementRow row);
  /// Tasks and signals get the attributes `name` (required) and `class` besides their own, tasks also those of
  /// `activityAttributes`.
  void addTask(ElementRow row, TaskFactory make);
  void addSignal(ElementRow row, SignalFactory make);
  void addBackEnd(ElementRow row, BackEndFactory make);

  const ElementTable& elements() const { return elements_; }
  std::unique_ptr<Task> makeTask(const BuildContext& context) const;      ///< by context.values.row().name
  std::unique_ptr<Signal> makeSignal(const BuildContext& context) const;
  std::unique_ptr<BackEnd> makeBackEnd(const ElementValues& values) const;  ///< with its recipe
  std::vector<std::string> names(ElementKind kind) const;

 private:
  ElementTable elements_;
  std::map<std::string, TaskFactory> tasks_;
  std::map<std::string, SignalFactory> signals_;
  std::map<std::string, BackEndFactory> back_ends_;
};

}  // namespace tactus::control
