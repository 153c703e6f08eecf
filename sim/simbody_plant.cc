#include "sim/simbody_plant.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim/joint_resistance.h"
#include "sim/link_wrenches.h"
#include "sim/object_path.h"
#include "sim/simbody_robot.h"
#include "sim/wrong_mass.h"

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

constexpr std::int64_t most_steps = 1'000'000'000'000'000;         // of a state

constexpr const char* usual_causes =
    "Usual causes: damping gains too high for the joint's inertia at this control rate (keep d·dt/I below 0.5), a mass "
    "matrix of the controller that lacks the rotor inertia, delay, a start inside an object, or a back end that asks too "
    "much of a nearly singular posture (raise its damping or regularisation).";

}  // namespace

class SimbodyPlant::Implementation {
 public:
  Implementation(const description::Robot& robot, const description::Scene& scene, const Eigen::VectorXd& start_q,
                 const PlantOptions& options)
      : options_(options),
        names_(jointNames(robot)),
        scene_(scene),
        weighed_(weigh(checkedJoints(robot))),
        now_(weighed_.front().bodies.get()),
        robot_(now_->robot),
        objects_(placeObjects()),
        motions_(static_cast<size_t>(robot_.matter().getNumBodies() + movedObjects())),
        contact_(makeContact(robot)),
        q_(checkedStart(robot, start_q)),
        qd_(Eigen::VectorXd::Zero(robot_.dof())),
        speed_limits_(speedLimits(robot)),
        resistance_(robot, effectiveInertia(), options.step),
        added_friction_(Eigen::VectorXd::Zero(robot_.dof())),
        joint_torque_(robot_.dof()),
        mobility_forces_(now_->state.getNU(), 0.0),
        accelerations_(now_->state.getNU(), 0.0),
        last_free_(free_),
        external_(motions_.size()),
        changes_(motions_.size()) {
    sensed_.contacts.reserve(contact_.capacity());
    sensed_.wrenches.reserve(options.wrench_links.size());
    for (const description::WrongMass& fault : options_.wrong_masses) records_.push_back({fault.name, "wrong-mass"});
    for (const description::JointFriction& fault : options_.frictions)
      records_.push_back({fault.name, "joint-friction"});
    for (const description::Shove& fault : options_.shoves) records_.push_back({fault.name, "shove"});
    pushes_.reserve(options_.shoves.size());
    noteFaults();
    chooseMasses();
    realize();
    contact_.evaluate(motions_, options_.step);
    fillSensed();
  }

  const control::Sensed& sense() const { return sensed_; }
  std::span<const control::ObjectMotion> objects() const { return motions_of_objects_; }
  void faults(std::vector<const control::FaultRecord*>& records) const {
    for (const control::FaultRecord& record : records_) records.push_back(&record);
  }

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
    noteFaults();
    fillSensed();
  }

  /// Simbody's own state follows from what is archived here.
  void archive(control::Archive& archive) {
    archive.within("world", [&] {
      archive.whole("steps", steps_, 0, most_steps);
      archive("q", q_);
      archive("qd", qd_);
      archive("free-bodies", free_);
      archive("contact", contact_);
      archive("resistance", resistance_);
      archive.growing("wrenches", sensed_.wrenches);
    });
    for (control::FaultRecord& record : records_) archive("fault/" + record.name, record);
    if (!archive.restores()) return;
    checkRestored();
    noteFaults();
    chooseMasses();
    realize();
    contact_.evaluate(motions_, options_.step);
    fillSensed();
  }

 private:
  /// All bodies as they weigh for some time; their places, and where links hang on them, are always the same.
  struct Bodies {
    Bodies(const description::Robot& described, const description::Scene& scene, const std::vector<int>& wrench_links)
        : robot(described, scene.gravity, freeBodies(scene)),
          state(robot.defaultState()),
          wrenches(described, carriers(described, robot), wrench_links, scene.gravity) {}
    SimbodyRobot robot;
    SimTK::State state;
    LinkWrenches wrenches;
  };
  struct Weighed {
    double from;                                                   // s
    std::shared_ptr<Bodies> bodies;                                // one for all periods with the same faults
  };
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
    void archive(control::Archive& archive) {
      archive("rotation", rotation);
      archive("place", place);
      archive("angular", angular_W);
      archive("linear", linear_W);
    }
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

  static std::vector<LinkWrenches::Carrier> carriers(const description::Robot& described, const SimbodyRobot& robot) {
    std::vector<LinkWrenches::Carrier> carriers;
    for (int link = 0; link < static_cast<int>(described.links.size()); ++link)
      carriers.push_back({robot.carrier(link).getMobilizedBodyIndex(), robot.poseInCarrier(link)});
    return carriers;
  }

  /// The first period has no fault yet.
  std::vector<Weighed> weigh(const description::Robot& robot) const {
    std::map<std::vector<bool>, std::shared_ptr<Bodies>> made;
    std::vector<Weighed> weighed;
    for (const MassPeriod& period : massPeriods(options_.wrong_masses)) {
      std::shared_ptr<Bodies>& bodies = made[period.holds];
      if (!bodies) {
        description::Robot heavier = robot;
        description::Scene scene = scene_;
        for (size_t i = 0; i < period.holds.size(); ++i)
          if (period.holds[i]) makeWrong(options_.wrong_masses[i], heavier, scene);
        bodies = std::make_shared<Bodies>(heavier, scene, options_.wrench_links);
      }
      weighed.push_back({period.from, bodies});
    }
    return weighed;
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

  /// A limit of 0 or below is none: files have it where nobody knew.
  Eigen::VectorXd speedLimits(const description::Robot& robot) const {
    Eigen::VectorXd limits = Eigen::VectorXd::Constant(robot_.dof(), options_.velocity_limit);
    const std::vector<int> moving = robot.movingJoints();
    for (int i = 0; i < robot_.dof(); ++i)
      if (const double own = robot.joints[moving[i]].velocity; own > 0)
        limits[i] = std::min(limits[i], options_.overspeed * own);
    return limits;
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

  /// 1/(M⁻¹)_ii at the start; the least of it where masses change.
  Eigen::VectorXd effectiveInertia() {
    Eigen::VectorXd inertia = Eigen::VectorXd::Constant(robot_.dof(), description::infinity);
    for (const Weighed& weighed : weighed_) {
      now_ = weighed.bodies.get();
      realizePosition();
      SimTK::Matrix inverse;
      now_->robot.matter().calcMInv(now_->state, inverse);
      for (int i = 0; i < robot_.dof(); ++i) inertia[i] = std::min(inertia[i], 1 / inverse(i, i));
    }
    return inertia;
  }

  double faultRounding() const { return 1e-6 * options_.step; }

  /// Of the step that begins now.
  void noteFaults() {
    size_t record = 0;
    for (const description::WrongMass& fault : options_.wrong_masses)
      records_[record++].note(time(), fault.window.holds(time(), faultRounding()));
    for (const description::JointFriction& fault : options_.frictions)
      records_[record++].note(time(), fault.window.holds(time(), faultRounding()));
    for (const description::Shove& fault : options_.shoves)
      records_[record++].note(time(), shareOfStep(fault.window) > 0);
  }

  /// What faults make joints rub in the step that begins now.
  void chooseFrictions() {
    if (options_.frictions.empty()) return;
    added_friction_.setZero();
    for (const description::JointFriction& fault : options_.frictions) {
      if (!fault.window.holds(time(), faultRounding())) continue;
      for (size_t i = 0; i < fault.joints.size(); ++i) added_friction_[fault.joints[i]] += fault.torque[i];
    }
    resistance_.setAddedFriction(added_friction_);
  }

  /// The part of the step that begins now which a window covers.
  double shareOfStep(const description::Window& window) const {
    const double covered = std::min(time() + options_.step, window.until) - std::max(time(), window.from);
    if (covered <= faultRounding()) return 0;
    return covered >= options_.step - faultRounding() ? 1 : covered / options_.step;
  }

  /// Bodies as they weigh now; true where that is new.
  bool chooseMasses() {
    Bodies* before = now_;
    for (const Weighed& weighed : weighed_)
      if (weighed.from <= time() + faultRounding()) now_ = weighed.bodies.get();
    return now_ != before;
  }

  /// What contacts, shoves and holders do to the bodies.
  void gatherWrenches() {
    pushes_.clear();
    external_ = contact_.wrenches();
    for (const description::Shove& shove : options_.shoves) {
      const double share = shareOfStep(shove.window);
      if (share <= 0) continue;
      const int body = shove.body.object >= 0
                           ? objects_[static_cast<size_t>(shove.body.object)].body
                           : static_cast<int>(robot_.carrier(shove.body.link).getMobilizedBodyIndex());
      const Eigen::Vector3d point_B =
          shove.body.object >= 0 ? shove.point : robot_.poseInCarrier(shove.body.link) * shove.point;
      const BodyMotion& motion = motions_[static_cast<size_t>(body)];
      const Eigen::Vector3d arm_W = motion.R_WB * point_B;
      BodyWrench& wrench = external_[static_cast<size_t>(body)];
      wrench.force_W += share * shove.force_W;
      wrench.torque_W += share * (shove.moment_W + arm_W.cross(shove.force_W));
      if (shove.body.link >= 0)
        pushes_.push_back({shove.body.link, motion.p_WB + arm_W, share * shove.force_W, share * shove.moment_W});
    }
    for (size_t i = 0; i < objects_.size(); ++i) {
      if (scene_.objects[i].mobility != description::Mobility::held) continue;
      const BodyWrench wrench = holdingWrench(i);
      external_[static_cast<size_t>(objects_[i].body)].force_W += wrench.force_W;
      external_[static_cast<size_t>(objects_[i].body)].torque_W += wrench.torque_W;
    }
  }

  double time() const { return static_cast<double>(steps_) * options_.step; }
  /// For messages: to a nanosecond.
  double roundedTime(std::int64_t steps) const {
    return std::round(static_cast<double>(steps) * options_.step * 1e9) / 1e9;
  }

  /// Writes what the plant integrates into Simbody's state.
  void setState() {
    auto q = toEigen(now_->state.updQ());
    auto u = toEigen(now_->state.updU());
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
    now_->robot.system().realize(now_->state, SimTK::Stage::Position);
  }

  /// Brings Simbody and the body motions to (q_, qd_).
  void realize() {
    setState();
    const SimTK::State& state = now_->state;
    now_->robot.system().realize(state, SimTK::Stage::Dynamics);
    for (SimTK::MobilizedBodyIndex b(1); b < robot_.matter().getNumBodies(); ++b) {
      const SimTK::MobilizedBody& body = now_->robot.matter().getMobilizedBody(b);
      const SimTK::Transform& X_WB = body.getBodyTransform(state);
      const SimTK::SpatialVec& V_WB = body.getBodyVelocity(state);
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
    noteFaults();
    if (chooseMasses()) realize();
    chooseFrictions();
    joint_torque_ = torque;
    resistance_.add(q_, qd_, joint_torque_);
    toEigen(mobility_forces_).head(robot_.dof()) = joint_torque_;
    now_->robot.gravityForces(now_->state, body_forces_);
    gatherWrenches();
    for (SimTK::MobilizedBodyIndex b(1); b < body_forces_.size(); ++b)
      body_forces_[b] += SimTK::SpatialVec(toSimTK(external_[b].torque_W), toSimTK(external_[b].force_W));

    last_q_ = q_;
    last_qd_ = qd_;
    last_free_ = free_;
    last_steps_ = steps_;
    try {
      now_->robot.matter().calcAccelerationIgnoringConstraints(now_->state, mobility_forces_, body_forces_,
                                                               accelerations_, body_accelerations_);
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
    if (now_->wrenches.empty()) return;
    for (SimTK::MobilizedBodyIndex b(1); b < body_accelerations_.size(); ++b)
      changes_[b] = {toEigen(body_accelerations_[b][0]), toEigen(body_accelerations_[b][1])};
    contact_.read(sensed_.contacts);
    now_->wrenches.evaluate(motions_, changes_, external_, sensed_.contacts, sensed_.wrenches, pushes_);
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
    if (robot_.dof() == 0 || (qd_.array().abs() / speed_limits_.array()).maxCoeff(&fastest) <= 1) return;
    throw runtime::PlantError("joint '" + names_[fastest].name + "' runs away: its speed reaches " +
                              print(qd_[fastest]) + " " + names_[fastest].unit + "/s at t = " +
                              print(roundedTime(steps_ + 1)) + " s (limit " + print(speed_limits_[fastest]) + "). " +
                              usual_causes);
  }

  void checkRestored() const {
    constexpr double rounding = 1e-6;
    bool usable = q_.allFinite() && qd_.allFinite();
    for (const FreeState& body : free_)
      usable = usable && body.place.allFinite() && body.linear_W.allFinite() && body.angular_W.allFinite() &&
               std::abs(body.rotation.norm() - 1) < rounding;
    if (!usable) throw control::StateError("the state of the world is none: a place or speed is no number, or a rotation none");
    try {
      checkSpeed();
    } catch (const runtime::PlantError& error) {
      throw control::StateError(error.what());
    }
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
  std::vector<Weighed> weighed_;                                   // by time; one without faults of mass
  Bodies* now_;                                                    // of these, with the state that was set last
  const SimbodyRobot& robot_;                                      // of the first: what all have in common
  std::vector<FreeState> free_;                                    // by index among those that forces move
  std::vector<control::ObjectMotion> motions_of_objects_;
  std::vector<ObjectBody> objects_;
  std::vector<BodyMotion> motions_;       // by mobilized body; 0 is Ground, which rests; then objects that follow a path
  ContactForce contact_;
  Eigen::VectorXd q_, qd_;
  Eigen::VectorXd speed_limits_;                                   // rad/s or m/s, beyond which a joint runs away
  JointResistance resistance_;
  Eigen::VectorXd added_friction_;                                 // N m or N, by faults
  Eigen::VectorXd joint_torque_, last_q_, last_qd_;
  SimTK::Vector mobility_forces_, accelerations_;
  SimTK::Vector_<SimTK::SpatialVec> body_forces_, body_accelerations_;
  std::vector<FreeState> last_free_;
  std::int64_t steps_ = 0, last_steps_ = 0;
  std::vector<control::FaultRecord> records_;                      // wrong masses, frictions, shoves
  std::vector<BodyWrench> external_;                               // by body: contacts, shoves, holders
  std::vector<LinkPush> pushes_;                                   // shoves of links
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

void SimbodyPlant::archive(control::Archive& archive) {
  try {
    implementation_->archive(archive);
  } catch (const SimTK::Exception::Base& error) {
    throw control::StateError("Simbody refuses the state: " + std::string(error.getMessage()));
  }
}
void SimbodyPlant::faults(std::vector<const control::FaultRecord*>& records) const {
  implementation_->faults(records);
}

void SimbodyPlant::advance(const Eigen::VectorXd& torque, double duration) {
  implementation_->advance(torque, duration);
}

}  // namespace tactus::sim
