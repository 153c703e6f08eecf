#include "dsl/fault_elements.h"

#include "framework/control/element_values.h"
#include "framework/description/faults.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ElementKind;
using control::ElementRow;
using control::formatNumber;
using control::InWorld;
using control::Presence;
using control::ValueType;

// Whose members' defaults are the language's.
const description::Window window;
const description::TorqueFault torque_fault;
const description::WrongMass wrong_mass;

/// A fault with its name, its own attributes, and when it strikes.
ElementRow faultRow(const std::string& name, const std::string& description, std::vector<AttributeRow> own) {
  ElementRow row{.name = name, .kind = ElementKind::structure, .description = description};
  row.attributes = {{.name = "name", .type = ValueType::identifier, .required = true,
                     .description = "The name under which messages, the log and run.json know it."}};
  for (AttributeRow& attribute : own) row.attributes.push_back(std::move(attribute));
  row.attributes.push_back({.name = "from", .type = ValueType::real, .unit = "s",
                            .default_text = formatNumber(window.from), .description = "When it begins.", .lower = 0});
  row.attributes.push_back({.name = "until", .type = ValueType::real, .unit = "s",
                            .description = "When it is over; not given: never.", .lower = 0});
  return row;
}

AttributeRow jointsRow(const std::string& description) {
  return {.name = "joints", .type = ValueType::joints, .default_text = "all", .description = description,
          .choices = {"all"}};
}

AttributeRow torquesOfRow() { return jointsRow("Whose torque goes wrong."); }

AttributeRow linkRow() { return {.name = "link", .type = ValueType::link, .description = "A link that can move."}; }

AttributeRow objectRow() {
  return {.name = "object", .type = ValueType::object, .description = "An object that is `free` or `held`."};
}

AttributeRow inBody(const std::string& name, const std::string& description) {
  return {.name = name, .type = ValueType::reals, .unit = "m", .description = description, .count = 3};
}

AttributeRow inWorld(const std::string& name, const std::string& unit, const std::string& description) {
  return {.name = name, .type = ValueType::reals, .unit = unit, .description = description, .count = 3,
          .in_world = InWorld::directions};
}

ElementRow faultsRow() {
  return {.name = "faults",
          .kind = ElementKind::structure,
          .description = "What goes wrong in a run, and when.  A <fault> here strikes what all sensors tell; torques "
                         "go through the faults of torque in this order.",
          .children = {{"torque-loss"}, {"torque-stuck"}, {"torque-delay"}, {"joint-friction"}, {"wrong-mass"},
                       {"shove"}, {"fault"}, {"include"}}};
}

ElementRow torqueLossRow() {
  return faultRow("torque-loss", "Drives give less torque than they are asked for, or none.",
                  {torquesOfRow(),
                   {.name = "factor", .type = ValueType::real, .unit = "1",
                    .default_text = formatNumber(torque_fault.factor),
                    .description = "Of the torque that is left; 0: the drive is dead.", .lower = 0, .upper = 1}});
}

ElementRow torqueStuckRow() {
  return faultRow("torque-stuck", "Drives go on with the torque that they gave last.", {torquesOfRow()});
}

ElementRow torqueDelayRow() {
  return faultRow("torque-delay", "Torques reach the joints late.",
                  {torquesOfRow(),
                   {.name = "delay", .type = ValueType::real, .unit = "s", .required = true,
                    .description = "A whole number of ticks.", .lower = 0, .upper = 1, .lower_open = true}});
}

ElementRow jointFrictionRow() {
  ElementRow row = faultRow(
      "joint-friction", "Joints rub as the controller's model does not know, besides what the robot's file says.",
      {jointsRow("Which of them."),
       {.name = "torque", .type = ValueType::real, .unit = "N m or N",
        .description = "Coulomb friction: what it takes to move the joint.", .lower = 0},
       {.name = "of-effort", .type = ValueType::real, .unit = "1",
        .description = "The same, as a part of each joint's effort limit.", .lower = 0, .upper = 1}});
  row.presence = {{Presence::one_of, {"torque", "of-effort"}}};
  return row;
}

ElementRow wrongMassRow() {
  ElementRow row = faultRow(
      "wrong-mass", "Links or an object weigh other than they are described, and than the controller's model knows.",
      {linkRow(),
       {.name = "links", .type = ValueType::links,
        .description = "Instead: links and groups of links; what cannot move stays as it is.", .choices = {"all"}},
       objectRow(),
       {.name = "factor", .type = ValueType::real, .unit = "1", .default_text = formatNumber(wrong_mass.factor),
        .description = "Of its mass and inertia.", .lower = 0, .lower_open = true},
       {.name = "added", .type = ValueType::real, .unit = "kg", .default_text = formatNumber(wrong_mass.added),
        .description = "A point mass that is fixed to it: a load.", .lower = 0},
       inBody("point", "Where that is, in the frame of the link or object; not given: at the centre of mass.")});
  row.presence = {{Presence::one_of, {"link", "links", "object"}},
                  {Presence::any_of, {"factor", "added"}},
                  {Presence::exclusive, {"links", "added"}},
                  {Presence::needs, {"point", "added"}}};
  return row;
}

ElementRow shoveRow() {
  ElementRow row = faultRow(
      "shove", "Somebody pushes a link or an object.",
      {linkRow(), objectRow(), inWorld("force", "N", "Along the world's axes."),
       inWorld("moment", "N m", "About the world's axes, besides that of the force."),
       inWorld("impulse", "N s", "Instead of a force: given evenly from `from` until `until`."),
       inBody("point", "Where it acts, in the frame of the link or object; not given: at the centre of mass.")});
  row.presence = {{Presence::one_of, {"link", "object"}},
                  {Presence::any_of, {"force", "moment", "impulse"}},
                  {Presence::exclusive, {"force", "impulse"}},
                  {Presence::needs, {"impulse", "until"}}};
  return row;
}

}  // namespace

void addFaultElements(control::Registry& registry) {
  for (ElementRow row : {faultsRow(), torqueLossRow(), torqueStuckRow(), torqueDelayRow(), jointFrictionRow(),
                         wrongMassRow(), shoveRow()})
    registry.addStructure(std::move(row));
}

}  // namespace tactus::dsl
