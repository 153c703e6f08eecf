#include "tests/witness/mujoco_robot.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "tests/witness/mujoco/mjcf.h"

namespace tactus::witness {
namespace {

using description::Joint;
using description::JointType;
using description::Robot;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

MujocoRobot::MujocoRobot(const Robot& robot, const Eigen::Vector3d& gravity_W)
    : model_(loadMujoco(robot, gravity_W)), data_(mj_makeData(model_.get())) {
  for (int link = 0; link < static_cast<int>(robot.links.size()); ++link)
    bodies_.push_back(link == robot.root ? 0 : mj_name2id(model_.get(), mjOBJ_BODY, robot.links[link].name.c_str()));

  T_ = Eigen::MatrixXd::Zero(dof(), dof());
  int from_q = 0, from_v = 0;
  for (const int j : robot.movingJoints()) {
    const Joint& joint = robot.joints[j];
    addParts(robot, joint, from_q, from_v);
    from_q += description::positionCount(joint.type);
    from_v += description::velocityCount(joint.type);
  }
  if (from_v != dof()) throw std::runtime_error("MuJoCo has other degrees of freedom than the description");
  for (const Part& part : parts_) T_.block(part.to_v, part.from_v, part.count_v, part.count_v).setIdentity();
  for (const FreeJoint& joint : free_joints_) {
    const auto column = std::ranges::find(parts_, joint.to_v, &Part::to_v)->from_v;
    T_.block<3, 3>(joint.to_v, column) = joint.origin.linear();
  }
}

void MujocoRobot::addParts(const Robot& robot, const Joint& joint, int from_q, int from_v) {
  const auto add = [&](const char* suffix) { addPart(joint.name + suffix, from_q, from_v); };
  switch (joint.type) {
    case JointType::fixed: return;
    case JointType::revolute:
    case JointType::prismatic: return add("");
    case JointType::planar:
      for (const char* suffix : {".x", ".y", ".angle"}) add(suffix);
      return;
    case JointType::spherical: return add(".w");
    case JointType::floating: {
      if (!isFreeJoint(robot, joint)) {
        for (const char* suffix : {".x", ".y", ".z", ".w"}) add(suffix);
        return;
      }
      const int first = from_q;
      add("");
      free_joints_.push_back({first, parts_.back().to_q, parts_.back().to_v, joint.origin});
    }
  }
}

void MujocoRobot::addPart(const std::string& mujoco_joint, int& from_q, int& from_v) {
  const int id = mj_name2id(model_.get(), mjOBJ_JOINT, mujoco_joint.c_str());
  if (id < 0) throw std::runtime_error("MuJoCo has no joint '" + mujoco_joint + "'");
  const int type = model_->jnt_type[id];
  const int count_q = type == mjJNT_FREE ? 7 : type == mjJNT_BALL ? 4 : 1;
  const int count_v = type == mjJNT_FREE ? 6 : type == mjJNT_BALL ? 3 : 1;
  parts_.push_back({from_q, model_->jnt_qposadr[id], count_q, from_v, model_->jnt_dofadr[id], count_v});
  from_q += count_q;
  from_v += count_v;
}

void MujocoRobot::set(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& torque) {
  Eigen::Map<Eigen::VectorXd> qpos(data_->qpos, model_->nq);
  for (const Part& part : parts_) qpos.segment(part.to_q, part.count_q) = q.segment(part.from_q, part.count_q);
  for (const FreeJoint& joint : free_joints_) {
    const auto own = q.segment<7>(joint.from_q);
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(joint.origin.linear()) * Eigen::Quaterniond(own[3], own[4], own[5], own[6]);
    qpos.segment<3>(joint.to_q) = joint.origin * Eigen::Vector3d(own.head<3>());
    qpos.segment<4>(joint.to_q + 3) << turn.w(), turn.vec();
  }
  Eigen::Map<Eigen::VectorXd>(data_->qvel, dof()) = T_ * qd;
  Eigen::Map<Eigen::VectorXd>(data_->qfrc_applied, dof()) = T_ * torque;
  mj_forward(model_.get(), data_.get());
}

Eigen::MatrixXd MujocoRobot::massMatrix() const {
  RowMajor M(dof(), dof());
  mj_fullM(model_.get(), M.data(), data_->qM);
  return T_.transpose() * M * T_;
}

Eigen::VectorXd MujocoRobot::bias() const {
  return T_.transpose() * Eigen::Map<const Eigen::VectorXd>(data_->qfrc_bias, dof());
}

Eigen::VectorXd MujocoRobot::acceleration() const {
  return T_.transpose() * Eigen::Map<const Eigen::VectorXd>(data_->qacc, dof());
}

Eigen::VectorXd MujocoRobot::inverseDynamics(const Eigen::VectorXd& qdd) {
  Eigen::Map<Eigen::VectorXd> qacc(data_->qacc, dof());
  const Eigen::VectorXd of_forward = qacc;
  qacc = T_ * qdd;
  mj_inverse(model_.get(), data_.get());
  qacc = of_forward;
  return T_.transpose() * Eigen::Map<const Eigen::VectorXd>(data_->qfrc_inverse, dof());
}

Eigen::Isometry3d MujocoRobot::pose(int link) const {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * bodies_[link]);
  X.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data_->xmat + 9 * bodies_[link]);
  return X;
}

Eigen::MatrixXd MujocoRobot::frameJacobian(int link) const {
  std::vector<double> J(6 * dof());
  mj_jacBody(model_.get(), data_.get(), J.data(), J.data() + 3 * dof(), bodies_[link]);
  return inOurRates(J, 6);
}

Eigen::MatrixXd MujocoRobot::pointJacobian(int link, const Eigen::Vector3d& point_W) const {
  std::vector<double> J(3 * dof());
  mj_jac(model_.get(), data_.get(), J.data(), nullptr, point_W.data(), bodies_[link]);
  return inOurRates(J, 3);
}

Eigen::MatrixXd MujocoRobot::inOurRates(const std::vector<double>& jacobian, int rows) const {
  return Eigen::Map<const RowMajor>(jacobian.data(), rows, dof()) * T_;
}

}  // namespace tactus::witness
