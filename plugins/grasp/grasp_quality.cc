#include "plugins/grasp/grasp_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::plugins {

using namespace control;

void GraspQualityMeasure::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "grasp-quality";
  row.description = "How the robot holds an object at the end: contacts, forces, grasp wrench space.";
  row.source = "Ferrari and Canny 1992; thesis 4.4.2";
  row.attributes = {
      {.name = "object", .type = ValueType::object, .required = true, .description = "What is held."},
      {.name = "friction", .type = ValueType::real, .unit = "1", .default_text = "0.5",
       .description = "μ of the friction cones.", .lower = 0},
      {.name = "edges", .type = ValueType::integer, .default_text = "8",
       .description = "Of each cone, made linear.", .lower = 3, .upper = 64},
      {.name = "window", .type = ValueType::real, .unit = "s", .default_text = "1",
       .description = "Contacts and forces are means over the last so many seconds.", .lower = 0, .upper = 600,
       .lower_open = true},
  };
  registry.addMeasure(row, [](const MeasureContext& context) { return std::make_unique<GraspQualityMeasure>(context); });
}

GraspQualityMeasure::GraspQualityMeasure(const MeasureContext& context)
    : period_(context.control_period), touches_(context.robot.links.size()) {
  const auto& objects = context.scene.objects;
  const auto object = std::find_if(objects.begin(), objects.end(), [&](const description::Object& other) {
    return other.name == context.values.text("object");
  });
  if (object == objects.end()) throw ElementError("object", "the scene has no such object");
  object_ = static_cast<int>(object - objects.begin());
  pose_ = object->pose;
  options_.friction = context.values.real("friction");
  options_.edges = static_cast<int>(context.values.integer("edges"));
  options_.centre = object->mass.centre;
  options_.scale = 0;
  for (const description::Primitive& primitive : object->primitives)
    options_.scale = std::max(options_.scale, (primitive.pose.translation() - options_.centre).norm() +
                                                  primitive.shape->boundingRadius());
  if (!std::isfinite(options_.scale)) throw ElementError("object", "what has no end cannot be grasped");
  window_.resize(static_cast<std::size_t>(std::max(1L, std::lround(context.values.real("window") / period_))));
}

void GraspQualityMeasure::doObserve(const ObservedTick& tick) {
  if (static_cast<std::size_t>(object_) < tick.objects.size()) pose_ = tick.objects[static_cast<std::size_t>(object_)].pose;
  const Eigen::Isometry3d to_object = pose_.inverse();
  for (Touch& touch : touches_) {
    touch.force_N = 0;
    touch.moment.setZero();
    touch.normal.setZero();
  }
  for (const ContactRecord& record : tick.truth.contacts) {
    if (record.object != object_ || record.isOfSelf()) continue;
    Touch& touch = touches_[static_cast<std::size_t>(record.link)];
    touch.force_N += record.force_N;
    touch.moment += record.force_N * (to_object * record.point_W);
    touch.normal += record.force_N * (to_object.linear() * record.normal_W);
  }
  Moment& now = window_[static_cast<std::size_t>(ticks_) % window_.size()];
  now = {};
  for (Touch& touch : touches_) {
    touch.on.update(touch.force_N, period_);
    if (!touch.on.on()) continue;
    now.contacts += 1;
    now.force_sum_N += touch.force_N;
    now.force_max_N = std::max(now.force_max_N, touch.force_N);
  }
  contacts_now_ = now.contacts;
  ++ticks_;
}

std::vector<GraspContact> GraspQualityMeasure::contacts() const {
  std::vector<GraspContact> contacts;
  for (const Touch& touch : touches_)
    if (touch.on.on() && touch.force_N > 0 && touch.normal.norm() > 1e-9 * touch.force_N)
      contacts.push_back({touch.moment / touch.force_N, touch.normal});
  return contacts;
}

void GraspQualityMeasure::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"contacts", &contacts_now_});
}

void GraspQualityMeasure::metrics(std::vector<Metric>& metrics) const {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto count = std::min(static_cast<std::size_t>(ticks_), window_.size());
  double contacts_sum = 0, force_sum = 0, max_sum = 0, touched = 0;
  for (std::size_t i = 0; i < count; ++i) {
    contacts_sum += window_[i].contacts;
    force_sum += window_[i].force_sum_N;
    max_sum += window_[i].force_max_N;
    touched += window_[i].contacts > 0;
  }
  metrics.push_back({"contacts", count ? contacts_sum / static_cast<double>(count) : none});
  metrics.push_back({"force_mean_N", contacts_sum > 0 ? force_sum / contacts_sum : none});
  metrics.push_back({"force_max_N", touched > 0 ? max_sum / touched : none});
  GraspWrenchSpace space{none, none};
  try {
    if (ticks_) space = graspWrenchSpace(contacts(), options_);
  } catch (const HullError&) {                                     // the figures stay none
  }
  metrics.push_back({"epsilon", space.epsilon});
  metrics.push_back({"volume", space.volume});
}

void GraspQualityMeasure::Touch::archive(Archive& archive) {
  archive("force", force_N);
  archive("moment", moment);
  archive("normal", normal);
  archive("on", on);
}

void GraspQualityMeasure::Moment::archive(Archive& archive) {
  archive("contacts", contacts);
  archive("force-sum", force_sum_N);
  archive("force-max", force_max_N);
}

void GraspQualityMeasure::doArchive(Archive& archive) {
  archive("touches", touches_);
  archive("window", window_);
  archive("ticks", ticks_);
  archive("contacts-now", contacts_now_);
  if (!(ticks_ >= 0)) throw StateError("measure: the number of ticks is negative");
}

}  // namespace tactus::plugins
