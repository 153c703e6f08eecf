#include "dsl/fault_elements.h"
#include "dsl/read_stack.h"
#include "dsl/shape_elements.h"
#include "framework/control/controller.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ElementKind;
using control::ElementRow;
using control::formatNumber;
using control::ValueType;

// Whose members' defaults are the language's.
const control::ControllerOptions controller_options;
const description::ContactMaterial material;
const description::Holder holder;
const RunOptions run_options;

const AttributeRow class_of_object{
    .name = "class",
    .type = ValueType::element_class,
    .description = "The <defaults> class whose values this object takes where it gives none."};

ElementRow stackRow() {
  return {.name = "stack",
          .kind = ElementKind::structure,
          .description =
              "A robot, a scene, signals, and tasks in levels of priority: everything that one controller is made of.",
          .attributes = {{.name = "format",
                          .type = ValueType::integer,
                          .required = true,
                          .description = "The version of the language; this one is 1."},
                         {.name = "name",
                          .type = ValueType::identifier,
                          .description = "The name that runs are filed under; not given: that of the file."}},
          .children = {{"parameter"},
                       {"include"},
                       {"defaults"},
                       {"plugin"},
                       {"robot", 1, 1},
                       {"scene", 0, 1},
                       {"sensors"},
                       {"faults"},
                       {"signals"},
                       {"level", 1},
                       {"controller", 1, 1},
                       {"run", 0, 1}}};
}

ElementRow parameterRow() {
  return {.name = "parameter",
          .kind = ElementKind::structure,
          .description = "A value with a name, put into other attributes by ${name}; --set name=value replaces it.",
          .attributes = {
              {.name = "name", .type = ValueType::identifier, .required = true, .description = "Its name."},
              {.name = "value", .type = ValueType::text, .required = true, .description = "Taken as written."},
              {.name = "unit", .type = ValueType::text, .description = "For the reader; nothing is converted."}}};
}

ElementRow includeRow() {
  return {
      .name = "include",
      .kind = ElementKind::structure,
      .description =
          "Stands for what the file holds.  That file has the same element outermost as the one around the include.",
      .attributes = {{.name = "file",
                      .type = ValueType::file,
                      .required = true,
                      .description = "Relative to the folder of the file in which the include stands."}}};
}

ElementRow defaultsRow() {
  return {.name = "defaults",
          .kind = ElementKind::structure,
          .description = "Values for elements that name this class: each child gives them for its kind of element.",
          .attributes = {{.name = "class", .type = ValueType::identifier, .required = true, .description = "Its name."},
                         {.name = "base", .type = ValueType::element_class,
                          .description = "A class whose values hold where this one gives none."}},
          .children = {{"@task"}, {"@controller"}, {"@signal"}, {"@sensor"}, {"object"}}};
}

ElementRow pluginRow() {
  return {.name = "plugin",
          .kind = ElementKind::structure,
          .description = "Loads the elements of a plugin, found by its name and never by a path.",
          .attributes = {{.name = "name", .type = ValueType::text, .required = true, .description = "Its name."}}};
}

ElementRow robotRow() {
  return {.name = "robot",
          .kind = ElementKind::structure,
          .description = "The robot that is controlled.",
          .attributes = {{.name = "model", .type = ValueType::file, .required = true,
                          .description = "A model by its name, or a URDF file relative to this one."},
                         {.name = "self-contact", .type = ValueType::links, .default_text = "none",
                          .description = "Links that touch each other: `none` pass through, of `all` or of those named "
                                         "each feels the others, but not its neighbours, nor what it overlaps at the "
                                         "start; `tactus explain` lists these.",
                          .choices = {"none", "all"}}},
          .children = {{"start", 0, 1}}};
}

ElementRow startRow() {
  return {.name = "start",
          .kind = ElementKind::structure,
          .description = "Where the joints are at time 0; not given: 0, or the nearest value inside the limits.",
          .attributes = {{.name = "q", .type = ValueType::reals, .unit = "rad or m", .required = true,
                          .description = "One value for each moving joint, in the order of the model."},
                         {.name = "jitter", .type = ValueType::reals, .unit = "rad or m", .default_text = "0",
                          .description = "Each joint starts off by a uniform draw from ± this, drawn from the seed and "
                                         "kept within its limits; one number for all joints, or one for each."},
                         {.name = "frame", .type = ValueType::link,
                          .description = "The link that `frame-jitter` moves."},
                         {.name = "frame-jitter", .type = ValueType::reals, .unit = "m and rad",
                          .default_text = "0 0 0 0 0 0",
                          .description = "`frame` starts off by a uniform draw from ± this, x y z and turns about the axes "
                                         "of the world, drawn from the seed; joints near `q` that bring it there as "
                                         "nearly as they can.",
                          .count = 6}}};
}

ElementRow sceneRow() {
  return {.name = "scene",
          .kind = ElementKind::structure,
          .description = "The world around the robot.",
          .attributes = {{.name = "gravity", .type = ValueType::reals, .unit = "m/s²", .default_text = "0 0 -9.81",
                          .description = "In the world frame, z up.", .count = 3}},
          .children = {{"object"}, {"pair"}, {"include"}}};
}

ElementRow pairRow() {
  return {.name = "pair",
          .kind = ElementKind::structure,
          .description = "What holds where two bodies touch, instead of the usual rule; what is not said is still by "
                         "that rule, or by a pair that names the two less closely.",
          .attributes = {{.name = "between", .type = ValueType::text, .required = true,
                          .description = "Two names: objects, `robot`, links or groups of links.  Of several pairs for "
                                         "the same two, a link or object counts before a group, a group before "
                                         "`robot`."},
                         {.name = "stiffness", .type = ValueType::real, .unit = "N/m",
                          .description = "Of both surfaces together.", .lower = 0, .lower_open = true},
                         {.name = "dissipation", .type = ValueType::real, .unit = "s/m",
                          .description = "Of the Hunt–Crossley normal force.", .lower = 0},
                         {.name = "friction", .type = ValueType::real, .unit = "1",
                          .description = "Coulomb coefficient μ.", .lower = 0},
                         {.name = "rolling", .type = ValueType::real, .unit = "m",
                          .description = "ρ, as for an object.", .lower = 0}},
          .presence = {{control::Presence::any_of, {"stiffness", "dissipation", "friction", "rolling"}}}};
}

ElementRow objectRow() {
  return {.name = "object",
          .kind = ElementKind::structure,
          .description = "An object: the union of its shapes.",
          .attributes = {{.name = "name", .type = ValueType::identifier, .required = true,
                          .description = "The name under which references, messages and the log know it."},
                         class_of_object,
                         {.name = "pose", .type = ValueType::reals, .unit = "m, rad", .default_text = "0 0 0",
                          .description = "x y z, or x y z roll pitch yaw (fixed axes), in the world or, with `on`, "
                                         "from the middle of the carrier's top."},
                         {.name = "on", .type = ValueType::object,
                          .description = "The object that carries it: it moves along with that one's jitter."},
                         {.name = "jitter", .type = ValueType::reals, .unit = "m", .default_text = "0 0 0",
                          .description = "Each coordinate moves by a uniform draw from ± this, drawn from the seed.",
                          .lower = 0, .count = 3},
                         {.name = "stiffness", .type = ValueType::real, .unit = "N/m",
                          .default_text = formatNumber(material.stiffness),
                          .description = "Of the Hunt–Crossley normal force.", .lower = 0, .lower_open = true},
                         {.name = "dissipation", .type = ValueType::real, .unit = "s/m",
                          .default_text = formatNumber(material.dissipation),
                          .description = "Of the Hunt–Crossley normal force.", .lower = 0},
                         {.name = "friction", .type = ValueType::real, .unit = "1",
                          .default_text = formatNumber(material.friction),
                          .description = "Coulomb coefficient μ.", .lower = 0},
                         {.name = "rolling", .type = ValueType::real, .unit = "m",
                          .default_text = formatNumber(material.rolling),
                          .description = "ρ: a torque of up to ρ times the normal force resists rolling and spinning; "
                                         "0.0001 to 0.001 for hard things.",
                          .lower = 0},
                         {.name = "mobility", .type = ValueType::choice, .default_text = "fixed",
                          .description = "What decides where it is: `fixed`, its pose; `free`, the forces on it; `held`, "
                                         "these and a spring and damper to its path; `moved`, its path alone, whatever "
                                         "touches it.",
                          .choices = {"fixed", "free", "held", "moved"}},
                         {.name = "mass", .type = ValueType::real, .unit = "kg",
                          .description = "Of a free or held one.", .lower = 0, .lower_open = true},
                         {.name = "inertia", .type = ValueType::reals, .unit = "kg m²",
                          .description = "About the centre of mass, along the object's axes; not given: that of a solid "
                                         "of one density, as is the centre.",
                          .lower = 0, .lower_open = true, .count = 3},
                         {.name = "centre", .type = ValueType::reals, .unit = "m",
                          .description = "Of mass, in the object.", .count = 3},
                         {.name = "hold-stiffness", .type = ValueType::real, .unit = "N/m",
                          .default_text = formatNumber(holder.stiffness),
                          .description = "Of the spring that holds it.", .lower = 0},
                         {.name = "hold-damping", .type = ValueType::real, .unit = "N s/m",
                          .default_text = formatNumber(holder.damping),
                          .description = "Of the damper, against the path's speed.", .lower = 0},
                         {.name = "hold-rotation-stiffness", .type = ValueType::real, .unit = "N m/rad",
                          .default_text = formatNumber(holder.rotation_stiffness),
                          .description = "Of the spring that holds it upright.", .lower = 0},
                         {.name = "hold-rotation-damping", .type = ValueType::real, .unit = "N m s/rad",
                          .default_text = formatNumber(holder.rotation_damping),
                          .description = "Of the damper, against the path's turning.", .lower = 0},
                         {.name = "hold-until", .type = ValueType::real, .unit = "s",
                          .description = "When a held one is let go, and is free from then on; not given: never.",
                          .lower = 0, .lower_open = true}},
          .children = {{"@shape", 1}, {"at"}},
          .presence = {{control::Presence::together, {"inertia", "centre"}}, {control::Presence::needs, {"inertia", "mass"}}}};
}

ElementRow atRow() {
  return {.name = "at",
          .kind = ElementKind::structure,
          .description = "Where the path of a held or moved object leads: it is at rest there, goes straight to the next "
                         "one, smoothly, and stays at the last.",
          .attributes = {{.name = "time", .type = ValueType::real, .unit = "s", .required = true,
                          .description = "They rise; before the first it goes from its pose at time 0.", .lower = 0,
                          .lower_open = true},
                         {.name = "by", .type = ValueType::reals, .unit = "m, rad", .required = true,
                          .description = "From its pose at time 0: x y z, or x y z roll pitch yaw, along and about the "
                                         "world's axes."}}};
}

ElementRow sensorsRow() {
  return {.name = "sensors",
          .kind = ElementKind::structure,
          .description = "What stands between the plant and the controller, in this order; without any, the controller "
                         "feels what there is.  Read as sensor.port.",
          .children = {{"@sensor"}, {"include"}}};
}

ElementRow signalsRow() {
  return {.name = "signals",
          .kind = ElementKind::structure,
          .description = "Named sources of values that tasks and other signals read as signal.port, in any order.",
          .children = {{"@signal"}, {"include"}}};
}

ElementRow levelRow() {
  ElementRow row{.name = "level",
               .kind = ElementKind::structure,
               .description = "Tasks of one priority, or one controller that owns the level.  Lower levels must not disturb those "
                              "above.",
               .attributes = {{.name = "priority",
                               .type = ValueType::integer,
                               .required = true,
                               .description = "1 is the highest; the levels of a stack rise strictly.",
                               .lower = 1},
                              {.name = "weight",
                               .type = ValueType::real,
                               .unit = "1",
                               .description = "For weighted back ends; not given: by their ratio.",
                               .lower = 0,
                               .lower_open = true},
                              {.name = "strict",
                               .type = ValueType::flag,
                               .default_text = "false",
                               .description = "Refuse back ends that would only weigh this level against others."}},
               .children = {{"@task"}, {"@controller", 0, 1}, {"include"}}};
  for (AttributeRow& attribute : control::activityAttributes()) row.attributes.push_back(std::move(attribute));
  return row;
}

ElementRow controllerRow() {
  return {.name = "controller",
          .kind = ElementKind::structure,
          .description = "The back end that solves every tick, with that back end's own options as further attributes.",
          .attributes = {{.name = "backend", .type = ValueType::text, .required = true, .description = "Its name."},
                         {.name = "rate", .type = ValueType::real, .unit = "Hz", .default_text = "1000",
                          .description = "Ticks per second; a tick is a whole number of the plant's steps.",
                          .lower = 1},
                         {.name = "torque-rate", .type = ValueType::real, .unit = "1/s",
                          .description = "The most that a joint's torque changes in a second, as a multiple of its "
                                         "effort limit; not given: without bound.",
                          .lower = 0, .lower_open = true},
                         {.name = "ramp", .type = ValueType::real, .unit = "s",
                          .default_text = formatNumber(controller_options.ramp),
                          .description = "Time in which the torque goes over where something is switched.",
                          .lower = 0},
                         {.name = "hold", .type = ValueType::real, .unit = "s",
                          .default_text = formatNumber(controller_options.hold),
                          .description = "Time that the last good value of a joint, or the last solved torque, stands "
                                         "in where there is none; then the robot's weight is borne.",
                          .lower = 0},
                         {.name = "on-fault", .type = ValueType::choice, .default_text = "fall-back",
                          .description = "A task, signal or controller that throws, or a task whose numbers are none: "
                                         "`fall-back` ends the run or bears the weight instead, `switch-off` goes on "
                                         "without it and what reads it, `end` ends the run.",
                          .choices = {"fall-back", "switch-off", "end"}},
                         {.name = "deadline-iterations", .type = ValueType::integer, .unit = "1",
                          .description = "Iterations that the back end may take for a tick; not given: any number.",
                          .lower = 1},
                         {.name = "torque-limits-priority", .type = ValueType::integer,
                          .description = "Level at which the actuators' limits stand, above its tasks; not given: above "
                                         "all levels. Back ends with strict levels and limits alone (hqp).",
                          .lower = 1},
                         {.name = "deadline-us", .type = ValueType::real, .unit = "µs",
                          .description = "Wall-clock time that the back end may take for a tick; runs then need not "
                                         "repeat. Not given: any time.",
                          .lower = 0, .lower_open = true}},
          .children = {{"alternative"}},
          .takes_back_end_options = true};
}

ElementRow alternativeRow() {
  return {.name = "alternative",
          .kind = ElementKind::structure,
          .description =
              "Options of another back end, as further attributes: they hold where --backend or compare puts it in the "
              "controller's place.",
          .attributes = {{.name = "backend", .type = ValueType::text, .required = true, .description = "Its name."}},
          .takes_back_end_options = true};
}

ElementRow runRow() {
  return {.name = "run",
          .kind = ElementKind::structure,
          .description = "What `tactus run` does when it is not told otherwise.",
          .attributes = {{.name = "duration", .type = ValueType::real, .unit = "s",
                          .default_text = formatNumber(run_options.duration),
                          .description = "Simulated time, at least one tick.", .lower = 0, .upper = longest_run,
                          .lower_open = true},
                         {.name = "seed", .type = ValueType::integer, .default_text = std::to_string(run_options.seed),
                          .description = "Of every draw; 0 draws no jitter.", .lower = 0},
                         {.name = "count-while", .type = ValueType::port,
                          .description = "Figures of contacts count what happens while this number is above 0.5, and "
                                         "nothing else; not given: all from the first touch on.",
                          .port_type = "scalar"}},
          .children = {{"record", 0, 1}, {"@measure"}, {"@recorder"}, {"target"}}};
}

ElementRow targetRow() {
  return {.name = "target",
          .kind = ElementKind::structure,
          .description = "What a figure of the run should reach: the summary and the report say whether it was met.",
          .attributes = {{.name = "metric", .type = ValueType::text, .required = true,
                          .description = "A key of `metrics` in run.json, such as contact_force_mean_N."},
                         {.name = "lower", .type = ValueType::real, .description = "Least value; one bound at least."},
                         {.name = "upper", .type = ValueType::real, .description = "Greatest value."}},
          .presence = {{control::Presence::any_of, {"lower", "upper"}}}};
}

ElementRow recordRow() {
  return {.name = "record",
          .kind = ElementKind::structure,
          .description = "What goes into log.csv.",
          .attributes = {{.name = "columns", .type = ValueType::choice, .default_text = run_options.columns,
                          .description = "`all` adds every joint.", .choices = {"default", "all"}},
                         {.name = "rate", .type = ValueType::real, .unit = "Hz",
                          .default_text = formatNumber(run_options.record_rate),
                          .description = "Rows per simulated second.", .lower = 0, .lower_open = true}}};
}

}  // namespace

void addStructureElements(control::Registry& registry) {
  for (ElementRow row : {stackRow(), parameterRow(), includeRow(), defaultsRow(), pluginRow(), robotRow(), startRow(),
                         sceneRow(), pairRow(), objectRow(), atRow(), sensorsRow(), signalsRow(), levelRow(),
                         controllerRow(), alternativeRow(), runRow(), recordRow(), targetRow()})
    registry.addStructure(std::move(row));
  addFaultElements(registry);
  addShapeElements(registry);
}

}  // namespace tactus::dsl
