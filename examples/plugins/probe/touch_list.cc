#include "touch_list.h"

namespace probe {

using namespace tactus::control;

void TouchList::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "probe.touches";
  row.description = "Writes every touch, felt or not, into a file of the run folder.";
  row.attributes = {
      {.name = "file", .type = ValueType::text, .default_text = "touches.csv", .description = "Its name."},
      {.name = "from", .type = ValueType::real, .unit = "N", .default_text = "0.01",
       .description = "Weaker touches are left out.", .lower = 0},
  };
  registry.addRecorder(row, [](const RecorderContext& context) {
    if (context.values.text("file").find('/') != std::string::npos)
      throw ElementError("file", "it stands in the run folder: give a name without a path");
    return std::make_unique<TouchList>(context);
  });
}

TouchList::TouchList(const RecorderContext& context)
    : from_(context.values.real("from")),
      file_(context.folder + "/" + context.values.text("file"), {"time", "link", "object", "force_N", "felt_N"}) {
  for (const auto& link : context.robot.links) links_.push_back(link.name);
}

void TouchList::observe(const ObservedTick& tick) {
  for (const ContactRecord& contact : tick.truth.contacts) {
    if (contact.force_N < from_ || contact.isOfSelf()) continue;
    double felt = 0;
    for (const ContactRecord& other : tick.sensed.contacts)
      if (other.link == contact.link && other.object == contact.object) felt += other.force_N;
    file_ << tick.truth.time << links_[static_cast<size_t>(contact.link)] << contact.object << contact.force_N << felt;
    file_.endRow();
  }
}

}  // namespace probe
