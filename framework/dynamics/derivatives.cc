#include "framework/dynamics/derivatives.h"

#include "framework/dynamics/crba.h"
#include "framework/dynamics/rnea.h"
#include "framework/dynamics/skew.h"

// When coordinate k moves, all that hangs on body k turns with the screw S_k.  Were velocities and accelerations turned
// along with it, every force would just turn too: S_k ×* f.  They are not, for the part that the bodies before k give
// them stays.  With Ṡ = v₀ × S, S̈ = a₀ × S + v₀ × Ṡ, where v₀, a₀ are those of the body that carries the axis,
//
//   ∂f_j/∂q_k = S_k ×* f_j + I_j S̈_k + B_j Ṡ_k,      B_j w = v_j ×* (I_j w) − I_j (v_j × w) + w ×* (I_j v_j),
//   ∂f_j/∂q̇_k = I_j W_k + B_j S_k,                   W_k = Ṡ_k + v₁ × S_k, v₁ of the body that the joint moves,
//
// for every body j of the subtree of k; I and B add up over subtrees, and τ_i = S_iᵀ Σ f.
namespace tactus::dynamics {
namespace {

/// v × as a matrix, (2.33); that of v ×* is −(v ×)ᵀ.
Matrix6d crossMatrix(const MotionVector& v) {
  Matrix6d matrix;
  matrix << skew(v.angular()), skew(v.linear()), Eigen::Matrix3d::Zero(), skew(v.angular());
  return matrix;
}

/// w ↦ w ×* h.
Matrix6d momentumCross(const ForceVector& h) {
  Matrix6d matrix;
  matrix << Eigen::Matrix3d::Zero(), -skew(h.force()), -skew(h.force()), -skew(h.moment());
  return matrix;
}

ForceVector times(const Matrix6d& B, const MotionVector& w) { return ForceVector(Vector6d(B * w.coordinates())); }

bool isBall(Motion motion) { return motion != Motion::rotation && motion != Motion::translation; }

/// Do both axes belong to one spherical joint?  Then both turn with the child.
bool sameBall(const Model& model, int i, int k) {
  const auto& bodies = model.bodies();
  return isBall(bodies[i].motion) && isBall(bodies[k].motion) && bodies[i].position == bodies[k].position;
}

}  // namespace

DynamicsDerivatives::DynamicsDerivatives(const Model& model)
    : model_(&model),
      forward_(model),
      factor_(model),
      rates_(model.bodyCount()),
      torque_(model.dof()),
      acceleration_(model.dof()) {
  for (Eigen::MatrixXd* matrix : {&mass_matrix_, &torque_by_q_, &torque_by_qd_, &acceleration_by_q_,
                                  &acceleration_by_qd_, &acceleration_by_tau_})
    matrix->setZero(model.dof(), model.dof());
}

void DynamicsDerivatives::computeInverse(const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                                         const Eigen::VectorXd& qdd, const Eigen::Vector3d& gravity_W,
                                         Workspace& workspace, const ExternalForces* external) {
  rnea(*model_, q, qd, qdd, gravity_W, workspace, torque_, external);
  worldInertias(*model_, workspace);
  // What turns with the bodies is what they themselves need, not what pushes them from outside.
  if (external)
    for (int i = 0; i < model_->bodyCount(); ++i)
      for (int j = i; j >= 0; j = model_->parent(j)) workspace.bodies[j].force += external->of(i);
  prepareBodies(baseAcceleration(gravity_W), workspace);
  torque_by_q_.setZero();
  torque_by_qd_.setZero();
  for (int k = 0; k < model_->bodyCount(); ++k) fillColumn(k, workspace);
  if (!external) return;
  // The force from outside stays while the axes below k turn: τ_i loses (S_k × S_i)ᵀ f for i in the subtree.
  for (int k = 0; k < model_->bodyCount(); ++k) {
    const Model::Body& moved = model_->bodies()[k];
    const int first = isBall(moved.motion) ? k - (static_cast<int>(moved.motion) - static_cast<int>(Motion::ball_x)) : k;
    for (int j = first; j < model_->subtreeEnd(k); ++j)
      for (int i = j; i >= first; i = model_->parent(i))
        if (i >= k || sameBall(*model_, i, k))
          torque_by_q_(model_->bodies()[i].coordinate, moved.coordinate) -=
              workspace.bodies[k].axis.cross(workspace.bodies[i].axis).dot(external->of(j));
  }
}

void DynamicsDerivatives::prepareBodies(const MotionVector& base, Workspace& workspace) {
  compositeInertias(*model_, workspace);
  for (int i = 0; i < model_->bodyCount(); ++i) {
    const Model::Body& body = model_->bodies()[i];
    const BodyState& state = workspace.bodies[i];
    BodyRates& rates = rates_[i];
    const MotionVector& S = state.axis;
    if (body.carrier < 0) {
      rates.axis_rate = MotionVector::Zero();
      rates.axis_rate_2 = base.cross(S);
    } else {
      const BodyState& carrier = workspace.bodies[body.carrier];
      rates.axis_rate = carrier.velocity.cross(S);
      rates.axis_rate_2 = carrier.acceleration.cross(S) + carrier.velocity.cross(rates.axis_rate);
    }
    const int last = i + (isBall(body.motion) ? static_cast<int>(Motion::ball_z) - static_cast<int>(body.motion) : 0);
    rates.velocity_change = rates.axis_rate + workspace.bodies[last].velocity.cross(S);
    const Matrix6d v_cross = crossMatrix(state.velocity), I = state.inertia.matrix();
    rates.momentum_rate = momentumCross(state.inertia * state.velocity);
    rates.momentum_rate.noalias() -= v_cross.transpose() * I;
    rates.momentum_rate.noalias() -= I * v_cross;
  }
  for (int i = model_->bodyCount() - 1; i >= 0; --i)
    if (const int parent = model_->parent(i); parent >= 0) rates_[parent].momentum_rate += rates_[i].momentum_rate;
}

void DynamicsDerivatives::fillColumn(int k, const Workspace& workspace) {
  const int column = model_->bodies()[k].coordinate;
  const auto add = [&](int i, double by_q, double by_qd) {
    torque_by_q_(model_->bodies()[i].coordinate, column) += by_q;
    torque_by_qd_(model_->bodies()[i].coordinate, column) += by_qd;
  };
  const BodyState& state = workspace.bodies[k];
  const BodyRates& rates = rates_[k];
  const ForceVector stays =
      state.composite * rates.axis_rate_2 + times(rates.momentum_rate, rates.axis_rate);
  const ForceVector by_qd = state.composite * rates.velocity_change + times(rates.momentum_rate, state.axis);
  const ForceVector turned = stays + state.axis.cross(state.force);
  for (int i = k; i >= 0; i = model_->parent(i)) {
    const MotionVector& S = workspace.bodies[i].axis;
    // An axis that turns along, that of the ball that k belongs to, does not see its force turn.
    add(i, S.dot(i == k || sameBall(*model_, i, k) ? stays : turned), S.dot(by_qd));
  }
  for (int i = k + 1; i < model_->subtreeEnd(k); ++i) {
    const BodyState& below = workspace.bodies[i];
    const ForceVector IS = below.composite * below.axis;
    const ForceVector BS(Vector6d(rates_[i].momentum_rate.transpose() * below.axis.coordinates()));
    add(i, rates.axis_rate_2.dot(IS) + rates.axis_rate.dot(BS), rates.velocity_change.dot(IS) + state.axis.dot(BS));
  }
}

void DynamicsDerivatives::computeForward(const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                                         const Eigen::VectorXd& tau, const Eigen::Vector3d& gravity_W,
                                         Workspace& workspace, const ExternalForces* external) {
  forward_.compute(q, qd, tau, gravity_W, workspace, acceleration_, external);
  computeInverse(q, qd, acceleration_, gravity_W, workspace, external);
  mass_matrix_.setZero();
  massMatrixSweep(*model_, workspace, mass_matrix_);
  factor_.compute(mass_matrix_);
  acceleration_by_q_ = -torque_by_q_;
  acceleration_by_qd_ = -torque_by_qd_;
  acceleration_by_tau_.setIdentity();
  factor_.solveInPlace(acceleration_by_q_);
  factor_.solveInPlace(acceleration_by_qd_);
  factor_.solveInPlace(acceleration_by_tau_);
}

}  // namespace tactus::dynamics
