#include "tests/sim/simbody_contact.h"

#include <Simbody.h>

#include <vector>

namespace tactus::sim_tests {
namespace {

SimTK::Vec3 vec(const Triple& v) { return {v[0], v[1], v[2]}; }
Triple triple(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

}  // namespace

SimbodyTouch simbodyContact(const MovingBall& ball, const MovingBall* second, const SimbodyMaterial& material) {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter(system);
  SimTK::ContactTrackerSubsystem tracker(system);
  SimTK::CompliantContactSubsystem contact(system, tracker);
  contact.setTransitionVelocity(1e-6);
  const SimTK::ContactMaterial surface(material.modulus, material.dissipation, material.friction, material.friction, 0);
  if (!second)                                                     // a half space fills its x > 0
    matter.Ground().updBody().addContactSurface(SimTK::Rotation(SimTK::Pi / 2, SimTK::YAxis),
                                                SimTK::ContactSurface(SimTK::ContactGeometry::HalfSpace(), surface));
  std::vector<SimTK::MobilizedBody::Free> bodies;
  for (const MovingBall* one : {&ball, second}) {
    if (!one) continue;
    SimTK::Body::Rigid body(SimTK::MassProperties(1, SimTK::Vec3(0), SimTK::Inertia(1)));
    body.addContactSurface(SimTK::Transform(),
                           SimTK::ContactSurface(SimTK::ContactGeometry::Sphere(one->radius), surface));
    bodies.emplace_back(matter.Ground(), SimTK::Transform(), body, SimTK::Transform());
  }
  system.realizeTopology();
  SimTK::State state = system.getDefaultState();
  for (size_t i = 0; i < bodies.size(); ++i) {
    const MovingBall& one = i == 0 ? ball : *second;
    bodies[i].setQToFitTransform(state, SimTK::Transform(vec(one.place_W)));
    bodies[i].setUToFitVelocity(state, SimTK::SpatialVec(vec(one.angular_W), vec(one.linear_W)));
  }
  system.realize(state, SimTK::Stage::Dynamics);

  SimbodyTouch touch{};
  touch.count = contact.getNumContactForces(state);
  if (touch.count == 0) return touch;
  const SimTK::ContactForce& force = contact.getContactForce(state, 0);
  const SimTK::Contact& found = tracker.getActiveContacts(state).getContactById(force.getContactId());
  const auto& circle = SimTK::CircularPointContact::getAs(found);
  // Which of the two is Simbody's number 2 is up to Simbody.
  const SimTK::MobilizedBody& one = tracker.getMobilizedBody(found.getSurface1());
  const bool ball_is_1 = one.getMobilizedBodyIndex() == bodies[0].getMobilizedBodyIndex();
  const double sign = ball_is_1 ? 1 : -1;
  const SimTK::Transform X_WS = one.getBodyTransform(state) * tracker.getContactSurfaceTransform(found.getSurface1());
  touch.depth = circle.getDepth();
  touch.point_W = triple(force.getContactPoint());
  touch.normal_W = triple(sign * (X_WS.R() * SimTK::Vec3(circle.getNormal())));
  touch.force_W = triple(sign * force.getForceOnSurface2()[1]);
  return touch;
}

}  // namespace tactus::sim_tests
