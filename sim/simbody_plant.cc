#include "sim/simbody_plant.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/joint_resistance.h"
#include "sim/link_wrenches.h"
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

/// The scene, when the plant can touch all its shapes.
const description::Scene& checkedShapes(const description::Scene& scene) {
  for (const description::Object& object : scene.objects)
    for (const description::Primitive& primitive : object.primitives)
      if (!primitive.shape->isConvex())
        throw runtime::PlantError("object '" + object.name + "' has a shape that is not convex: make it a union of convex ones");
  return scene;
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
        robot_(checkedJoints(robot), scene.gravity),
        state_(robot_.defaultState()),
        contact_(movingFeatures(robot), checkedShapes(scene), robot_.matter().getNumBodies(), options.contact),
        motions_(robot_.matter().getNumBodies()),
        q_(checkedStart(robot, start_q)),
        qd_(Eigen::VectorXd::Zero(robot_.dof())),
        resistance_(robot, effectiveInertia(), options.step),
        joint_torque_(robot_.dof()),
        mobility_forces_(robot_.dof(), 0.0),
        accelerations_(robot_.dof(), 0.0),
        wrenches_(robot, carriers(robot), options.wrench_links, scene.gravity),
        changes_(motions_.size()) {
    sensed_.contacts.reserve(contact_.capacity());
    sensed_.wrenches.reserve(options.wrench_links.size());
    realize();
    contact_.evaluate(motions_, options_.step);
    fillSensed();
  }

  const control::Sensed& sense() const { return sensed_; }

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

  /// The features of links that can move, each in the frame of its mobilized body.  What is fixed to the world
  /// cannot be pushed: it touches nothing.
  std::vector<LinkFeature> movingFeatures(const description::Robot& robot) const {
    std::vector<LinkFeature> features = linkFeatures(robot);
    for (LinkFeature& feature : features) {
      const Eigen::Isometry3d& X_BL = robot_.poseInCarrier(feature.link);
      feature.body = robot_.carrier(feature.link).getMobilizedBodyIndex();
      feature.from = X_BL * feature.from;
      feature.to = X_BL * feature.to;
    }
    std::erase_if(features, [](const LinkFeature& feature) { return feature.body == 0; });
    return features;
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

  void realizePosition() {
    toEigen(state_.updQ()) = q_;
    robot_.system().realize(state_, SimTK::Stage::Position);
  }

  /// Brings Simbody and the body motions to (q_, qd_).
  void realize() {
    toEigen(state_.updQ()) = q_;
    toEigen(state_.updU()) = qd_;
    robot_.system().realize(state_, SimTK::Stage::Dynamics);
    for (SimTK::MobilizedBodyIndex b(1); b < robot_.matter().getNumBodies(); ++b) {
      const SimTK::MobilizedBody& body = robot_.matter().getMobilizedBody(b);
      const SimTK::Transform& X_WB = body.getBodyTransform(state_);
      const SimTK::SpatialVec& V_WB = body.getBodyVelocity(state_);
      motions_[b] = {toEigen(X_WB.R()), toEigen(X_WB.p()), toEigen(V_WB[0]), toEigen(V_WB[1])};
    }
  }

  void step(const Eigen::VectorXd& torque, bool last) {
    joint_torque_ = torque;
    resistance_.add(q_, qd_, joint_torque_);
    toEigen(mobility_forces_) = joint_torque_;
    robot_.gravityForces(state_, body_forces_);
    for (SimTK::MobilizedBodyIndex b(1); b < body_forces_.size(); ++b) {
      const BodyWrench& wrench = contact_.wrenches()[b];
      body_forces_[b] += SimTK::SpatialVec(toSimTK(wrench.torque_W), toSimTK(wrench.force_W));
    }

    last_q_ = q_;
    last_qd_ = qd_;
    try {
      robot_.matter().calcAccelerationIgnoringConstraints(state_, mobility_forces_, body_forces_, accelerations_,
                                                          body_accelerations_);
      if (last) senseWrenches();
      qd_ += options_.step * toEigen(accelerations_);
      q_ += options_.step * qd_;
      checkSpeed();
      realize();
    } catch (const runtime::PlantError&) {
      takeBack();
      throw;
    } catch (const SimTK::Exception::Base& error) {
      takeBack();
      throw runtime::PlantError("Simbody failed at t = " + print(roundedTime(steps_)) + " s: " + error.getMessage() +
                                ". " + usual_causes);
    }
    ++steps_;
    contact_.commit();
    resistance_.commit();
    contact_.evaluate(motions_, options_.step);
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
    realize();
  }

  void checkSpeed() const {
    for (int i = 0; i < robot_.dof(); ++i)
      if (!std::isfinite(qd_[i]))
        throw runtime::PlantError("joint '" + names_[i].name + "' is lost: its speed is " + print(qd_[i]) + " at t = " +
                                  print(roundedTime(steps_ + 1)) + " s. " + usual_causes);
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
  }

  PlantOptions options_;
  std::vector<JointName> names_;
  SimbodyRobot robot_;
  SimTK::State state_;
  ContactForce contact_;
  std::vector<BodyMotion> motions_;                                // by mobilized body; 0 is Ground, which rests
  Eigen::VectorXd q_, qd_;
  JointResistance resistance_;
  Eigen::VectorXd joint_torque_, last_q_, last_qd_;
  SimTK::Vector mobility_forces_, accelerations_;
  SimTK::Vector_<SimTK::SpatialVec> body_forces_, body_accelerations_;
  LinkWrenches wrenches_;
  std::vector<BodyAcceleration> changes_;                          // by mobilized body; Ground rests
  std::int64_t steps_ = 0;
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

void SimbodyPlant::advance(const Eigen::VectorXd& torque, double duration) {
  implementation_->advance(torque, duration);
}

}  // namespace tactus::sim
