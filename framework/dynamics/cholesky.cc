#include "framework/dynamics/cholesky.h"

#include <cmath>

namespace tactus::dynamics {

bool choleskyFactor(const Eigen::MatrixXd& M, Eigen::MatrixXd& L) {
  const Eigen::Index n = M.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    auto column = L.col(j).tail(n - j);
    column = M.col(j).tail(n - j);
    column.noalias() -= L.block(j, 0, n - j, j) * L.row(j).head(j).transpose();
    if (!(column[0] > 0)) return false;
    const double diagonal = std::sqrt(column[0]);
    column[0] = diagonal;
    column.tail(n - j - 1) *= 1 / diagonal;
  }
  return true;
}

}  // namespace tactus::dynamics
