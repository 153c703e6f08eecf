#pragma once

#include "framework/dynamics/forward_dynamics.h"

namespace tactus::dynamics {

/// Derivatives of the dynamics, analytic (Carpentier & Mansard 2018), here in world axes.  A derivative with respect to
/// q is one along q̇'s axes: column k is the rate of change when coordinate k moves at unit rate, which for
/// quaternions is a turn about an axis of the child (see integrate).  Matrices are dof × dof, row i for entry i of the
/// vector that changes.  External forces, where given, keep their value and place in the world.
/// Takes no memory after construction.
class DynamicsDerivatives {
 public:
  explicit DynamicsDerivatives(const Model& model);                ///< the model must outlive it
  explicit DynamicsDerivatives(const Model&&) = delete;

  /// Of inverse dynamics τ(q, q̇, q̈): fills torqueByPosition, torqueByVelocity and torque.
  void computeInverse(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                      const Eigen::Vector3d& gravity_W, Workspace& workspace,
                      const ExternalForces* external = nullptr);
  /// Of forward dynamics q̈(q, q̇, τ): fills everything.
  void computeForward(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& tau,
                      const Eigen::Vector3d& gravity_W, Workspace& workspace,
                      const ExternalForces* external = nullptr);

  const Eigen::VectorXd& torque() const { return torque_; }                  ///< τ
  const Eigen::VectorXd& acceleration() const { return acceleration_; }      ///< q̈
  const Eigen::MatrixXd& torqueByPosition() const { return torque_by_q_; }   ///< ∂τ/∂q
  const Eigen::MatrixXd& torqueByVelocity() const { return torque_by_qd_; }  ///< ∂τ/∂q̇; ∂τ/∂q̈ is M
  const Eigen::MatrixXd& accelerationByPosition() const { return acceleration_by_q_; }   ///< ∂q̈/∂q = −M⁻¹ ∂τ/∂q
  const Eigen::MatrixXd& accelerationByVelocity() const { return acceleration_by_qd_; }  ///< ∂q̈/∂q̇ = −M⁻¹ ∂τ/∂q̇
  const Eigen::MatrixXd& accelerationByTorque() const { return acceleration_by_tau_; }   ///< ∂q̈/∂τ = M⁻¹

 private:
  /// What the derivatives need of a body besides its state.
  struct BodyRates {
    MotionVector axis_rate;                                        // Ṡ
    MotionVector axis_rate_2;                                      // S̈
    MotionVector velocity_change;                                  // of a when q̇_k changes: W
    Matrix6d momentum_rate;                                        // Bᶜ
  };
  void prepareBodies(const MotionVector& base, Workspace& workspace);
  void fillColumn(int body, const Workspace& workspace);

  const Model* model_;
  ForwardDynamics forward_;
  MassMatrixFactor factor_;
  std::vector<BodyRates> rates_;
  Eigen::VectorXd torque_, acceleration_;
  Eigen::MatrixXd mass_matrix_, torque_by_q_, torque_by_qd_, acceleration_by_q_, acceleration_by_qd_,
      acceleration_by_tau_;
};

}  // namespace tactus::dynamics
