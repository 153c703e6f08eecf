#include "framework/description/combine.h"

#include <set>
#include <stdexcept>

namespace tactus::description {
namespace {

Link worldLink() {
  Link world;
  world.name = "world";
  return world;
}

}  // namespace

Robot combine(const std::string& name, const std::vector<Member>& members) {
  Robot combined;
  combined.name = name;
  combined.links.push_back(worldLink());
  std::set<std::string> taken;
  for (const Member& member : members) {
    if (!taken.insert(member.name).second)
      throw std::invalid_argument("two members of '" + name + "' are called '" + member.name + "'");
    const std::string prefix = member.name + "/";
    const int first_link = static_cast<int>(combined.links.size());
    Joint mount;
    mount.name = prefix + "mount";
    mount.parent = 0;
    mount.child = first_link + member.robot.root;
    mount.origin = member.pose;
    mount.place = member.robot.place;
    combined.joints.push_back(mount);
    const int first_joint = static_cast<int>(combined.joints.size());
    for (Link link : member.robot.links) {
      link.name = prefix + link.name;
      combined.links.push_back(std::move(link));
    }
    for (Joint joint : member.robot.joints) {
      joint.name = prefix + joint.name;
      joint.parent += first_link;
      joint.child += first_link;
      if (joint.mimic) joint.mimic->driver += first_joint;
      combined.joints.push_back(std::move(joint));
    }
    for (const LinkPair& pair : member.robot.self_contact)
      combined.self_contact.push_back({pair.one + first_link, pair.other + first_link});
    for (const std::string& link : member.robot.skin) combined.skin.push_back(prefix + link);
    const auto addGroups = [&](const std::vector<Group>& groups, std::vector<Group>& into) {
      for (Group group : groups) {
        group.name = prefix + group.name;
        for (std::string& one : group.members) one = prefix + one;
        into.push_back(std::move(group));
      }
    };
    addGroups(member.robot.link_groups, combined.link_groups);
    addGroups(member.robot.joint_groups, combined.joint_groups);
  }
  return combined;
}

Robot withFloatingBase(Robot robot, const std::string& name) {
  Joint base;
  base.name = name;
  base.type = JointType::floating;
  base.parent = static_cast<int>(robot.links.size());
  base.child = robot.root;
  base.place = robot.place;
  robot.links.push_back(worldLink());
  robot.root = base.parent;
  robot.joints.push_back(std::move(base));
  return robot;
}

}  // namespace tactus::description
