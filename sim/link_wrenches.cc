#include "sim/link_wrenches.h"

#include <algorithm>

namespace tactus::sim {
namespace {

using description::Joint;
using description::Robot;

/// The link and all links below it, parents first.
std::vector<int> linksBelow(const Robot& robot, int link) {
  std::vector<int> links = {link};
  for (std::size_t i = 0; i < links.size(); ++i)
    for (const Joint& joint : robot.joints)
      if (joint.parent == links[i]) links.push_back(joint.child);
  return links;
}

/// The thin disk of robot.h, in the axes of the joint's child.
Eigen::Matrix3d rotorInertia(const Joint& joint) {
  return 0.5 * joint.reflectedInertia() * (Eigen::Matrix3d::Identity() + joint.axis * joint.axis.transpose());
}

}  // namespace

LinkWrenches::LinkWrenches(const Robot& robot, const std::vector<Carrier>& carriers, const std::vector<int>& links,
                           const Eigen::Vector3d& gravity_W)
    : gravity_W_(gravity_W) {
  for (const int root : links) {
    Subtree subtree{root, carriers[static_cast<std::size_t>(root)], {}, {}, {}};
    subtree.parted.assign(robot.links.size(), false);
    const std::vector<int> below = linksBelow(robot, root);
    const auto hangs = [&](int link) { return std::find(below.begin(), below.end(), link) != below.end(); };
    const auto bodyOf = [&](int link) { return carriers[static_cast<std::size_t>(link)].body; };
    bool whole = subtree.carrier.body != 0;
    for (int link = 0; link < static_cast<int>(robot.links.size()); ++link)
      whole = whole && (bodyOf(link) != subtree.carrier.body || hangs(link));
    for (const int link : below) {
      const Carrier& carrier = carriers[static_cast<std::size_t>(link)];
      const description::Link& described = robot.links[static_cast<std::size_t>(link)];
      const Eigen::Matrix3d R_BL = carrier.pose.linear();
      if (described.has_inertial)
        subtree.parts.push_back({carrier.body, described.mass, carrier.pose * described.centre_of_mass,
                                 R_BL * described.inertia * R_BL.transpose()});
      for (const Joint& joint : robot.joints)
        if (joint.child == link && joint.reflectedInertia() > 0 && joint.type != description::JointType::fixed)
          subtree.parts.push_back({carrier.body, 0, Eigen::Vector3d::Zero(),
                                   R_BL * rotorInertia(joint) * R_BL.transpose()});
      if (carrier.body == subtree.carrier.body && !whole)
        subtree.parted[static_cast<std::size_t>(link)] = true;
      else if (std::find(subtree.bodies.begin(), subtree.bodies.end(), carrier.body) == subtree.bodies.end())
        subtree.bodies.push_back(carrier.body);
    }
    subtrees_.push_back(std::move(subtree));
  }
}

void LinkWrenches::evaluate(const std::vector<BodyMotion>& motions, const std::vector<BodyAcceleration>& accelerations,
                            const std::vector<BodyWrench>& external,
                            const std::vector<control::ContactRecord>& contacts,
                            std::vector<control::LinkWrench>& wrenches, const std::vector<LinkPush>& pushes) const {
  wrenches.clear();
  for (const Subtree& subtree : subtrees_) {
    const BodyMotion& own = motions[static_cast<std::size_t>(subtree.carrier.body)];
    const Eigen::Vector3d origin_W = own.p_WB + own.R_WB * subtree.carrier.pose.translation();
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
    const auto add = [&](const Eigen::Vector3d& f, const Eigen::Vector3d& at_W) {
      force += f;
      moment += (at_W - origin_W).cross(f);
    };
    for (const Part& part : subtree.parts) {
      const BodyMotion& body = motions[static_cast<std::size_t>(part.body)];
      const BodyAcceleration& change = accelerations[static_cast<std::size_t>(part.body)];
      const Eigen::Vector3d arm = body.R_WB * part.centre_B;
      const Eigen::Vector3d acceleration =
          change.linear_W + change.angular_W.cross(arm) + body.angular_W.cross(body.angular_W.cross(arm));
      const Eigen::Matrix3d inertia = body.R_WB * part.inertia_B * body.R_WB.transpose();
      add(part.mass * (acceleration - gravity_W_), body.p_WB + arm);
      moment += inertia * change.angular_W + body.angular_W.cross(inertia * body.angular_W);
    }
    for (const int body : subtree.bodies) {
      const BodyWrench& wrench = external[static_cast<std::size_t>(body)];
      add(-wrench.force_W, motions[static_cast<std::size_t>(body)].p_WB);
      moment -= wrench.torque_W;
    }
    for (const control::ContactRecord& contact : contacts) {
      const Eigen::Vector3d force_W = contact.force_N * contact.normal_W + contact.friction_W;
      if (subtree.parted[static_cast<std::size_t>(contact.link)]) add(force_W, contact.point_W);
      if (contact.isOfSelf() && subtree.parted[static_cast<std::size_t>(contact.other_link)])
        add(-force_W, contact.point_W);
    }
    for (const LinkPush& push : pushes) {
      if (!subtree.parted[static_cast<std::size_t>(push.link)]) continue;
      add(-push.force_W, push.point_W);
      moment -= push.moment_W;
    }
    const Eigen::Matrix3d R_LW = (own.R_WB * subtree.carrier.pose.linear()).transpose();
    wrenches.push_back({subtree.link, R_LW * force, R_LW * moment});
  }
}

}  // namespace tactus::sim
