#include "dsl/stack.h"

#include <algorithm>

#include "framework/control/random.h"
#include "framework/dynamics/inverse_kinematics.h"
#include "framework/dynamics/kinematics.h"

namespace tactus::dsl {
namespace {

Eigen::Vector3d draw(const ObjectDescription& object, std::uint64_t seed) {
  control::SplitMix64 random(control::seedOf(seed, object.object.name));
  Eigen::Vector3d shift;
  for (int i = 0; i < 3; ++i) shift[i] = object.jitter[i] * random.symmetric();
  return shift;
}

}  // namespace

std::vector<const ElementInstance*> Stack::sources() const {
  std::vector<const ElementInstance*> found;
  for (const ElementInstance& sensor : sensors) found.push_back(&sensor);
  for (const ElementInstance& signal : signals) found.push_back(&signal);
  return found;
}

const ElementInstance* Stack::source(std::string_view name) const {
  for (const ElementInstance* source : sources())
    if (source->name == name) return source;
  return nullptr;
}

description::Scene Stack::scene(std::uint64_t seed) const {
  description::Scene scene;
  scene.gravity = gravity;
  for (const ObjectDescription& described : objects) {
    description::Object object = described.object;
    const ObjectDescription* mover = &described;
    for (std::size_t i = 0; seed != 0 && mover && i < objects.size(); ++i) {
      const Eigen::Vector3d shift = draw(*mover, seed);
      object.pose.translation() += shift;
      for (description::Waypoint& waypoint : object.path) waypoint.pose.translation() += shift;
      const auto carrier = std::find_if(objects.begin(), objects.end(),
                                        [&](const auto& other) { return other.object.name == mover->on; });
      mover = mover->on.empty() || carrier == objects.end() ? nullptr : &*carrier;
    }
    scene.objects.push_back(std::move(object));
  }
  constexpr int closest = 4;
  for (int closeness = 0; closeness <= closest; ++closeness)
    for (const PairDescription& described : pairs)
      if (described.closeness == closeness)
        scene.pairs.insert(scene.pairs.end(), described.pairs.begin(), described.pairs.end());
  return scene;
}

Eigen::VectorXd Stack::start(std::uint64_t seed) const {
  Eigen::VectorXd q = start_q;
  if (seed == 0) return q;
  control::SplitMix64 random(control::seedOf(seed, "start"));
  const std::vector<int> moving = robot.movingJoints();
  if (!start_jitter.joints.isZero(0))
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const description::Joint& joint = robot.joints[static_cast<std::size_t>(moving[static_cast<std::size_t>(i)])];
      q[i] = std::clamp(q[i] + start_jitter.joints[i] * random.symmetric(), joint.lower, joint.upper);
    }
  if (start_jitter.link < 0 || start_jitter.pose.isZero(0)) return q;
  Eigen::Matrix<double, 6, 1> shift;
  for (int i = 0; i < 6; ++i) shift[i] = start_jitter.pose[i] * random.symmetric();
  const dynamics::Model model(robot);
  dynamics::Workspace workspace(model);
  dynamics::forwardKinematics(model, q, workspace);
  const Eigen::Isometry3d X_WL = dynamics::framePose(model, workspace, start_jitter.link);
  const Eigen::Vector3d turn = shift.tail<3>();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(turn.norm(), turn.norm() > 0 ? turn.normalized() : Eigen::Vector3d::UnitX())
                                .toRotationMatrix();
  return dynamics::inverseKinematics(
             model, {{start_jitter.link, X_WL.translation() + shift.head<3>(), R * X_WL.linear()}}, q)
      .q;
}

}  // namespace tactus::dsl
