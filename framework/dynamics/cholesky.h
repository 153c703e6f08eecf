#pragma once

#include <Eigen/Core>

namespace tactus::dynamics {

/// Lower triangular L with M = L Lᵀ, column by column.  Reads the lower triangle of M, writes that of L, takes no
/// memory.  False when M is not positive definite; L is then unfinished.
bool choleskyFactor(const Eigen::MatrixXd& M, Eigen::MatrixXd& L);

}  // namespace tactus::dynamics
