#pragma once

#include <optional>
#include <vector>

#include "framework/dynamics/model.h"

namespace tactus::dynamics {

/// Where a frame shall be.  What is not given is free.
struct FrameTarget {
  int frame = -1;                                                  ///< index into Model::frames()
  std::optional<Eigen::Vector3d> position_W;                       ///< of the frame's origin, m
  std::optional<Eigen::Matrix3d> orientation_W;
};

struct InverseKinematicsOptions {
  int max_iterations = 200;
  double tolerance = 1e-10;                                        ///< on the error below
  double angle_weight = 1;                                         ///< m: an error of 1 rad counts as so many metres
  double damping = 1e-6;                                           ///< at the start; grows where a step does not help
  bool keep_limits = true;                                         ///< of joints with one coordinate
};

struct InverseKinematicsResult {
  Eigen::VectorXd q;
  double error = 0;                                                ///< m, root of the sum of squares over all targets
  int iterations = 0;
  bool reached = false;                                            ///< error ≤ tolerance
};

/// A configuration that brings frames to their targets, by damped least squares (Levenberg–Marquardt; Wampler 1986,
/// Nakamura & Hanafusa 1986) from `start`.  For setting up poses, not for control: it takes memory, and where targets
/// are out of reach, or behind a limit, it ends at the nearest configuration that it finds, with `reached` false.
/// Throws std::invalid_argument when `start` has a wrong size or a target an unknown frame.
InverseKinematicsResult inverseKinematics(const Model& model, const std::vector<FrameTarget>& targets,
                                          const Eigen::VectorXd& start, const InverseKinematicsOptions& options = {});

}  // namespace tactus::dynamics
