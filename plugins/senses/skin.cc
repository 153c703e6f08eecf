#include "plugins/senses/skin.h"

#include <algorithm>
#include <cmath>

#include "framework/control/sensing_guard.h"
#include "framework/description/link_shape.h"

namespace tactus::plugins {

using namespace control;

void Skin::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "skin";
  row.description = "Patches of taxels on links: contacts as taxels tell them.";
  row.source = "Johnson 1985, 4.2 (Hertz); thesis 4.4.2 (contacts from taxels)";
  row.attributes = {
      {.name = "links", .type = ValueType::links, .required = true,
       .description = "The links that carry taxels; those without a shape carry none."},
      {.name = "layout", .type = ValueType::choice, .default_text = "tekscan",
       .description = "Where taxels lie: a grid of 4 mm all over; 12 on the round end far from the link's origin, 0 to "
                      "255 counts; 6 nodes of 9 by 5 mm in a row along the `facing` side, shared by the links, at 20 Hz.",
       .choices = {"tekscan", "icub-fingertip", "six-node"}},
      {.name = "pitch", .type = ValueType::real, .unit = "m",
       .description = "Of the grid, 0.004 without it; of `positions` the diameter that each collects.", .lower = 5e-4},
      {.name = "counts", .type = ValueType::reals, .unit = "1",
       .description = "Instead of a grid: rows along a capsule's straight part, and columns around it.", .lower = 1,
       .count = 2},
      {.name = "positions", .type = ValueType::points, .unit = "m",
       .description = "Instead of a grid: where taxels lie in link axes; they are put on the surface.", .count = 3},
      {.name = "facing", .type = ValueType::reals, .unit = "1",
       .description = "A direction in link axes: only what faces it has taxels.", .count = 3},
      {.name = "arc", .type = ValueType::real, .unit = "rad", .default_text = "1.5707963267948966",
       .description = "How far the normal of a part may be from `facing`.", .lower = 0, .upper = 3.1415926535897932,
       .lower_open = true},
      {.name = "spread", .type = ValueType::real, .unit = "m", .default_text = "0.0015",
       .description = "How far the cover spreads a pressure, a standard deviation.", .lower = 0, .lower_open = true},
      {.name = "gain", .type = ValueType::real, .unit = "1", .default_text = "1",
       .description = "What taxels tell of a force.", .lower = 0},
      {.name = "gain-spread", .type = ValueType::real, .unit = "1", .default_text = "0",
       .description = "Standard deviation from taxel to taxel, relative.", .lower = 0},
      {.name = "noise", .type = ValueType::real, .unit = "N", .default_text = "0",
       .description = "Standard deviation of each sample of a taxel.", .lower = 0},
      {.name = "drift", .type = ValueType::real, .unit = "N/√s", .default_text = "0",
       .description = "Of the random walk of a taxel's zero.", .lower = 0},
      {.name = "drift-limit", .type = ValueType::real, .unit = "N", .default_text = "0.05",
       .description = "The walk turns back here.", .lower = 0},
      {.name = "threshold", .type = ValueType::real, .unit = "N", .default_text = "0.005",
       .description = "A taxel below this tells 0.", .lower = 0},
      {.name = "range", .type = ValueType::real, .unit = "N",
       .description = "Where a taxel saturates; by layout, else nowhere: 2 of a fingertip.", .lower = 0,
       .lower_open = true},
      {.name = "levels", .type = ValueType::integer, .unit = "1",
       .description = "Steps of the range; by layout, else no steps: 255 of a fingertip.", .lower = 1},
      {.name = "values", .type = ValueType::choice,
       .description = "How `taxels` tells them; by layout, else in N: a fingertip in counts.",
       .choices = {"N", "counts"}},
      {.name = "dead", .type = ValueType::real, .unit = "1", .default_text = "0",
       .description = "Share of taxels that are dead, drawn from the seed.", .lower = 0, .upper = 1},
      {.name = "dead-taxels", .type = ValueType::reals, .unit = "1",
       .description = "Numbers of taxels that are dead, from 0, as `taxels` lists them.", .lower = 0},
      {.name = "rate", .type = ValueType::real, .unit = "Hz",
       .description = "Samples a second; by layout, else one each tick: 20 of six nodes.", .lower = 0,
       .lower_open = true},
      {.name = "delay", .type = ValueType::real, .unit = "s", .default_text = "0",
       .description = "From a sample until it is told.", .lower = 0, .upper = 1},
      {.name = "adjacency", .type = ValueType::real, .unit = "1", .default_text = "1.6",
       .description = "Taxels are neighbours up to this times the pitch; a large one makes one contact of a link, as "
                      "the thesis has it.",
       .lower = 1},
      {.name = "min-taxels", .type = ValueType::integer, .unit = "1", .default_text = "1",
       .description = "Fewer neighbours make no contact.", .lower = 1},
      {.name = "min-force", .type = ValueType::real, .unit = "N", .default_text = "0.01",
       .description = "A weaker sum of neighbours makes no contact.", .lower = 0},
      {.name = "self-margin", .type = ValueType::real, .unit = "m", .default_text = "0.003",
       .description = "A contact as near as this to another link that may touch its own is one of the robot with "
                      "itself.",
       .lower = 0},
      {.name = "perfect", .type = ValueType::flag, .default_text = "false",
       .description = "The true contacts are felt; taxels are there for the ports alone."},
  };
  row.presence = {{Presence::exclusive, {"pitch", "counts"}}, {Presence::exclusive, {"counts", "positions"}}};
  row.ports = {
      {.name = "force", .type = "scalar", .unit = "N", .description = "The sum of all taxels.", .dimension = 1},
      {.name = "active", .type = "scalar", .unit = "1", .description = "Taxels above 0.", .dimension = 1},
      {.name = "taxels", .type = "vector", .unit = "", .description = "All of them, link by link: N, or counts."},
  };
  registry.addSensor(row, [](const SensorContext& context) { return std::make_unique<Skin>(context); });
}

Skin::Skin(const SensorContext& context)
    : model_(context.model),
      workspace_(context.model),
      patch_of_(context.robot.links.size(), -1),
      near_(context.robot.links.size()),
      self_margin_(context.values.real("self-margin")),
      count_per_N_(1),
      min_taxels_(context.values.integer("min-taxels")),
      min_force_(context.values.real("min-force")),
      perfect_(context.values.flag("perfect")) {
  const ElementValues& values = context.values;
  const std::vector<int> links = context.frames("links");
  const auto carries = [&](int link) { return !context.robot.links[static_cast<std::size_t>(link)].shapes.empty(); };
  const Layout layout(values, static_cast<int>(std::count_if(links.begin(), links.end(), carries)));
  int taxels = 0;
  for (const int link : links) {
    if (!carries(link)) continue;
    const description::Link& described = context.robot.links[static_cast<std::size_t>(link)];
    patch_of_[static_cast<std::size_t>(link)] = static_cast<int>(patches_.size());
    patches_.push_back({link, taxels, TaxelPatch(described, layout.plan(described), values.real("spread"),
                                                 values.real("adjacency"))});
    taxels += patches_.back().taxels.count();
  }
  if (taxels == 0) throw ElementError("links", "there is no surface that could carry a taxel");

  const auto addNear = [&](int link, int other) {
    for (const description::LinkShape& shape : context.robot.links[static_cast<std::size_t>(other)].shapes)
      near_[static_cast<std::size_t>(link)].push_back({other, description::solidOf(shape)});
  };
  for (const description::LinkPair& pair : context.robot.self_contact) {
    addNear(pair.one, pair.other);
    addNear(pair.other, pair.one);
  }

  const Layout::Electronics electronics = layout.electronics();
  TaxelResponse::Options options;
  options.gain = values.real("gain");
  options.gain_spread = values.real("gain-spread");
  options.noise = values.real("noise");
  options.drift = values.real("drift");
  options.drift_limit = values.real("drift-limit");
  options.range = values.has("range") ? values.real("range") : electronics.range_N;
  options.levels = values.has("levels") ? values.integer("levels") : electronics.levels;
  options.threshold = values.real("threshold");
  options.dead = values.real("dead");
  if (options.levels > 0 && options.range <= 0) throw ElementError("levels", "steps of what? give the range too");
  const bool counts = values.has("values") ? values.text("values") == "counts" : electronics.counts;
  if (counts && options.levels == 0) throw ElementError("values", "there are no counts without levels");
  if (counts) count_per_N_ = options.levels / options.range;
  std::vector<int> dead;
  if (values.has("dead-taxels"))
    for (const double number : values.numbers("dead-taxels")) {
      if (number != std::floor(number) || number >= taxels)
        throw ElementError("dead-taxels", "there is no taxel " + formatNumber(number) +
                                              ": they are numbered from 0 to " + std::to_string(taxels - 1));
      dead.push_back(static_cast<int>(number));
    }
  response_.emplace(taxels, options, dead, context.seed);
  sampler_.emplace(taxels, values.has("rate") ? values.real("rate") : electronics.rate_Hz, values.real("delay"),
                   context.control_period);
  pressed_N_.setZero(taxels);
  contacts_.reserve(static_cast<std::size_t>(taxels));
  read_.reserve(static_cast<std::size_t>(taxels));
}

int Skin::count(const PortRow& port) const {
  return port.name == "taxels" ? static_cast<int>(pressed_N_.size()) : port.dimension;
}

void Skin::doSense(const Sensed& truth, Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) {
  if (sampler_->isDue(truth.time)) {
    press(truth);
    const auto sample = sampler_->take(truth.time);
    response_->respond(pressed_N_, sampler_->interval(), sample);
  }
  if (sampler_->tell(truth.time)) read();
  const auto told = sampler_->told();
  readings[0] = told.sum();
  readings[1] = static_cast<double>((told.array() > 0).count());
  readings.tail(told.size()) = count_per_N_ * told;
  if (!perfect_) replaceContacts(felt);
}

void Skin::doArchive(Archive& archive) {
  archive("response", *response_);
  archive("sampler", *sampler_);
  archive.growing("contacts", contacts_);
  for (const LinkContact& contact : contacts_)
    if (patchOf(contact.link) < 0)
      throw StateError("a contact of the state is of link " + std::to_string(contact.link) + ", which has no taxels");
}

int Skin::patchOf(int link) const {
  return link >= 0 && link < static_cast<int>(patch_of_.size()) ? patch_of_[static_cast<std::size_t>(link)] : -1;
}

void Skin::press(const Sensed& truth) {
  pressed_N_.setZero();
  bool placed = false;
  for (const ContactRecord& contact : truth.contacts) {
    if (patchOf(contact.link) < 0 && patchOf(contact.other_link) < 0) continue;
    if (!placed) dynamics::forwardKinematics(model_, truth.q, workspace_);
    placed = true;
    pressOn(contact.link, contact);
    pressOn(contact.other_link, contact);
  }
}

void Skin::pressOn(int link, const ContactRecord& contact) {
  const int index = patchOf(link);
  if (index < 0) return;
  Patch& patch = patches_[static_cast<std::size_t>(index)];
  const Eigen::Isometry3d X_WL = dynamics::framePose(model_, workspace_, link);
  const Eigen::Vector3d point_L = X_WL.linear().transpose() * (contact.point_W - X_WL.translation());
  patch.taxels.press(point_L, contact.force_N, contact.depth, pressed_N_.segment(patch.first, patch.taxels.count()));
}

void Skin::read() {
  contacts_.clear();
  for (Patch& patch : patches_) {
    read_.clear();
    patch.taxels.read(sampler_->told().segment(patch.first, patch.taxels.count()), min_taxels_, min_force_, read_);
    for (const TaxelContact& contact : read_) contacts_.push_back({patch.link, contact});
  }
}

void Skin::replaceContacts(Sensed& felt) {
  std::erase_if(felt.contacts, [this](const ContactRecord& contact) {
    const bool is_true = contact.object >= 0 || (contact.isOfSelf() && contact.depth > 0);
    return is_true && (patchOf(contact.link) >= 0 || patchOf(contact.other_link) >= 0);
  });
  if (contacts_.empty()) return;
  dynamics::forwardKinematics(model_, felt.q, workspace_);
  for (const auto& [link, contact] : contacts_) {
    if (felt.contacts.size() >= SensingGuard::contact_capacity) return;
    const Eigen::Isometry3d X_WL = dynamics::framePose(model_, workspace_, link);
    ContactRecord record;
    record.link = link;
    record.point_W = X_WL * contact.place.position_L;
    record.normal_W = X_WL.linear() * contact.place.normal_L;
    record.force_N = contact.force_N;
    record.other_link = touchedAt(link, record.point_W);
    felt.contacts.push_back(record);
  }
}

int Skin::touchedAt(int link, const Eigen::Vector3d& point_W) const {
  int touched = -1;
  double nearest = self_margin_;
  for (const Solid& solid : near_[static_cast<std::size_t>(link)]) {
    const Eigen::Isometry3d X_WL = dynamics::framePose(model_, workspace_, solid.link);
    const Eigen::Vector3d p = solid.shape.pose.inverse() * (X_WL.inverse() * point_W);
    const double distance = solid.shape.shape->distance(p).distance;
    if (distance > nearest) continue;
    nearest = distance;
    touched = solid.link;
  }
  return touched;
}

}  // namespace tactus::plugins
