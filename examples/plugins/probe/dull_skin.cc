#include "dull_skin.h"

#include <algorithm>
#include <cmath>

namespace probe {

using namespace tactus::control;

void DullSkin::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "probe.skin";
  row.description = "A skin that feels forces in steps, with noise, above a threshold.";
  row.attributes = {
      {.name = "links", .type = ValueType::links, .required = true, .description = "The links that it covers."},
      {.name = "step", .type = ValueType::real, .unit = "N", .default_text = "0.05",
       .description = "r, of what it tells.", .lower = 0, .lower_open = true},
      {.name = "noise", .type = ValueType::real, .unit = "N", .default_text = "0.02",
       .description = "σ, of what it feels.", .lower = 0},
      {.name = "threshold", .type = ValueType::real, .unit = "N", .default_text = "0.05",
       .description = "Less than this is not felt.", .lower = 0},
  };
  row.ports = {
      {.name = "force", .type = "scalar", .unit = "N", .description = "The sum of all that it feels.", .dimension = 1},
      {.name = "forces", .type = "vector", .unit = "N", .description = "The sum of each of its links."},
  };
  registry.addSensor(row, [](const SensorContext& context) { return std::make_unique<DullSkin>(context); });
}

DullSkin::DullSkin(const SensorContext& context)
    : place_(context.robot.links.size(), -1),
      links_(0),
      step_(context.values.real("step")),
      noise_(context.values.real("noise")),
      threshold_(context.values.real("threshold")),
      random_(context.seed) {
  for (const int link : context.frames("links")) place_[static_cast<size_t>(link)] = links_++;
}

int DullSkin::count(const PortRow& port) const { return port.name == "forces" ? links_ : port.dimension; }

void DullSkin::doSense(const Sensed&, Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) {
  readings.setZero();
  for (ContactRecord& contact : felt.contacts) {
    const int place = place_[static_cast<size_t>(contact.link)];
    if (place < 0) continue;
    const double told = std::max(0.0, std::round((contact.force_N + noise_ * random_.normal()) / step_) * step_);
    contact.force_N = told >= threshold_ ? told : 0;
    readings[0] += contact.force_N;
    readings[1 + place] += contact.force_N;
  }
  std::erase_if(felt.contacts, [this](const ContactRecord& contact) {
    return place_[static_cast<size_t>(contact.link)] >= 0 && contact.force_N == 0;
  });
}

}  // namespace probe
