#include "conformance/states.h"

#include <algorithm>
#include <cmath>

namespace tactus::conformance {
namespace {

using control::InWorld;

Eigen::Vector3d rollPitchYaw(const Eigen::Matrix3d& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)), std::atan2(R(1, 0), R(0, 0))};
}

Eigen::Matrix3d rotationOf(const Eigen::Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

void move(std::vector<double>& numbers, InWorld kind, const Eigen::Isometry3d& X) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  if (kind == InWorld::matrix && numbers.size() == 9) {
    Eigen::Map<RowMajor> A(numbers.data());
    A = (X.linear() * A * X.linear().transpose()).eval();
    return;
  }
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    Eigen::Map<Eigen::Vector3d> v(numbers.data() + i);
    if (kind == InWorld::positions) v = (X * v).eval();
    if (kind == InWorld::directions) v = (X.linear() * v).eval();
    if (kind == InWorld::orientation) v = rollPitchYaw(X.linear() * rotationOf(v));
  }
}

void move(control::ElementValues& values, const Eigen::Isometry3d& X) {
  for (const control::AttributeRow& attribute : values.row().attributes) {
    if (attribute.in_world == InWorld::no || !values.has(attribute.name)) continue;
    control::Value value = values.value(attribute.name);
    move(value.numbers, attribute.in_world, X);
    value.text.clear();
    for (std::size_t i = 0; i < value.numbers.size(); ++i) {
      const bool next_group = attribute.type == control::ValueType::points && i > 0 && i % attribute.count == 0;
      value.text += (i == 0 ? "" : next_group ? "; " : " ") + control::formatNumber(value.numbers[i]);
    }
    values.set(attribute.name, std::move(value));
  }
}

}  // namespace

dsl::Stack movedStack(const dsl::Stack& stack, const Eigen::Isometry3d& X) {
  dsl::Stack moved = stack;
  for (description::Joint& joint : moved.robot.joints)
    if (joint.parent == moved.robot.root) joint.origin = X * joint.origin;
  for (dsl::ElementInstance& signal : moved.signals) move(signal.values, X);
  for (dsl::LevelDescription& level : moved.levels) {
    for (dsl::ElementInstance& task : level.tasks) move(task.values, X);
    if (level.controller) move(level.controller->values, X);
  }
  return moved;
}

States::States(const dsl::Stack& stack, unsigned seed, const Eigen::Isometry3d& moved)
    : start_(stack.start_q), q_(start_), qd_(Eigen::VectorXd::Zero(start_.size())), moved_(moved), random_(seed) {
  for (const std::string& name : stack.robot.skin) {
    const int link = stack.robot.linkIndex(name);
    if (link != stack.robot.root) skin_.push_back(link);
  }
}

void States::jump(const Bench& bench) {
  const dynamics::Model& model = bench.robot().model();
  for (int i = 0; i < start_.size(); ++i) {
    const double q = start_[i] + uniform(-0.3, 0.3);
    q_[i] = std::clamp(q, std::min(model.lower()[i] + 0.01, start_[i]), std::max(model.upper()[i] - 0.01, start_[i]));
    qd_[i] = uniform(-0.5, 0.5);
  }
  touches_.clear();
  const double share = std::pow(uniform(0, 1), 2);                 // of the links that touch, often few
  for (const int link : skin_) {
    Touch touch{link, {}, {}, 0};
    for (double& x : touch.point_L) x = uniform(-0.02, 0.02);
    const Eigen::Vector3d normal(uniform(-0.5, 0.5), uniform(-0.5, 0.5), -1);
    touch.normal_W = moved_.linear() * normal.normalized();
    touch.force_N = uniform(0.1, 3);
    if (uniform(0, 1) < share) touches_.push_back(touch);
  }
}

void States::touch(Bench& bench) const {
  bench.sensed.contacts.clear();
  bench.sense();
  for (const Touch& touch : touches_) {
    control::ContactRecord record;
    record.link = touch.link;
    record.object = 0;
    record.point_W = bench.robot().framePose(touch.link) * touch.point_L;
    record.normal_W = touch.normal_W;
    record.force_N = touch.force_N;
    record.depth = touch.force_N / 2000;
    bench.sensed.contacts.push_back(record);
  }
}

void States::next(Bench& bench) {
  if (ticks_++ % kStretch == 0) jump(bench);
  else q_ += bench.period() * qd_;
  for (double& reading : bench.sensed.readings) reading = uniform(0, 1);
  bench.sensed.q = q_;
  bench.sensed.qd = qd_;
  touch(bench);
}

}  // namespace tactus::conformance
