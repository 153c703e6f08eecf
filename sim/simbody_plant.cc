#include "sim/simbody_plant.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/joint_resistance.h"
#include "sim/link_wrenches.h"
#include "sim/object_path.h"
#include "sim/simbody_robot.h"

namespace tactus::sim {
namespace {

std::string print(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

const char* unitOf(description::JointType type) { return type == description::JointType::prismatic ? "m" : "rad"; }

/// The robot, when the plant can move all its joints.
const description::Robot& checkedJoints(const description::Robot& robot) {
  for (const description::Joint& joint : robot.joints) {
    if (joint.mimic)
      throw runtime::PlantError("joint '" + joint.name +
                                "' follows another joint: the plant moves every joint on its own");
    if (description::velocityCount(joint.type) > 1)
      throw runtime::PlantError("joint '" + joint.name +
                                "' has several degrees of freedom: the plant has revolute, continuous and prismatic "
                                "joints only");
  }
  return robot;
}

bool isForceMoved(const description::Object& object) {
  return object.mobility == description::Mobility::free || object.mobility == description::Mobility::held;
}

/// The objects that forces move, in the order of the scene.
std::vector<FreeBody> freeBodies(const description::Scene& scene) {
  std::vector<FreeBody> bodies;
  for (const description::Object& object : scene.objects) {
    const auto refuse = [&](const std::string& why) { throw runtime::PlantError("object '" + object.name + "' " + why); };
    if (object.mobility != description::Mobility::fixed)
      for (const description::Primitive& primitive : object.primitives)
        if (std::isinf(primitive.shape->boundingRadius())) refuse("has a shape without end: it cannot move");
    if (!isForceMoved(object)) continue;
    if (!(object.mass.mass > 0) || !std::isfinite(object.mass.mass)) refuse("moves, but has no mass");
    bodies.push_back({object.name, object.mass, object.pose});
  }
  return bodies;
}

/// Of what touches what: Hunt–Crossley springs in series, the dissipation of the softer, the smaller friction, the
/// greater resistance to rolling.
description::ContactMaterial together(const description::ContactMaterial& a, const description::ContactMaterial& b) {
  const double stiffness = a.stiffness * b.stiffness / (a.stiffness + b.stiffness);
  return {stiffness, a.stiffness < b.stiffness ? a.dissipation : b.dissipation, std::min(a.friction, b.friction),
          std::max(a.rolling, b.rolling)};
}

constexpr const char* usual_causes =
    "Usual causes: damping gains too high for the joint's inertia at this control rate (keep d·dt/I below 0.5), a mass "
    "matrix of the controller that lacks the rotor inertia, delay, or a start inside an object.";

}  // namespace

class SimbodyPlant::Implementation {
 public:
  Implementation(const description::Robot& robot, const description::Scene& scene, const Eigen::VectorXd& start_q,
                 const PlantOptions& options)
      : options_(options),
        names_(jointNames(robot)),
        scene_(scene),
        robot_(checkedJoints(robot), scene.gravity, freeBodies(scene)),
        state_(robot_.defaultState()),
        objects_(placeObjects()),
        motions_(static_cast<size_t>(robot_.matter().getNumBodies() + movedObjects())),
        contact_(makeContact(robot)),
        q_(checkedStart(robot, start_q)),
        qd_(Eigen::VectorXd::Zero(robot_.dof())),
        resistance_(robot, effectiveInertia(), options.step),
        joint_torque_(robot_.dof()),
        mobility_forces_(state_.getNU(), 0.0),
        accelerations_(state_.getNU(), 0.0),
        last_free_(free_),
        wrenches_(robot, carriers(robot), options.wrench_links, scene.gravity),
        changes_(motions_.size()) {
    sensed_.contacts.reserve(contact_.capacity());
    sensed_.wrenches.reserve(options.wrench_links.size());
    realize();
    contact_.evaluate(motions_, options_.step);
    fillSensed();
  }

  const control::Sensed& sense() const { return sensed_; }
  std::span<const control::ObjectMotion> objects() const { return motions_of_objects_; }

  void advance(const Eigen::VectorXd& torque, double duration) {
    const double wanted = duration / options_.step;
    const double count = std::round(wanted);
    if (!(count >= 0) || std::abs(wanted - count) > 1e-6)
      throw runtime::PlantError("cannot advance by " + print(duration) + " s: not a whole number of steps of " +
                                print(options_.step) + " s");
    checkTorque(torque);
    try {
      const auto steps = static_cast<std::int64_t>(count);
      for (std::int64_t i = 0; i < steps; ++i) step(torque, i + 1 == steps);
    } catch (...) {
      fillSensed();
      throw;
    }
    fillSensed();
  }

 private:
  struct JointName {
    std::string name;
    const char* unit;
  };

  static std::vector<JointName> jointNames(const description::Robot& robot) {
    std::vector<JointName> names;
    for (int j : robot.movingJoints()) names.push_back({robot.joints[j].name, unitOf(robot.joints[j].type)});
    return names;
  }

  /// An object's body, as contact numbers them: Simbody's, then those that follow a path, or `world_body`.
  struct ObjectBody {
    int body = world_body;
    int free = -1;                                                 // index among those that forces move
  };
  /// What the plant integrates of a free body.
  struct FreeState {
    Eigen::Quaterniond rotation;
    Eigen::Vector3d place, angular_W, linear_W;
  };

  int movedObjects() const {
    int count = 0;
    for (const description::Object& object : scene_.objects) count += object.mobility == description::Mobility::moved;
    return count;
  }

  std::vector<ObjectBody> placeObjects() {
    std::vector<ObjectBody> bodies;
    int moved = robot_.matter().getNumBodies();
    for (description::Object& object : scene_.objects) {
      ObjectBody body;
      if (object.path.empty()) object.path = {{0, object.pose}};
      if (isForceMoved(object)) {
        body.free = static_cast<int>(free_.size());
        body.body = robot_.freeBody(body.free);
        free_.push_back({Eigen::Quaterniond(object.pose.linear()), object.pose.translation(), Eigen::Vector3d::Zero(),
                         Eigen::Vector3d::Zero()});
      } else if (object.mobility == description::Mobility::moved) {
        body.body = moved++;
      }
      bodies.push_back(body);
    }
    motions_of_objects_.resize(bodies.size());
    return bodies;
  }

  /// The features of links that can move, each in the frame of its mobilized body.  What is fixed to the world
  /// cannot be pushed: it feels nothing.
  std::vector<Feature> movingFeatures(const description::Robot& robot) const {
    std::vector<Feature> features = linkFeatures(robot);
    for (Feature& feature : features) {
      const Eigen::Isometry3d& X_BL = robot_.poseInCarrier(feature.owner.link);
      feature.body = robot_.carrier(feature.owner.link).getMobilizedBodyIndex();
      feature.feeler.from = X_BL * feature.feeler.from;
      feature.feeler.to = X_BL * feature.feeler.to;
    }
    std::erase_if(features, [](const Feature& feature) { return feature.body == 0; });
    return features;
  }

  /// What holds between two, where a pair of the scene says nothing else.
  description::ContactMaterial material(const Owner& one, const Owner& other,
                                        const description::ContactMaterial& usual) const {
    return description::materialOf(scene_, partyOf(one), partyOf(other), usual);
  }

  /// Links feel all objects, and those of self-contact each other.  Objects of which one moves feel each other: one
  /// whose feelers are all round feels for both, else each for itself.
  ContactForce makeContact(const description::Robot& robot) const {
    std::vector<Feature> features = movingFeatures(robot);
    std::vector<Collider> colliders;
    for (int i = 0; i < static_cast<int>(scene_.objects.size()); ++i)
      for (Collider& collider : objectColliders(scene_.objects[i], i)) {
        collider.body = objects_[i].body;
        if (collider.body == world_body) collider.pose = scene_.objects[i].pose * collider.pose;
        colliders.push_back(std::move(collider));
      }
    std::vector<SurfacePair> pairs;
    for (int f = 0; f < static_cast<int>(features.size()); ++f)
      for (int c = 0; c < static_cast<int>(colliders.size()); ++c)
        pairs.push_back({f, c, material(features[f].owner, colliders[c].owner,
                                        scene_.objects[colliders[c].owner.object].material)});
    const auto links = static_cast<int>(features.size());
    addObjectPairs(features, colliders, pairs);
    addSelfPairs(robot, links, features, colliders, pairs);
    return ContactForce(std::move(features), std::move(colliders), std::move(pairs),
                        static_cast<int>(motions_.size()), options_.contact);
  }

  void addObjectPairs(std::vector<Feature>& features, const std::vector<Collider>& colliders,
                      std::vector<SurfacePair>& pairs) const {
    const int objects = static_cast<int>(scene_.objects.size());
    const bool none_moves = std::all_of(scene_.objects.begin(), scene_.objects.end(),
                                        [](const auto& object) { return !isForceMoved(object); });
    if (none_moves) return;
    std::vector<int> first(objects);
    std::vector<bool> round(objects, true);
    for (int i = 0; i < objects; ++i) {
      first[i] = static_cast<int>(features.size());
      for (Feature& feature : objectFeatures(scene_.objects[i], i)) {
        feature.body = objects_[i].body;
        if (feature.body == world_body) {
          feature.feeler.from = scene_.objects[i].pose * feature.feeler.from;
          feature.feeler.to = scene_.objects[i].pose * feature.feeler.to;
        }
        round[i] = round[i] && feature.feeler.radius > 0;
        features.push_back(feature);
      }
      round[i] = round[i] && first[i] < static_cast<int>(features.size());
    }
    for (int f = first.front(); f < static_cast<int>(features.size()); ++f)
      for (int c = 0; c < static_cast<int>(colliders.size()); ++c) {
        const int a = features[f].owner.object, b = colliders[c].owner.object;
        if (a == b || !(isForceMoved(scene_.objects[a]) || isForceMoved(scene_.objects[b]))) continue;
        if (round[b] && (!round[a] || b < a)) continue;            // b feels for both
        pairs.push_back({f, c, material(features[f].owner, colliders[c].owner,
                                        together(scene_.objects[a].material, scene_.objects[b].material))});
      }
  }

  /// Of two links of Robot::self_contact the capsules of one feel the shapes of the other: a box is felt rather than
  /// feels, and what is fixed to the world is felt; else the first one feels.  `links`: so many features are links'.
  void addSelfPairs(const description::Robot& robot, int links, const std::vector<Feature>& features,
                    std::vector<Collider>& colliders, std::vector<SurfacePair>& pairs) const {
    if (robot.self_contact.empty()) return;
    const auto isFixed = [&](int link) { return robot_.carrier(link).getMobilizedBodyIndex() == 0; };
    const auto feels = [&](const description::LinkPair& pair) {
      const auto hasBox = [&](int link) {
        return std::any_of(robot.links[link].shapes.begin(), robot.links[link].shapes.end(), [](const auto& shape) {
          return std::holds_alternative<description::BoxShape>(shape);
        });
      };
      if (isFixed(pair.one) != isFixed(pair.other)) return isFixed(pair.one) ? pair.other : pair.one;
      return hasBox(pair.one) && !hasBox(pair.other) ? pair.other : pair.one;
    };
    const auto first = static_cast<int>(colliders.size());
    for (Collider& collider : linkColliders(robot)) {
      const int link = collider.owner.link;
      const bool touches = std::any_of(robot.self_contact.begin(), robot.self_contact.end(), [link](const auto& pair) {
        return pair.one == link || pair.other == link;
      });
      if (!touches) continue;
      collider.body = isFixed(link) ? world_body : static_cast<int>(robot_.carrier(link).getMobilizedBodyIndex());
      collider.pose = robot_.poseInCarrier(link) * collider.pose;
      colliders.push_back(std::move(collider));
    }
    for (const description::LinkPair& pair : robot.self_contact) {
      const int feeling = feels(pair), felt = feeling == pair.one ? pair.other : pair.one;
      for (int f = 0; f < links; ++f)
        for (int c = first; c < static_cast<int>(colliders.size()); ++c)
          if (features[f].owner.link == feeling && colliders[c].owner.link == felt)
            pairs.push_back({f, c, material(features[f].owner, colliders[c].owner, {})});
    }
  }

  std::vector<LinkWrenches::Carrier> carriers(const description::Robot& robot) const {
    std::vector<LinkWrenches::Carrier> carriers;
    for (int link = 0; link < static_cast<int>(robot.links.size()); ++link)
      carriers.push_back({robot_.carrier(link).getMobilizedBodyIndex(), robot_.poseInCarrier(link)});
    return carriers;
  }

  Eigen::VectorXd checkedStart(const description::Robot& robot, const Eigen::VectorXd& start_q) const {
    constexpr double rounding = 1e-9;
    if (start_q.size() != robot_.dof())
      throw runtime::PlantError("the start has " + std::to_string(start_q.size()) + " values, but robot '" +
                                robot.name + "' has " + std::to_string(robot_.dof()) + " moving joints");
    const std::vector<int> moving = robot.movingJoints();
    for (int i = 0; i < robot_.dof(); ++i) {
      const description::Joint& joint = robot.joints[moving[i]];
      if (!std::isfinite(start_q[i]))
        throw runtime::PlantError("the start of joint '" + joint.name + "' is " + print(start_q[i]));
      if (start_q[i] < joint.lower - rounding || start_q[i] > joint.upper + rounding)
        throw runtime::PlantError("the start of joint '" + joint.name + "' is " + print(start_q[i]) + " " +
                                  names_[i].unit + ", outside its range " + print(joint.lower) + " to " +
                                  print(joint.upper));
    }
    return start_q;
  }

  void checkTorque(const Eigen::VectorXd& torque) const {
    if (torque.size() != robot_.dof())
      throw runtime::PlantError("got " + std::to_string(torque.size()) + " torques for " +
                                std::to_string(robot_.dof()) + " moving joints");
    for (int i = 0; i < robot_.dof(); ++i)
      if (!std::isfinite(torque[i]))
        throw runtime::PlantError("the torque of joint '" + names_[i].name + "' is " + print(torque[i]) + " at t = " +
                                  print(roundedTime(steps_)) +
                                  " s: the controller has lost its numbers, the plant stays where it was");
  }

  /// 1/(M⁻¹)_ii at the start.
  Eigen::VectorXd effectiveInertia() {
    realizePosition();
    SimTK::Matrix inverse;
    robot_.matter().calcMInv(state_, inverse);
    Eigen::VectorXd inertia(robot_.dof());
    for (int i = 0; i < robot_.dof(); ++i) inertia[i] = 1 / inverse(i, i);
    return inertia;
  }

  double time() const { return static_cast<double>(steps_) * options_.step; }
  /// For messages: to a nanosecond.
  double roundedTime(std::int64_t steps) const {
    return std::round(static_cast<double>(steps) * options_.step * 1e9) / 1e9;
  }

  /// Writes what the plant integrates into Simbody's state.
  void setState() {
    auto q = toEigen(state_.updQ());
    auto u = toEigen(state_.updU());
    const Eigen::Index dof = robot_.dof();
    q.head(dof) = q_;
    u.head(dof) = qd_;
    for (size_t i = 0; i < free_.size(); ++i) {
      const FreeState& body = free_[i];
      const Eigen::Index at = static_cast<Eigen::Index>(i);
      q.segment<4>(dof + 7 * at) << body.rotation.w(), body.rotation.x(), body.rotation.y(), body.rotation.z();
      q.segment<3>(dof + 7 * at + 4) = body.place;
      u.segment<3>(dof + 6 * at) = body.angular_W;
      u.segment<3>(dof + 6 * at + 3) = body.linear_W;
    }
  }

  void realizePosition() {
    setState();
    robot_.system().realize(state_, SimTK::Stage::Position);
  }

  /// Brings Simbody and the body motions to (q_, qd_).
  void realize() {
    setState();
    robot_.system().realize(state_, SimTK::Stage::Dynamics);
    for (SimTK::MobilizedBodyIndex b(1); b < robot_.matter().getNumBodies(); ++b) {
      const SimTK::MobilizedBody& body = robot_.matter().getMobilizedBody(b);
      const SimTK::Transform& X_WB = body.getBodyTransform(state_);
      const SimTK::SpatialVec& V_WB = body.getBodyVelocity(state_);
      motions_[b] = {toEigen(X_WB.R()), toEigen(X_WB.p()), toEigen(V_WB[0]), toEigen(V_WB[1])};
    }
    for (size_t i = 0; i < objects_.size(); ++i)
      if (scene_.objects[i].mobility == description::Mobility::moved)
        motions_[objects_[i].body] = motionOn(scene_.objects[i].path, time());
  }

  /// Spring and damper from a held object to where its path is, at the object's origin.
  BodyWrench holdingWrench(size_t object) const {
    const BodyMotion& is = motions_[objects_[object].body];
    const BodyMotion wanted = motionOn(scene_.objects[object].path, time());
    const description::Holder& holder = scene_.objects[object].holder;
    if (time() >= holder.until - 0.5 * options_.step) return {};
    const Eigen::AngleAxisd turn(wanted.R_WB * is.R_WB.transpose());
    BodyWrench wrench;
    wrench.force_W = holder.stiffness * (wanted.p_WB - is.p_WB) + holder.damping * (wanted.linear_W - is.linear_W);
    wrench.torque_W = holder.rotation_stiffness * turn.angle() * turn.axis() +
                      holder.rotation_damping * (wanted.angular_W - is.angular_W);
    return wrench;
  }

  void step(const Eigen::VectorXd& torque, bool last) {
    joint_torque_ = torque;
    resistance_.add(q_, qd_, joint_torque_);
    toEigen(mobility_forces_).head(robot_.dof()) = joint_torque_;
    robot_.gravityForces(state_, body_forces_);
    for (SimTK::MobilizedBodyIndex b(1); b < body_forces_.size(); ++b) {
      const BodyWrench& wrench = contact_.wrenches()[b];
      body_forces_[b] += SimTK::SpatialVec(toSimTK(wrench.torque_W), toSimTK(wrench.force_W));
    }
    for (size_t i = 0; i < objects_.size(); ++i) {
      if (scene_.objects[i].mobility != description::Mobility::held) continue;
      const BodyWrench wrench = holdingWrench(i);
      body_forces_[SimTK::MobilizedBodyIndex(objects_[i].body)] +=
          SimTK::SpatialVec(toSimTK(wrench.torque_W), toSimTK(wrench.force_W));
    }

    last_q_ = q_;
    last_qd_ = qd_;
    last_free_ = free_;
    last_steps_ = steps_;
    try {
      robot_.matter().calcAccelerationIgnoringConstraints(state_, mobility_forces_, body_forces_, accelerations_,
                                                          body_accelerations_);
      if (last) senseWrenches();
      qd_ += options_.step * toEigen(accelerations_).head(robot_.dof());
      q_ += options_.step * qd_;
      stepFreeBodies();
      checkSpeed();
      ++steps_;
      realize();
    } catch (const runtime::PlantError&) {
      takeBack();
      throw;
    } catch (const SimTK::Exception::Base& error) {
      takeBack();
      throw runtime::PlantError("Simbody failed at t = " + print(roundedTime(steps_)) + " s: " + error.getMessage() +
                                ". " + usual_causes);
    }
    contact_.commit();
    resistance_.commit();
    contact_.evaluate(motions_, options_.step);
  }

  void stepFreeBodies() {
    const auto acceleration = toEigen(accelerations_);
    for (size_t i = 0; i < free_.size(); ++i) {
      FreeState& body = free_[i];
      const Eigen::Index at = robot_.dof() + 6 * static_cast<Eigen::Index>(i);
      body.angular_W += options_.step * acceleration.segment<3>(at);
      body.linear_W += options_.step * acceleration.segment<3>(at + 3);
      body.place += options_.step * body.linear_W;
      const double angle = options_.step * body.angular_W.norm();
      if (angle > 0)
        body.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, body.angular_W.normalized())) * body.rotation;
      body.rotation.normalize();
    }
  }

  /// Of the instant at which a step begins: accelerations, motions and contacts belong together there.
  void senseWrenches() {
    if (wrenches_.empty()) return;
    for (SimTK::MobilizedBodyIndex b(1); b < body_accelerations_.size(); ++b)
      changes_[b] = {toEigen(body_accelerations_[b][0]), toEigen(body_accelerations_[b][1])};
    contact_.read(sensed_.contacts);
    wrenches_.evaluate(motions_, changes_, contact_.wrenches(), sensed_.contacts, sensed_.wrenches);
  }

  void takeBack() {
    q_ = last_q_;
    qd_ = last_qd_;
    free_ = last_free_;
    steps_ = last_steps_;
    realize();
  }

  void checkSpeed() const {
    for (int i = 0; i < robot_.dof(); ++i)
      if (!std::isfinite(qd_[i]))
        throw runtime::PlantError("joint '" + names_[i].name + "' is lost: its speed is " + print(qd_[i]) + " at t = " +
                                  print(roundedTime(steps_ + 1)) + " s. " + usual_causes);
    for (size_t i = 0; i < objects_.size(); ++i) {
      if (objects_[i].free < 0) continue;
      const FreeState& body = free_[static_cast<size_t>(objects_[i].free)];
      if (body.linear_W.norm() <= options_.velocity_limit && body.angular_W.norm() <= 100 * options_.velocity_limit) continue;
      throw runtime::PlantError("object '" + scene_.objects[i].name + "' runs away: its speed reaches " +
                                print(body.linear_W.norm()) + " m/s and " + print(body.angular_W.norm()) +
                                " rad/s at t = " + print(roundedTime(steps_ + 1)) + " s. " + usual_causes);
    }
    int fastest = 0;
    if (robot_.dof() == 0 || qd_.cwiseAbs().maxCoeff(&fastest) <= options_.velocity_limit) return;
    throw runtime::PlantError("joint '" + names_[fastest].name + "' runs away: its speed reaches " +
                              print(qd_[fastest]) + " " + names_[fastest].unit + "/s at t = " +
                              print(roundedTime(steps_ + 1)) + " s (limit " + print(options_.velocity_limit) + "). " +
                              usual_causes);
  }

  void fillSensed() {
    sensed_.time = time();
    sensed_.q = q_;
    sensed_.qd = qd_;
    contact_.read(sensed_.contacts);
    for (size_t i = 0; i < objects_.size(); ++i) {
      control::ObjectMotion& motion = motions_of_objects_[i];
      motion.pose = scene_.objects[i].pose;
      if (objects_[i].body == world_body) continue;
      const BodyMotion& body = motions_[objects_[i].body];
      motion.pose.linear() = body.R_WB;
      motion.pose.translation() = body.p_WB;
      motion.angular_W = body.angular_W;
      motion.linear_W = body.linear_W;
    }
  }

  PlantOptions options_;
  std::vector<JointName> names_;
  description::Scene scene_;
  SimbodyRobot robot_;
  SimTK::State state_;
  std::vector<FreeState> free_;                                    // by index among those that forces move
  std::vector<control::ObjectMotion> motions_of_objects_;
  std::vector<ObjectBody> objects_;
  std::vector<BodyMotion> motions_;       // by mobilized body; 0 is Ground, which rests; then objects that follow a path
  ContactForce contact_;
  Eigen::VectorXd q_, qd_;
  JointResistance resistance_;
  Eigen::VectorXd joint_torque_, last_q_, last_qd_;
  SimTK::Vector mobility_forces_, accelerations_;
  SimTK::Vector_<SimTK::SpatialVec> body_forces_, body_accelerations_;
  std::vector<FreeState> last_free_;
  std::int64_t steps_ = 0, last_steps_ = 0;
  LinkWrenches wrenches_;
  std::vector<BodyAcceleration> changes_;                          // by mobilized body; Ground rests
  control::Sensed sensed_;
};

SimbodyPlant::SimbodyPlant(const description::Robot& robot, const description::Scene& scene,
                           const Eigen::VectorXd& start_q, const PlantOptions& options) {
  try {
    implementation_ = std::make_unique<Implementation>(robot, scene, start_q, options);
  } catch (const SimTK::Exception::Base& error) {
    throw runtime::PlantError("Simbody cannot start robot '" + robot.name + "': " + error.getMessage());
  }
}

SimbodyPlant::~SimbodyPlant() = default;

const control::Sensed& SimbodyPlant::sense() const { return implementation_->sense(); }

std::span<const control::ObjectMotion> SimbodyPlant::objects() const { return implementation_->objects(); }

void SimbodyPlant::advance(const Eigen::VectorXd& torque, double duration) {
  implementation_->advance(torque, duration);
}

}  // namespace tactus::sim
