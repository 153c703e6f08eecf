#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/control/element_values.h"
#include "framework/description/faults.h"
#include "framework/description/robot.h"
#include "framework/description/scene.h"
#include "framework/dynamics/self_contact.h"

namespace tactus::dsl {

/// An element that a factory will turn into a task, a signal, ….
struct ElementInstance {
  control::ElementValues values;                                   ///< values.row().name is the element
  std::string name;
  description::Place place;                                        ///< of its '<'
  std::string path;
};

struct LevelDescription {
  ElementInstance element;                                         ///< its attributes, and where it stands
  int priority = 1;
  std::optional<double> weight;
  bool strict = false;
  std::vector<ElementInstance> tasks;                              ///< none where a controller owns the level
  std::optional<ElementInstance> controller;
  description::Place strict_place;                                 ///< of the value of `strict`, where it is written
};

/// `jitter` of an object: each coordinate moves by a uniform draw from ±jitter (m), drawn from the run's seed.
struct ObjectDescription {
  description::Object object;                                      ///< pose without jitter, `on` resolved
  Eigen::Vector3d jitter = Eigen::Vector3d::Zero();
  std::string on;                                     ///< the object that carries it, whose jitter it shares; "" = none
  control::ElementValues values;                                   ///< as read; `pose` is that in the carrier's top
  std::vector<control::ElementValues> shapes;                      ///< of object.primitives, as read
};

/// `jitter` of the start: uniform draws from ± these, drawn from the run's seed.
struct StartJitter {
  Eigen::VectorXd joints;                                          ///< dof, rad or m
  int link = -1;                                                   ///< index into Robot::links; -1 = none
  Eigen::Matrix<double, 6, 1> pose = Eigen::Matrix<double, 6, 1>::Zero();  ///< x y z (m), turns (rad), world axes
};

/// A <pair> of the scene: what it says, for each two that it names.
struct PairDescription {
  std::vector<description::ContactPair> pairs;
  /// How closely it names them: 0 the robot, 1 a group of links, 2 a link or an object, both ends added.
  int closeness = 0;
  control::ElementValues values;                                   ///< as read
};

/// An element as it was read, after includes, parameters, classes and defaults.
struct ResolvedElement {
  control::ElementValues values;                                   ///< each with its origin; `row().name` is the element
  control::ElementValues options;                                  ///< of the back end that `backend` names; else empty
  description::Place place;                                        ///< of its '<'
  std::string path;                                                ///< "/stack/level[@priority=1]/impedance[@name=hand]"
  int depth = 0;                                                   ///< 0 = <stack>
};

/// What a figure of the run should reach; at least one bound.
struct TargetDescription {
  std::string metric;
  std::optional<double> lower;
  std::optional<double> upper;
};

struct RunOptions {
  double duration = 10;                                            ///< s
  std::uint64_t seed = 1;
  std::string count_while;                                         ///< a scalar port, "signal.port"; "" = always
  std::string columns = "default";                                 ///< "default" | "all"
  double record_rate = 100;                                        ///< Hz, rows of log.csv
  std::vector<TargetDescription> targets;
  std::vector<ElementInstance> measures;
  std::vector<ElementInstance> recorders;
};

/// A stack, read and checked, nothing built yet.
struct Stack {
  std::string name;
  std::string file;
  std::vector<std::string> plugins;                                ///< named by <plugin>
  description::Robot robot;
  std::string robot_model;                                         ///< as written
  std::string robot_file;                                          ///< where it was found
  Eigen::VectorXd start_q;                                         ///< dof, without jitter
  StartJitter start_jitter;
  std::string self_contact = "none";                               ///< as written: which links touch each other
  dynamics::SelfContact self_contacts;                             ///< what comes of it
  std::vector<ObjectDescription> objects;
  std::vector<PairDescription> pairs;                              ///< as written
  Eigen::Vector3d gravity = Eigen::Vector3d(0, 0, -9.81);
  std::vector<ElementInstance> sensors;                            ///< those among the faults last
  description::Faults faults;                                      ///< of drives and bodies
  std::vector<ElementInstance> fault_elements;                     ///< these, as read
  std::vector<ElementInstance> signals;
  std::vector<LevelDescription> levels;
  ElementInstance controller;                                      ///< base attributes: backend, rate
  control::ElementValues back_end;                                 ///< the options of the chosen back end
  std::vector<control::ElementValues> alternatives;                ///< the options given for other back ends
  RunOptions run;
  std::vector<ResolvedElement> elements;                           ///< all but classes and includes, in document order
  std::map<std::string, std::string> files;                    ///< every file read → its content, for hashes and copies
  /// Every file that another one brought in → the places that did, innermost first.
  std::map<std::string, std::vector<description::Place>> included_from;

  /// What has ports: sensors, then signals.
  std::vector<const ElementInstance*> sources() const;
  /// Null when there is no such sensor or signal.
  const ElementInstance* source(std::string_view name) const;
  /// The scene with jitter drawn from the seed; the same seed gives the same scene on every machine.
  description::Scene scene(std::uint64_t seed) const;
  /// Where the joints start, with jitter drawn from the seed, within their limits.  A link that joints cannot bring to
  /// where it was drawn starts as near as they bring it.
  Eigen::VectorXd start(std::uint64_t seed) const;
};

}  // namespace tactus::dsl
