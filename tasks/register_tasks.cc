#include "tasks/register_tasks.h"

#include "tasks/broken_rows.h"
#include "tasks/contact_force.h"
#include "tasks/contact_limit.h"
#include "tasks/contacts.h"
#include "tasks/ds.h"
#include "tasks/follow_surface.h"
#include "tasks/impedance.h"
#include "tasks/joint_limits.h"
#include "tasks/make_contact.h"
#include "tasks/phases.h"
#include "tasks/posture.h"

namespace tactus::tasks {

void registerBuiltIns(control::Registry& registry) {
  Contacts::registerIn(registry);
  Phases::registerIn(registry);
  ContactForce::registerIn(registry);
  ContactLimit::registerIn(registry);
  JointLimits::registerIn(registry);
  MakeContact::registerIn(registry);
  FollowSurface::registerIn(registry);
  Impedance::registerIn(registry);
  Posture::registerIn(registry);
  DynamicalSystem::registerIn(registry);
  BrokenRows::registerIn(registry);
}

}  // namespace tactus::tasks
