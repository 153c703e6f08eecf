#include "bench/peers/coordinates.h"

namespace tactus::bench {

Coordinates::Coordinates(const Problem& problem, const State& state, const std::vector<int>& first_speed,
                         FloatingBase base)
    : T(Eigen::MatrixXd::Zero(problem.dof, problem.dof)), drift(Eigen::VectorXd::Zero(problem.dof)) {
  for (size_t i = 0; i < problem.bodies.size(); ++i) {
    const Body& body = problem.bodies[i];
    if (body.type != description::JointType::floating) {
      T(first_speed[i], body.coordinate) = 1;
      continue;
    }
    // Ours: velocity in world axes, then angular velocity in those of the body.
    const auto wxyz = state.q.segment<4>(body.position + 3);
    const Eigen::Matrix3d R = Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).toRotationMatrix();
    const Eigen::Vector3d v_W = state.qd.segment<3>(body.coordinate), w_B = state.qd.segment<3>(body.coordinate + 3);
    if (base == FloatingBase::body_axes) {
      T.block<3, 3>(first_speed[i], body.coordinate + 3).setIdentity();
      T.block<3, 3>(first_speed[i] + 3, body.coordinate) = R.transpose();
      drift.segment<3>(first_speed[i] + 3) = -w_B.cross(R.transpose() * v_W);
    } else {
      T.block<3, 3>(first_speed[i], body.coordinate + 3) = R;      // d(R w_B)/dt = R ẇ_B: no drift
      T.block<3, 3>(first_speed[i] + 3, body.coordinate).setIdentity();
    }
  }
}

Results Coordinates::toOurs(Operation operation, const Results& peer, const Eigen::MatrixXd& M) const {
  Results ours;
  if (operation == Operation::forward_dynamics) {
    ours.vector = T.partialPivLu().solve(peer.vector - drift);
  } else if (operation == Operation::rnea) {
    ours.vector = T.transpose() * peer.vector;
  } else if (peer.vector.size() > 0) {
    ours.vector = T.transpose() * (peer.vector + M * drift);
  }
  if (peer.mass_matrix.size() > 0) ours.mass_matrix = T.transpose() * peer.mass_matrix * T;
  if (peer.jacobians.size() > 0) ours.jacobians = peer.jacobians * T;
  return ours;
}

}  // namespace tactus::bench
