#include "framework/control/sensed.h"

namespace tactus::control {

void archive(Archive& archive, ContactRecord& record) {
  archive("link", record.link);
  archive("object", record.object);
  archive("other-link", record.other_link);
  archive("point", record.point_W);
  archive("normal", record.normal_W);
  archive("depth", record.depth);
  archive("force", record.force_N);
  archive("friction", record.friction_W);
}

void archive(Archive& archive, LinkWrench& wrench) {
  archive("link", wrench.link);
  archive("force", wrench.force_L);
  archive("moment", wrench.moment_L);
}

void archive(Archive& archive, FaultRecord& record) {
  archive("strikes", record.strikes);
  archive("began", record.began);
  archive("ended", record.ended);
}

void archive(Archive& archive, Sensed& sensed) {
  archive("time", sensed.time);
  archive("q", sensed.q);
  archive("qd", sensed.qd);
  archive.growing("contacts", sensed.contacts);
  archive.growing("wrenches", sensed.wrenches);
  archive("readings", sensed.readings);
}

}  // namespace tactus::control
