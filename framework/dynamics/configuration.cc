#include "framework/dynamics/configuration.h"

#include <cmath>

namespace tactus::dynamics {
namespace {

Eigen::Quaterniond quaternionAt(const Eigen::VectorXd& q, int position) {
  return {q[position], q[position + 1], q[position + 2], q[position + 3]};
}

void setQuaternion(const Eigen::Quaterniond& quaternion, int position, Eigen::VectorXd& q) {
  q.segment<4>(position) << quaternion.w(), quaternion.vec();
}

Eigen::Quaterniond unit(const Eigen::Quaterniond& quaternion) {
  const double length = quaternion.norm();
  if (!(length > 0) || !std::isfinite(length)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(quaternion.coeffs() / length);
}

/// exp(ω/2): the turn by |ω| about ω.
Eigen::Quaterniond turn(const Eigen::Vector3d& angle) {
  const double half = 0.5 * angle.norm();
  const double sinc = half > 1e-4 ? std::sin(half) / half : 1 - half * half / 6;
  Eigen::Quaterniond result;
  result.w() = std::cos(half);
  result.vec() = 0.5 * sinc * angle;
  return result;
}

/// The inverse of turn, for a unit quaternion: an angle of at most π.
Eigen::Vector3d angleOf(const Eigen::Quaterniond& quaternion) {
  const double sine = quaternion.vec().norm();
  const double w = quaternion.w();
  if (sine < 1e-9 * std::abs(w)) return 2 / w * quaternion.vec();  // to rounding, as atan x = x − x³/3
  const double half = w < 0 ? std::atan2(-sine, -w) : std::atan2(sine, w);
  return 2 * half / sine * quaternion.vec();
}

/// Calls single(body) for every body with a coordinate of its own along one axis, ball(body) for every quaternion.
template <class Single, class Ball>
void forEachFreeBody(const Model& model, Single single, Ball ball) {
  for (const Model::Joint& joint : model.joints()) {
    if (joint.driver >= 0) continue;
    for (int i = joint.first_body; i < joint.first_body + joint.body_count; ++i) {
      const Model::Body& body = model.bodies()[i];
      if (body.motion == Motion::rotation || body.motion == Motion::translation) single(body);
      if (body.motion == Motion::ball_x) ball(body);
    }
  }
}

}  // namespace

void integrate(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& to) {
  to = q;
  forEachFreeBody(
      model, [&](const Model::Body& body) { to[body.position] += v[body.coordinate]; },
      [&](const Model::Body& body) {
        const Eigen::Quaterniond moved =
            unit(quaternionAt(q, body.position)) * turn(v.segment<3>(body.coordinate));
        setQuaternion(unit(moved), body.position, to);
      });
}

void difference(const Model& model, const Eigen::VectorXd& from, const Eigen::VectorXd& to, Eigen::VectorXd& v) {
  forEachFreeBody(
      model, [&](const Model::Body& body) { v[body.coordinate] = to[body.position] - from[body.position]; },
      [&](const Model::Body& body) {
        const Eigen::Quaterniond start = unit(quaternionAt(from, body.position)), end = unit(quaternionAt(to, body.position));
        v.segment<3>(body.coordinate) = angleOf(start.conjugate() * end);
      });
}

void positionRates(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& rates) {
  forEachFreeBody(
      model, [&](const Model::Body& body) { rates[body.position] = v[body.coordinate]; },
      [&](const Model::Body& body) {
        const Eigen::Vector3d half = 0.5 * v.segment<3>(body.coordinate);
        setQuaternion(quaternionAt(q, body.position) * Eigen::Quaterniond(0, half[0], half[1], half[2]), body.position,
                      rates);
      });
}

void normalise(const Model& model, Eigen::VectorXd& q) {
  forEachFreeBody(
      model, [](const Model::Body&) {},
      [&](const Model::Body& body) { setQuaternion(unit(quaternionAt(q, body.position)), body.position, q); });
}

}  // namespace tactus::dynamics
