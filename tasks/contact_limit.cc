#include "tasks/contact_limit.h"

#include <algorithm>

#include "framework/control/displacement.h"

namespace tactus::tasks {

using namespace control;

void ContactLimit::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "contact-limit";
  row.kind = ElementKind::task;
  row.description = "Undesired contacts may break but are not pressed harder; above max-force they are backed off.";
  row.source = "thesis 4.2.9";
  row.attributes = {
      {.name = "on", .type = ValueType::port, .required = true, .description = "The contacts, e.g. touch.undesired.",
       .port_type = "contact-set"},
      {.name = "max-force", .type = ValueType::real, .unit = "N",
       .description = "Measured force above which the contact is backed off; not given: never.", .lower = 0},
      {.name = "feedback", .type = ValueType::real, .unit = "1", .default_text = "2",
       .description = "Gain of the backing off.", .lower = 0},
      {.name = "feedback-filter", .type = ValueType::real, .unit = "s", .default_text = "0.01",
       .description = "Time constant of the filter on the measured excess.", .lower = 0},
      {.name = "back-off-limit", .type = ValueType::real, .unit = "N", .default_text = "5",
       .description = "Greatest force of the backing off.", .lower = 0},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<ContactLimit>(context); });
}

ContactLimit::ContactLimit(const BuildContext& context)
    : Task(Relation::inequality, context.port<ContactSet>("on").capacity),
      contacts_(context.port<ContactSet>("on")),
      feedback_(context.values.real("feedback")),
      back_off_limit_(context.values.real("back-off-limit")),
      excess_(context.values.has("max-force") ? context.values.real("max-force") : description::infinity,
              context.values.real("feedback-filter"), context.model.frames().size(), contacts_) {}

void ContactLimit::doUpdate(const Tick& tick, TickTask& rows) {
  excess_.beginTick();
  rows.rows = static_cast<int>(contacts_.contacts.size());
  error_ = 0;
  for (int i = 0; i < rows.rows; ++i) {
    const Contact& contact = contacts_.contacts[i];
    const double excess = excess_.measure(contact, tick.dt);
    tick.robot.directionJacobian(contact.frame, contact.point_W, contact.normal_W, rows.jacobian.row(i));
    rows.force[i] = -std::min(feedback_ * excess, back_off_limit_);
    error_ = std::max(error_, contact.force_N);
  }
  excess_.endTick();
}

void ContactLimit::doArchive(Archive& archive) {
  archive("excess", excess_);
}

bool ContactLimit::displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                                Eigen::Ref<Eigen::VectorXd> dx) const {
  for (std::size_t i = 0; i < contacts_.contacts.size(); ++i) {
    const Contact& contact = contacts_.contacts[i];
    dx[i] = contact.normal_W.dot(pointDisplacement(from, to, contact.frame, contact.point_W));
  }
  return true;
}

}  // namespace tactus::tasks
