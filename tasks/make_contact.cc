#include "tasks/make_contact.h"

#include <algorithm>
#include <limits>

#include "framework/control/displacement.h"
#include "framework/description/link_shape.h"

namespace tactus::tasks {

using namespace control;

void MakeContact::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "make-contact";
  row.kind = ElementKind::task;
  row.description = "Brings desired links that do not touch to the surface that the others feel.";
  row.source = "thesis 4.3.3-4.3.5, 4.4.1";
  row.attributes = {
      {.name = "on", .type = ValueType::port, .required = true,
       .description = "The missing contacts, e.g. touch.missing.", .port_type = "missing-set"},
      {.name = "stiffness", .type = ValueType::real, .unit = "N/m", .default_text = "5", .description = "k_d.",
       .lower = 0},
      {.name = "damping", .type = ValueType::real, .unit = "N s/m", .default_text = "1", .description = "d_d.",
       .lower = 0},
      {.name = "speed", .type = ValueType::real, .unit = "m/s", .default_text = "0.05",
       .description = "λ, the speed of the reference.", .lower = 0},
      {.name = "bound", .type = ValueType::real, .unit = "m", .default_text = "0.1",
       .description = "Greatest distance of the reference from the link.", .lower = 0, .lower_open = true},
      {.name = "patch", .type = ValueType::link,
       .description = "To grasp: missing links move from this one towards opposing-patch, whatever touches."},
      {.name = "opposing-patch", .type = ValueType::link, .description = "With patch: the link across the object."},
      {.name = "opposing", .type = ValueType::links,
       .description = "With patch: links that move the other way, from opposing-patch towards patch."},
  };
  row.presence = {{Presence::together, {"patch", "opposing-patch"}}, {Presence::needs, {"opposing", "patch"}}};
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<MakeContact>(context); });
}

MakeContact::MakeContact(const BuildContext& context)
    : Task(Relation::equality, 3 * context.port<MissingSet>("on").capacity),
      missing_(context.port<MissingSet>("on")),
      stiffness_(context.values.real("stiffness")),
      damping_(context.values.real("damping")),
      speed_(context.values.real("speed")),
      bound_(context.values.real("bound")),
      references_(missing_.capacity),
      seen_(missing_.capacity, 0) {
  if (!context.values.has("patch")) return;
  const int patch = context.frame("patch"), other = context.frame("opposing-patch");
  if (patch == other) throw ElementError("opposing-patch", "a grasp has two sides: opposing-patch is patch");
  const auto middle = [&](int frame) { return description::middleOf(context.robot.links[static_cast<std::size_t>(frame)]); };
  opposition_ = Opposition{patch, other, middle(patch), middle(other), std::vector<bool>(context.model.frames().size())};
  if (!context.values.has("opposing")) return;
  for (const int frame : context.frames("opposing")) opposition_->opposing[static_cast<std::size_t>(frame)] = true;
}

Eigen::Vector3d MakeContact::desiredVelocity(const Tick& tick, const MissingContact& missing) const {
  if (!opposition_) return towardsSurface(missing.point_W);
  const Opposition& grasp = *opposition_;
  const Eigen::Vector3d across = tick.robot.framePose(grasp.other) * grasp.middle_O -
                                 tick.robot.framePose(grasp.patch) * grasp.middle_P;
  const double distance = across.norm();
  if (distance < 1e-9) return Eigen::Vector3d::Zero();
  return (grasp.opposing[static_cast<std::size_t>(missing.frame)] ? -speed_ : speed_) / distance * across;
}

Eigen::Vector3d MakeContact::towardsSurface(const Eigen::Vector3d& point_W) const {
  const Contact* closest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Contact& contact : *missing_.all_contacts) {
    const double distance = (contact.point_W - point_W).squaredNorm();
    if (distance < least) {
      least = distance;
      closest = &contact;
    }
  }
  const Eigen::Vector3d towards = closest->point_W - point_W;
  const double distance = towards.norm();
  if (distance < 1e-9) return speed_ * closest->normal_W;
  const Eigen::Vector3d sum = closest->normal_W + towards / distance;
  const double length = sum.norm();
  return length < 1e-6 ? Eigen::Vector3d(speed_ * closest->normal_W) : Eigen::Vector3d(speed_ * sum / length);
}

void MakeContact::doUpdate(const Tick& tick, TickTask& rows) {
  rows.rows = 0;
  error_ = 0;
  std::fill(seen_.begin(), seen_.end(), 0);
  if (opposition_ || !missing_.all_contacts->empty()) {
    for (const MissingContact& missing : missing_.points) {
      seen_[missing.slot] = 1;
      Reference& reference = references_[missing.slot];
      if (!reference.active) {
        reference.active = true;
        reference.position_W = missing.point_W;
      }
      const Eigen::Vector3d velocity = desiredVelocity(tick, missing);
      reference.position_W += tick.dt * velocity;
      Eigen::Vector3d x_e = reference.position_W - missing.point_W;
      const double distance = x_e.norm();
      Eigen::Vector3d reference_velocity = velocity;
      if (distance > bound_) {
        x_e *= bound_ / distance;
        reference.position_W = missing.point_W + x_e;
        reference_velocity.setZero();
      }
      const Eigen::Vector3d velocity_error =
          reference_velocity - tick.robot.pointVelocity(missing.frame, missing.point_W);
      tick.robot.pointJacobian(missing.frame, missing.point_W, rows.jacobian.middleRows<3>(rows.rows));
      rows.force.segment<3>(rows.rows) = stiffness_ * x_e + damping_ * velocity_error;
      rows.rows += 3;
      error_ = std::max(error_, x_e.norm());
    }
  }
  for (std::size_t slot = 0; slot < references_.size(); ++slot) {
    if (!seen_[slot]) references_[slot].active = false;
  }
}

void MakeContact::doArchive(Archive& archive) {
  archive("references", references_);
}

bool MakeContact::displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                               Eigen::Ref<Eigen::VectorXd> dx) const {
  int row = 0;
  for (const MissingContact& missing : missing_.points) {
    if (row == dx.size()) break;                                   // without any contact there are no rows
    dx.segment<3>(row) = pointDisplacement(from, to, missing.frame, missing.point_W);
    row += 3;
  }
  return true;
}

}  // namespace tactus::tasks
