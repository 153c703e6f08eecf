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
#include "framework/control/level_controller.h"
#include "framework/control/measure.h"
#include "framework/control/observer.h"
#include "framework/control/readings.h"
#include "framework/control/sensor.h"
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

/// What a factory may look at while a stack is compiled, and no longer: what it keeps of robot and model, it copies.
class BuildContext {
 public:
  using PortLookup = std::function<const void*(const std::string& attribute, const std::string& reference,
                                               const std::string& port_type)>;
  using TaskMaker = std::function<std::unique_ptr<Task>(const std::string& element,
                                                        const std::map<std::string, std::string>& attributes)>;
  BuildContext(const ElementValues& values, const description::Robot& robot, const dynamics::Model& model,
               double control_period, PortLookup ports, TaskMaker tasks = {})
      : values(values),
        robot(robot),
        model(model),
        control_period(control_period),
        ports_(std::move(ports)),
        tasks_(std::move(tasks)) {}

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

  /// A task of another element, for controllers: as if the stack gave it these attributes.
  /// Throws ElementError where its values are wrong or it refuses them.
  std::unique_ptr<Task> task(const std::string& element, const std::map<std::string, std::string>& attributes) const;

 private:
  PortLookup ports_;
  TaskMaker tasks_;
};

/// What the factory of a sensor may look at.  A sensor reads no ports.
struct SensorContext : BuildContext {
  SensorContext(BuildContext context, const description::Scene& scene, std::uint64_t seed,
                std::vector<ReadingRow> before = {})
      : BuildContext(std::move(context)), scene(scene), seed(seed), before(std::move(before)) {}
  const description::Scene& scene;                                 ///< as the run's seed drew it
  std::uint64_t seed;                                              ///< its own, of the run's seed and its name
  std::vector<ReadingRow> before;                                  ///< of sensors before it: so felt.readings begin
};

/// What the factory of a measure may look at; ports are those of the controller's signals.
struct MeasureContext : BuildContext {
  using BackEndMaker = std::function<std::unique_ptr<BackEnd>()>;
  MeasureContext(BuildContext context, const Controller& controller, const description::Scene& scene,
                 const Eigen::VectorXd& start_q, BackEndMaker another_back_end = {})
      : BuildContext(std::move(context)), controller(controller), scene(scene), start_q(start_q),
        another_back_end(std::move(another_back_end)) {}
  const Controller& controller;                                    ///< before its first tick; outlives the measure
  const description::Scene& scene;                                 ///< as the run's seed drew it; outlives the measure
  const Eigen::VectorXd& start_q;                                  ///< dof, likewise drawn
  BackEndMaker another_back_end;                                   ///< like the controller's; null without a recipe
};

/// What the factory of a recorder may look at; ports are those of the controller's signals.
struct RecorderContext : BuildContext {
  RecorderContext(BuildContext context, const Controller& controller, std::string folder)
      : BuildContext(std::move(context)), controller(controller), folder(std::move(folder)) {}
  const Controller& controller;                                    ///< before its first tick; outlives the recorder
  std::string folder;                                              ///< of the run: files of a recorder go there
};

/// When a task or a level takes part (see ActiveWhen): `active`, `active-from`, `active-until`, `active-ramp`.
std::vector<AttributeRow> activityAttributes();

/// Throws, besides ElementError, std::invalid_argument.
using ShapeFactory = std::function<std::shared_ptr<const geometry::Shape>(const ElementValues&)>;
using SensorFactory = std::function<std::unique_ptr<Sensor>(const SensorContext&)>;
using TaskFactory = std::function<std::unique_ptr<Task>(const BuildContext&)>;
using SignalFactory = std::function<std::unique_ptr<Signal>(const BuildContext&)>;
using ControllerFactory = std::function<ControlledLevel(const BuildContext&)>;
using MeasureFactory = std::function<std::unique_ptr<Measure>(const MeasureContext&)>;
using RecorderFactory = std::function<std::unique_ptr<Observer>(const RecorderContext&)>;
/// Values are those of the back end's row.
using BackEndFactory = std::function<std::unique_ptr<BackEnd>(const ElementValues&)>;

/// Element rows with what makes them.  A plain value: a plugin registers into a copy, which replaces the
/// original only when all of it went well.
class Registry {
 public:
  void addStructure(ElementRow row);
  /// A solid that objects of the scene are made of; gets the attribute `pose` besides its own.
  void addShape(ElementRow row, ShapeFactory make);
  /// Sensors, signals, tasks, controllers, measures and recorders get the attributes `name` (required) and `class` besides their
  /// own, tasks also those of `activityAttributes`.
  void addSensor(ElementRow row, SensorFactory make);
  void addSignal(ElementRow row, SignalFactory make);
  void addTask(ElementRow row, TaskFactory make);
  /// A controller owns a whole level.
  void addController(ElementRow row, ControllerFactory make);
  void addMeasure(ElementRow row, MeasureFactory make);
  void addRecorder(ElementRow row, RecorderFactory make);
  void addBackEnd(ElementRow row, BackEndFactory make);

  const ElementTable& elements() const { return elements_; }
  /// By values.row().name, all of them.  A factory that makes nothing is an ElementError.
  std::shared_ptr<const geometry::Shape> makeShape(const ElementValues& values) const;
  std::unique_ptr<Sensor> makeSensor(const SensorContext& context) const;
  std::unique_ptr<Signal> makeSignal(const BuildContext& context) const;
  std::unique_ptr<Task> makeTask(const BuildContext& context) const;
  ControlledLevel makeController(const BuildContext& context) const;
  std::unique_ptr<Measure> makeMeasure(const MeasureContext& context) const;
  std::unique_ptr<Observer> makeRecorder(const RecorderContext& context) const;
  std::unique_ptr<BackEnd> makeBackEnd(const ElementValues& values) const;  ///< with its recipe
  std::vector<std::string> names(ElementKind kind) const;

 private:
  ElementTable elements_;
  std::map<std::string, ShapeFactory> shapes_;
  std::map<std::string, SensorFactory> sensors_;
  std::map<std::string, SignalFactory> signals_;
  std::map<std::string, TaskFactory> tasks_;
  std::map<std::string, ControllerFactory> controllers_;
  std::map<std::string, MeasureFactory> measures_;
  std::map<std::string, RecorderFactory> recorders_;
  std::map<std::string, BackEndFactory> back_ends_;
};

}  // namespace tactus::control
