#include "bench/peers/problem.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "framework/dynamics/model.h"
#include "tests/dynamics/robots.h"

namespace tactus::bench {
namespace {

using description::JointType;
using dynamics::Model;

std::vector<Body> mergedBodies(const Model& model) {
  std::vector<int> joint_of(model.bodyCount());                    // the joint whose last body this is
  for (int j = 0; j < static_cast<int>(model.joints().size()); ++j)
    joint_of[model.joints()[j].first_body + model.joints()[j].body_count - 1] = j;
  std::vector<Body> bodies;
  for (const Model::Joint& joint : model.joints()) {
    const bool known = joint.type == JointType::revolute || joint.type == JointType::floating;
    if (!known || joint.driver >= 0)
      throw std::invalid_argument("joint '" + joint.name + "': the comparison takes only revolute and floating " +
                                  "joints that no other joint drives");
    Body body;
    body.name = joint.name;
    const int parent = model.parent(joint.first_body);
    body.parent = parent < 0 ? -1 : joint_of[parent];
    body.type = joint.type;
    body.position = joint.position;
    body.coordinate = joint.coordinate;
    for (int i = 0; i < joint.body_count; ++i)
      body.origin = body.origin * model.bodies()[joint.first_body + i].origin;
    if (joint.type == JointType::floating && (body.parent >= 0 || !body.origin.isApprox(Eigen::Isometry3d::Identity())))
      throw std::invalid_argument("joint '" + joint.name + "': the comparison takes a floating joint only where " +
                                  "its frame is the world's");
    const Model::Body& last = model.bodies()[joint.first_body + joint.body_count - 1];
    body.mass = last.inertia.mass;
    body.centre_of_mass = last.centre_of_mass;
    body.inertia = last.central_inertia;
    bodies.push_back(body);
  }
  return bodies;
}

State randomState(test_robots::Random& random, const Model& model) {
  State state;
  state.q = test_robots::uniformVector(random, model.positionCount(), 3);
  state.qd = test_robots::uniformVector(random, model.dof(), 2);
  state.qdd = test_robots::uniformVector(random, model.dof(), 5);
  state.tau = test_robots::uniformVector(random, model.dof(), 5);
  for (const Model::Joint& joint : model.joints())
    if (joint.type == JointType::floating) state.q.segment<4>(joint.position + 3).normalize();
  return state;
}

/// Three links of each finger of a hand; of another robot, links spread evenly over the joints.
std::vector<std::string> touchedLinks(const Model& model) {
  std::vector<std::string> links;
  if (model.frameIndex("index_tip") >= 0) {
    for (const std::string finger : {"index_", "middle_", "ring_", "thumb_"})
      for (const std::string link : {"1", "2", "tip"}) links.push_back(finger + link);
    return links;
  }
  const int joints = static_cast<int>(model.joints().size());
  for (int k = 1; k <= point_count; ++k) {
    const Model::Joint& joint = model.joints()[std::max(k * joints / point_count, 1) - 1];
    const int body = joint.first_body + joint.body_count - 1;
    links.push_back(std::ranges::find(model.frames(), body, &Model::Frame::body)->name);
  }
  return links;
}

}  // namespace

Problem::Problem(std::string name, description::Robot robot) : name(std::move(name)), robot(std::move(robot)) {
  const Model model(this->robot);
  dof = model.dof();
  bodies = mergedBodies(model);
  test_robots::Random random(1);
  for (int k = 0; k < state_count; ++k) states.push_back(randomState(random, model));
  const std::vector<std::string> links = touchedLinks(model);
  for (int k = 0; k < point_count; ++k) {
    const int body = model.frames()[model.frameIndex(links[k])].body;
    points[k].link = links[k];
    points[k].body = static_cast<int>(std::ranges::find_if(model.joints(), [&](const Model::Joint& joint) {
                                        return joint.first_body + joint.body_count - 1 == body;
                                      }) - model.joints().begin());
    points[k].position_W = test_robots::uniformVector3(random, 1);
  }
}

}  // namespace tactus::bench
