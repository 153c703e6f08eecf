#include "plugins/qp/programme.h"

#include <cmath>

namespace tactus::qp {

bool isUsable(const Programme& programme) {
  const int n = programme.variables;
  const auto F = programme.F.topLeftCorner(programme.objective_rows, programme.dense);
  const auto ridge = programme.ridge.head(n);
  const double target = programme.t.head(programme.objective_rows).squaredNorm() +
                        ridge.cwiseProduct(programme.reference.head(n)).squaredNorm();
  return std::isfinite(F.squaredNorm() + ridge.squaredNorm() + target) &&
         programme.A.topLeftCorner(n, programme.rows).allFinite();
}

void expand(const Programme& programme, control::ConstrainedLeastSquares& plain, std::vector<int>& origins) {
  const int n = programme.variables;
  plain.variables = n;
  plain.F.setZero(programme.objective_rows + n, n);
  plain.t.setZero(programme.objective_rows + n);
  plain.F.topLeftCorner(programme.objective_rows, programme.dense) =
      programme.F.topLeftCorner(programme.objective_rows, programme.dense);
  plain.t.head(programme.objective_rows) = programme.t.head(programme.objective_rows);
  plain.objective_rows = programme.objective_rows;
  for (int k = 0; k < n; ++k) {
    if (programme.ridge[k] == 0) continue;
    plain.F(plain.objective_rows, k) = programme.ridge[k];
    plain.t[plain.objective_rows++] = programme.ridge[k] * programme.reference[k];
  }

  plain.E.resize(programme.rows, n);
  plain.G.resize(2 * programme.rows, n);
  plain.h.resize(2 * programme.rows);
  plain.equality_rows = plain.inequality_rows = 0;
  origins.clear();
  for (int j = 0; j < programme.rows; ++j) {
    const double norm = programme.row(j).norm();
    const double size = norm > 0 ? norm : 1;
    if (programme.lower[j] == programme.upper[j]) {
      plain.E.row(plain.equality_rows++) = programme.row(j).transpose() / size;
      continue;
    }
    for (const double sign : {1.0, -1.0}) {
      const double bound = sign > 0 ? programme.upper[j] : -programme.lower[j];
      if (!std::isfinite(bound)) continue;
      plain.G.row(plain.inequality_rows) = sign * programme.row(j).transpose() / size;
      plain.h[plain.inequality_rows++] = bound / size;
      origins.push_back(j);
    }
  }
}

}  // namespace tactus::qp
