#include "wrench.h"

namespace wrist {

using namespace tactus::control;

void WrenchSensor::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "wrist.wrench";
  row.description = "A force-torque sensor at a link, from the contacts of the skin beyond it.";
  row.attributes = {
      {.name = "frame", .type = ValueType::link, .required = true, .description = "The link that carries the sensor."},
      {.name = "filter", .type = ValueType::real, .unit = "s", .default_text = "0.005",
       .description = "Time constant of its low-pass.", .lower = 0},
  };
  row.ports = {{"wrench", "wrist.wrench", "N",
                "Force and moment that the world exerts, about the link's origin, world axes."},
               {"force", "scalar", "N", "Length of the force."}};
  registry.addSignal(row, [](const BuildContext& context) { return std::make_unique<WrenchSensor>(context); });
}

WrenchSensor::WrenchSensor(const BuildContext& context)
    : frame_(context.frame("frame")), filter_(context.values.real("filter")) {
  const auto& model = context.model;
  const int body = model.frames()[frame_].body;
  for (const auto& frame : model.frames()) {
    int at = frame.body;
    while (at >= 0 && at != body) at = model.parent(at);
    beyond_.push_back(at == body);
  }
}

void WrenchSensor::doUpdate(const Tick& tick) {
  const Eigen::Vector3d origin = tick.robot.framePose(frame_).translation();
  Wrench felt;
  for (const ContactRecord& contact : tick.sensed.contacts) {
    const bool both = contact.isOfSelf() && beyond_[contact.other_link] == beyond_[contact.link];
    const bool presses_in = contact.isOfSelf() && beyond_[contact.other_link];
    if (both || (!beyond_[contact.link] && !presses_in)) continue;
    const double sign = presses_in ? 1 : -1;
    const Eigen::Vector3d on_robot = sign * (contact.force_N * contact.normal_W + contact.friction_W);
    felt.force_W += on_robot;
    felt.moment_W += (contact.point_W - origin).cross(on_robot);
  }
  const double blend = tick.dt / (filter_ + tick.dt);
  wrench_.force_W += blend * (felt.force_W - wrench_.force_W);
  wrench_.moment_W += blend * (felt.moment_W - wrench_.moment_W);
  force_N_ = wrench_.force_W.norm();
}

void WrenchSensor::doArchive(Archive& archive) {
  archive("force", wrench_.force_W);
  archive("moment", wrench_.moment_W);
  archive("length", force_N_);
}

const void* WrenchSensor::doPort(std::string_view name) const {
  if (name == "wrench") return &wrench_;
  if (name == "force") return &force_N_;
  return nullptr;
}

void WrenchSensor::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"force_x_N", &wrench_.force_W[0]});
  columns.push_back({"force_y_N", &wrench_.force_W[1]});
  columns.push_back({"force_z_N", &wrench_.force_W[2]});
}

}  // namespace wrist
