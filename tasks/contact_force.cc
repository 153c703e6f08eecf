#include "tasks/contact_force.h"

#include <algorithm>
#include <cmath>

#include "framework/control/displacement.h"

namespace tactus::tasks {

using namespace control;

namespace {

/// Two directions that with the normal are orthonormal.
struct Tangents {
  explicit Tangents(const Eigen::Vector3d& normal_W)
      : first_W(normal_W.cross(std::abs(normal_W.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY()).normalized()),
        second_W(normal_W.cross(first_W)) {}
  Eigen::Vector3d first_W, second_W;
};

}  // namespace

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
      {.name = "friction", .type = ValueType::real, .unit = "1",
       .description = "μ: the contact does not slide, and its force stays in the cone, for back ends that honour cones; "
                      "not given: only its normal is held.",
       .lower = 0, .lower_open = true},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<ContactForce>(context); });
}

ContactForce::ContactForce(const BuildContext& context)
    : Task(Relation::equality, (context.values.has("friction") ? 3 : 1) * context.port<ContactSet>("on").capacity, true),
      contacts_(context.port<ContactSet>("on")),
      force_(context.values.real("force")),
      feedback_(context.values.real("feedback")),
      min_force_(context.values.real("min-force")),
      excess_(context.values.real("feedback-threshold"), context.values.real("feedback-filter"),
              context.model.frames().size(), contacts_) {
  if (context.values.has("force-max")) force_max_ = context.values.real("force-max");
  if (context.values.has("friction")) friction_ = context.values.real("friction");
  if (min_force_ > force_) throw ElementError("min-force", "min-force must not be greater than force");
}

void ContactForce::doUpdate(const Tick& tick, TickTask& rows) {
  excess_.beginTick();
  const int count = static_cast<int>(contacts_.contacts.size());
  rows.rows = rowsPerContact() * count;
  rows.force_max = force_max_;
  rows.friction = friction_;
  lowest_reference_ = force_;
  error_ = 0;
  for (int i = 0; i < count; ++i) {
    const Contact& contact = contacts_.contacts[i];
    const int row = rowsPerContact() * i;
    const double excess = excess_.measure(contact, tick.dt);
    tick.robot.directionJacobian(contact.frame, contact.point_W, contact.normal_W, rows.jacobian.row(row));
    rows.force[row] = std::max(force_ - feedback_ * excess, min_force_);
    lowest_reference_ = std::min(lowest_reference_, rows.force[row]);
    if (friction_) {
      const Tangents t(contact.normal_W);
      tick.robot.directionJacobian(contact.frame, contact.point_W, t.first_W, rows.jacobian.row(row + 1));
      tick.robot.directionJacobian(contact.frame, contact.point_W, t.second_W, rows.jacobian.row(row + 2));
      rows.force.segment<2>(row + 1).setZero();
    }
    error_ = std::max(error_, std::abs(contact.force_N - force_));
  }
  excess_.endTick();
}

void ContactForce::doArchive(Archive& archive) {
  archive("excess", excess_);
  archive("lowest-reference", lowest_reference_);
}

bool ContactForce::displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                                Eigen::Ref<Eigen::VectorXd> dx) const {
  for (std::size_t i = 0; i < contacts_.contacts.size(); ++i) {
    const Contact& contact = contacts_.contacts[i];
    const Eigen::Vector3d moved_W = pointDisplacement(from, to, contact.frame, contact.point_W);
    const auto row = rowsPerContact() * static_cast<Eigen::Index>(i);
    dx[row] = contact.normal_W.dot(moved_W);
    if (!friction_) continue;
    const Tangents t(contact.normal_W);
    dx[row + 1] = t.first_W.dot(moved_W);
    dx[row + 2] = t.second_W.dot(moved_W);
  }
  return true;
}

void ContactForce::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"lowest_reference_N", &lowest_reference_});
}

}  // namespace tactus::tasks
