#include "sim/wrong_mass.h"

#include <set>

namespace tactus::sim {
namespace {

void makeWrong(const description::WrongMass& fault, double& mass, Eigen::Vector3d& centre, Eigen::Matrix3d& inertia) {
  const double own = fault.factor * mass, whole = own + fault.added;
  inertia *= fault.factor;
  mass = whole;
  if (!(fault.added > 0)) return;
  const Eigen::Vector3d d = fault.point - centre;
  inertia += own * fault.added / whole * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  centre += fault.added / whole * d;
}

}  // namespace

void makeWrong(const description::WrongMass& fault, description::Robot& robot, description::Scene& scene) {
  for (const description::BodyReference& body : fault.bodies) {
    if (body.object >= 0) {
      description::MassProperties& mass = scene.objects[static_cast<std::size_t>(body.object)].mass;
      makeWrong(fault, mass.mass, mass.centre, mass.inertia);
      continue;
    }
    description::Link& link = robot.links[static_cast<std::size_t>(body.link)];
    makeWrong(fault, link.mass, link.centre_of_mass, link.inertia);
    link.has_inertial = link.has_inertial || link.mass > 0;
  }
}

std::vector<MassPeriod> massPeriods(const std::vector<description::WrongMass>& faults) {
  std::set<double> times{-description::infinity};
  for (const description::WrongMass& fault : faults) times.insert({fault.window.from, fault.window.until});
  times.erase(description::infinity);
  std::vector<MassPeriod> periods;
  for (const double time : times) {
    periods.push_back({time, {}});
    for (const description::WrongMass& fault : faults) periods.back().holds.push_back(fault.window.holds(time, 0));
  }
  return periods;
}

}  // namespace tactus::sim
