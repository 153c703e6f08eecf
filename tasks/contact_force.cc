#include "tasks/contact_force.h"

#include <algorithm>
#include <cmath>

#include "framework/control/displacement.h"

namespace tactus::tasks {

using namespace control;

void ContactForce::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "contact-force";
  row.kind = ElementKind::task;
  row.description = "Keeps a light normal force at each contact of a set.";
  row.source = "thesis 4.3.2";
  row.attributes = {
      {.name = "on", .type = ValueType::port, .required = true, .description = "The contacts, e.g. touch.held.",
       .port_type = "contact-set"},
      {.name = "force", .type = ValueType::real, .unit = "N", .default_text = "0.5",
       .description = "Normal force f_n wanted at each contact.", .lower = 0},
      {.name = "feedback", .type = ValueType::real, .unit = "1", .default_text = "0",
       .description = "Gain k_f of the one-sided feedback; 0 is the thesis's open loop.", .lower = 0},
      {.name = "feedback-threshold", .type = ValueType::real, .unit = "N", .default_text = "1",
       .description = "Measured force above which the feedback backs off.", .lower = 0},
      {.name = "feedback-filter", .type = ValueType::real, .unit = "s", .default_text = "0.01",
       .description = "Time constant of the filter on the measured excess.", .lower = 0},
      {.name = "min-force", .type = ValueType::real, .unit = "N", .default_text = "-3",
       .description = "The feedback takes the reference no lower than this."},
      {.name = "force-max", .type = ValueType::real, .unit = "N",
       .description = "Most force of a contact, for back ends that bound forces; not given: none.", .lower = 0},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<ContactForce>(context); });
}

ContactForce::ContactForce(const BuildContext& context)
    : Task(Relation::equality, context.port<ContactSet>("on").capacity, true),
      contacts_(context.port<ContactSet>("on")),
      force_(context.values.real("force")),
      feedback_(context.values.real("feedback")),
      min_force_(context.values.real("min-force")),
      excess_(context.values.real("feedback-threshold"), context.values.real("feedback-filter"),
              context.model.frames().size()) {
  if (context.values.has("force-max")) force_max_ = context.values.real("force-max");
  if (min_force_ > force_) throw ElementError("min-force", "min-force must not be greater than force");
}

void ContactForce::doUpdate(const Tick& tick, TickTask& rows) {
  excess_.beginTick();
  rows.rows = static_cast<int>(contacts_.contacts.size());
  rows.force_max = force_max_;
  lowest_reference_ = force_;
  error_ = 0;
  for (int i = 0; i < rows.rows; ++i) {
    const Contact& contact = contacts_.contacts[i];
    const double excess = excess_.measure(contact.frame, contact.force_N, tick.dt);
    tick.robot.directionJacobian(contact.frame, contact.point_W, contact.normal_W, rows.jacobian.row(i));
    rows.force[i] = std::max(force_ - feedback_ * excess, min_force_);
    lowest_reference_ = std::min(lowest_reference_, rows.force[i]);
    error_ = std::max(error_, std::abs(contact.force_N - force_));
  }
  excess_.endTick();
}

bool ContactForce::displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                                Eigen::Ref<Eigen::VectorXd> dx) const {
  for (std::size_t i = 0; i < contacts_.contacts.size(); ++i) {
    const Contact& contact = contacts_.contacts[i];
    dx[i] = contact.normal_W.dot(pointDisplacement(from, to, contact.frame, contact.point_W));
  }
  return true;
}

void ContactForce::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"lowest_reference_N", &lowest_reference_});
}

}  // namespace tactus::tasks
