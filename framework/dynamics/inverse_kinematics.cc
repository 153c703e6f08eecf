#include "framework/dynamics/inverse_kinematics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>
#include <string>

#include "framework/dynamics/configuration.h"
#include "framework/dynamics/kinematics.h"

namespace tactus::dynamics {
namespace {

/// Damping beyond which no step is worth taking.
constexpr double most_damping = 1e8;

class Search {
 public:
  Search(const Model& model, const std::vector<FrameTarget>& targets, const InverseKinematicsOptions& options)
      : model_(model), targets_(targets), options_(options), workspace_(model), frame_rows_(6, model.dof()) {
    int rows = 0;
    for (const FrameTarget& target : targets) rows += 3 * (target.position_W.has_value() + target.orientation_W.has_value());
    error_.resize(rows);
    jacobian_.resize(rows, model.dof());
  }

  InverseKinematicsResult from(const Eigen::VectorXd& start) {
    InverseKinematicsResult result;
    result.q = start;
    normalise(model_, result.q);
    if (options_.keep_limits) clamp(result.q);
    double damping = options_.damping;
    evaluate(result.q);
    result.error = error_.norm();
    Eigen::VectorXd next(result.q.size());
    while (result.iterations < options_.max_iterations && result.error > options_.tolerance && damping < most_damping) {
      ++result.iterations;
      integrate(model_, result.q, step(result.q, damping), next);
      if (options_.keep_limits) clamp(next);
      evaluate(next);
      if (error_.norm() < result.error) {
        result.q = next;
        result.error = error_.norm();
        damping = std::max(damping / 10, options_.damping);
      } else {
        damping *= 10;
        evaluate(result.q);
      }
    }
    result.reached = result.error <= options_.tolerance;
    return result;
  }

 private:
  /// Errors, target minus frame, and their Jacobian, at q.
  void evaluate(const Eigen::VectorXd& q) {
    forwardKinematics(model_, q, workspace_);
    int row = 0;
    for (const FrameTarget& target : targets_) {
      const Eigen::Isometry3d X_WF = framePose(model_, workspace_, target.frame);
      frameJacobian(model_, workspace_, target.frame, frame_rows_);
      if (target.position_W) {
        error_.segment<3>(row) = *target.position_W - X_WF.translation();
        jacobian_.middleRows<3>(row) = frame_rows_.topRows<3>();
        row += 3;
      }
      if (target.orientation_W) {
        const Eigen::AngleAxisd turn(Eigen::Matrix3d(*target.orientation_W * X_WF.linear().transpose()));
        error_.segment<3>(row) = options_.angle_weight * turn.angle() * turn.axis();
        jacobian_.middleRows<3>(row) = options_.angle_weight * frame_rows_.bottomRows<3>();
        row += 3;
      }
    }
  }

  /// (JᵀJ + damping) v = Jᵀ e over the coordinates that a limit does not stop.
  Eigen::VectorXd step(const Eigen::VectorXd& q, double damping) {
    Eigen::VectorXd pull = jacobian_.transpose() * error_;
    Eigen::MatrixXd J = jacobian_;
    if (options_.keep_limits) {
      for (const Model::Joint& joint : model_.joints()) {
        if (joint.driver >= 0 || joint.coordinate_count > 1) continue;
        const int i = joint.coordinate;
        const bool stopped = (q[joint.position] >= model_.upper()[i] && pull[i] > 0) ||
                             (q[joint.position] <= model_.lower()[i] && pull[i] < 0);
        if (!stopped) continue;
        J.col(i).setZero();
        pull[i] = 0;
      }
    }
    Eigen::MatrixXd H = J.transpose() * J;
    H.diagonal().array() += damping;
    return H.ldlt().solve(pull);
  }

  void clamp(Eigen::VectorXd& q) const {
    for (const Model::Joint& joint : model_.joints())
      if (joint.driver < 0 && joint.coordinate_count == 1)
        q[joint.position] = std::clamp(q[joint.position], model_.lower()[joint.coordinate], model_.upper()[joint.coordinate]);
  }

  const Model& model_;
  const std::vector<FrameTarget>& targets_;
  const InverseKinematicsOptions& options_;
  Workspace workspace_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> frame_rows_;
  Eigen::VectorXd error_;
  Eigen::MatrixXd jacobian_;
};

}  // namespace

InverseKinematicsResult inverseKinematics(const Model& model, const std::vector<FrameTarget>& targets,
                                          const Eigen::VectorXd& start, const InverseKinematicsOptions& options) {
  if (start.size() != model.positionCount())
    throw std::invalid_argument("inverseKinematics: start has " + std::to_string(start.size()) +
                                " numbers, the model has " + std::to_string(model.positionCount()) + " positions");
  for (const FrameTarget& target : targets)
    if (target.frame < 0 || target.frame >= static_cast<int>(model.frames().size()))
      throw std::invalid_argument("inverseKinematics: the model has no frame " + std::to_string(target.frame));
  return Search(model, targets, options).from(start);
}

}  // namespace tactus::dynamics
