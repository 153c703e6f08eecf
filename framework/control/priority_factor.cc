#include "framework/control/priority_factor.h"

#include <algorithm>
#include <cmath>

#include "framework/control/strips.h"

namespace tactus::control {
namespace {

constexpr int max_sweeps = 30;                                     // of Jacobi rotations; 6 to 8 are usual
constexpr double rotation_tolerance = 1e-15;                       // cosine below which two rows count as orthogonal
// A squared norm that downdating has made so small is computed afresh (Drmač and Bujanović 2008).
constexpr double recompute_below = 1e-8;
constexpr double negligible_ratio = 1e-3;                          // to the rank tolerance

/// a ← (I − β v vᵀ) a for a strip of columns.
template <int width>
void reflectStrip(const double* v, double beta, int rows, double* a, Eigen::Index stride) {
  Strip<width> w = v[0] * Eigen::Map<const Strip<width>>(a);
  for (int k = 1; k < rows; ++k) w += v[k] * Eigen::Map<const Strip<width>>(a + k * stride);
  w *= beta;
  for (int k = 0; k < rows; ++k) Eigen::Map<Strip<width>>(a + k * stride) -= v[k] * w;
}

}  // namespace

double fadeWeight(double sigma, const RankOptions& options) {
  if (sigma >= options.fade) return 1;
  if (sigma <= options.rank_tolerance) return 0;
  const double s = (sigma - options.rank_tolerance) / (options.fade - options.rank_tolerance);
  return s * s * (3 - 2 * s);
}

PriorityFactor::PriorityFactor(int dimension, int column_capacity, int stage_capacity, RankOptions options)
    : dimension_(dimension),
      options_(options),
      negligible_(negligible_ratio * options.rank_tolerance),
      memories_(stage_capacity),
      left_(std::max(dimension, column_capacity)),
      reference_(column_capacity),
      inverse_(dimension, dimension),
      triangle_(dimension, column_capacity),
      buffer_(dimension, std::max(dimension, column_capacity)),
      order_(column_capacity),
      sigma_(dimension),
      tall_(column_capacity, dimension),
      target_(column_capacity),
      row_weights_(column_capacity) {
  for (Memory& memory : memories_) {
    memory.v.setZero(dimension, dimension);
    memory.beta.setZero(dimension);
    memory.rotation.setZero(dimension, dimension);
    memory.keep.setZero(dimension);
  }
}

int PriorityFactor::held() const {
  if (stage_count_ == 0) return 0;
  const Stage& last = memories_[stage_count_ - 1].stage;
  return last.first + last.held;
}

const PriorityFactor::Stage& PriorityFactor::hold(ColumnsRef columns) {
  const int first = held();
  Memory& memory = memories_[stage_count_++];
  memory.stage = {first, 0, 0, false};
  memory.reflections = 0;
  memory.rotated = false;
  triangularise(memory, columns);
  memory.stage.held = memory.stage.rank = memory.reflections;
  if (memory.reflections > 0 && !clearlyAboveFade(memory, columns)) rotateToSingularDirections(memory, columns);
  memory.stage.deficient |= memory.stage.rank < columns.cols();
  return memory.stage;
}

// The column with the largest part left, or -1 when all of them together are negligible.
int PriorityFactor::pivotColumn(ColumnsRef columns, int row, int from) {
  const int count = static_cast<int>(columns.cols());
  for (int j = from; j < count; ++j)
    if (left_[j] <= recompute_below * reference_[j]) {
      left_[j] = reference_[j] = columns.col(j).tail(dimension_ - row).squaredNorm();
    }
  double sum = 0;
  int pivot = from;
  for (int j = from; j < count; ++j) {
    sum += left_[j];
    if (left_[j] > left_[pivot]) pivot = j;
  }
  return sum > negligible_ * negligible_ ? pivot : -1;
}

void PriorityFactor::triangularise(Memory& memory, ColumnsRef columns) {
  const int first = memory.stage.first;
  const int count = static_cast<int>(columns.cols());
  left_.head(count).setZero();
  for (int k = first; k < dimension_; ++k) left_.head(count) += columns.row(k).transpose().cwiseAbs2();
  reference_.head(count) = left_.head(count);
  for (int j = 0; j < count; ++j) order_[j] = j;
  const int steps = std::min(count, dimension_ - first);
  for (int i = 0; i < steps; ++i) {
    const int row = first + i;
    const int pivot = pivotColumn(columns, row, i);
    if (pivot < 0) return;
    if (pivot != i) {
      for (int k = first; k < dimension_; ++k) std::swap(columns(k, i), columns(k, pivot));
      std::swap(order_[i], order_[pivot]);
      std::swap(left_[i], left_[pivot]);
      std::swap(reference_[i], reference_[pivot]);
    }
    // v = x + sign(x₀)‖x‖ e₀, β = 2/‖v‖²
    auto v = memory.v.col(i);
    v.head(row).setZero();
    v.tail(dimension_ - row) = columns.col(i).tail(dimension_ - row);
    const double norm = v.tail(dimension_ - row).norm();
    const double head = std::copysign(norm, v[row]);
    v[row] += head;
    memory.beta[i] = 1 / (norm * std::abs(v[row]));
    ++memory.reflections;
    columns.col(i).tail(dimension_ - row).setZero();
    columns(row, i) = -head;
    if (i + 1 == count) return;
    reflect(memory, i, columns.rightCols(count - i - 1));
    for (int j = i + 1; j < count; ++j) left_[j] -= columns(row, j) * columns(row, j);
  }
}

// The least singular value of R, the leading triangle: |r_rr| √(9/(4ʳ + 6r − 1)) bounds it from below for column
// pivoting; where that says too little, 1/‖R⁻¹‖_F does.
bool PriorityFactor::clearlyAboveFade(const Memory& memory, const ColumnsRef& columns) {
  const int r = memory.reflections;
  const auto R = columns.block(memory.stage.first, 0, r, r);
  const double last = std::abs(R(r - 1, r - 1));
  if (last * 3 / std::sqrt(std::pow(4.0, r) + 6 * r - 1) >= options_.fade) return true;
  if (last < options_.fade) return false;
  double sum = 0;
  for (int j = 0; j < r; ++j) {
    inverse_(j, j) = 1 / R(j, j);
    sum += inverse_(j, j) * inverse_(j, j);
    for (int i = j - 1; i >= 0; --i) {
      double dot = 0;
      for (int k = i + 1; k <= j; ++k) dot += R(i, k) * inverse_(k, j);
      inverse_(i, j) = -dot / R(i, i);
      sum += inverse_(i, j) * inverse_(i, j);
    }
  }
  return sum * options_.fade * options_.fade <= 1;
}

// One-sided Jacobi: Uᵀ makes the rows of R orthogonal; their norms are the singular values, small ones to high
// relative accuracy.
void PriorityFactor::rotateToSingularDirections(Memory& memory, const ColumnsRef& columns) {
  const int r = memory.reflections;
  const int count = static_cast<int>(columns.cols());
  auto G = triangle_.topLeftCorner(r, count);
  G = columns.middleRows(memory.stage.first, r);
  auto U = memory.rotation.topLeftCorner(r, r);
  U.setIdentity();
  for (int sweep = 0, rotations = 1; sweep < max_sweeps && rotations > 0; ++sweep) {
    rotations = 0;
    for (int p = 0; p < r; ++p)
      for (int q = p + 1; q < r; ++q) {
        const double a = G.row(p).squaredNorm();
        const double b = G.row(q).squaredNorm();
        const double c = G.row(p).dot(G.row(q));
        // Rows that are nothing but rounding have no direction to be turned to.
        if (std::abs(c) <= rotation_tolerance * std::sqrt(a) * std::sqrt(b) || std::abs(c) < 1e-300) continue;
        ++rotations;
        const double zeta = (b - a) / (2 * c);
        const double t = std::copysign(1 / (std::abs(zeta) + std::sqrt(1 + zeta * zeta)), zeta);
        const double cosine = 1 / std::sqrt(1 + t * t);
        const double sine = cosine * t;
        const auto turn = [&](auto& matrix) {
          for (int k = 0; k < matrix.cols(); ++k) {
            const double x = matrix(p, k);
            const double y = matrix(q, k);
            matrix(p, k) = cosine * x - sine * y;
            matrix(q, k) = sine * x + cosine * y;
          }
        };
        turn(G);
        turn(U);
      }
  }
  for (int i = 0; i < r; ++i) left_[i] = G.row(i).norm();
  for (int i = 0; i < r; ++i) {                                    // falling σ
    int largest = i;
    for (int j = i + 1; j < r; ++j)
      if (left_[j] > left_[largest]) largest = j;
    if (largest == i) continue;
    std::swap(left_[i], left_[largest]);
    U.row(i).swap(U.row(largest));
    G.row(i).swap(G.row(largest));
  }
  Stage& stage = memory.stage;
  stage.held = stage.rank = 0;
  for (int i = 0; i < r; ++i) {
    sigma_[i] = left_[i];
    memory.keep[i] = 1 - fadeWeight(left_[i], options_);
    if (left_[i] >= options_.fade) ++stage.held;
    if (left_[i] > options_.rank_tolerance) ++stage.rank;
  }
  stage.deficient = stage.rank > stage.held;
  memory.rotated = true;
}

void PriorityFactor::reflect(const Memory& memory, int i, ColumnsRef columns) {
  const int row = memory.stage.first + i;
  const int rows = dimension_ - row;
  const int count = static_cast<int>(columns.cols());
  const double* v = memory.v.col(i).data() + row;
  double* a = &columns(row, 0);
  const Eigen::Index stride = columns.outerStride();
  const double beta = memory.beta[i];
  if (stride == 1) {
    const auto reflection = memory.v.col(i).tail(rows);
    Eigen::Map<Eigen::VectorXd> column(a, rows);
    column -= beta * reflection.dot(column) * reflection;
    return;
  }
  forEachStrip(count, [&](auto width, int j) { reflectStrip<width()>(v, beta, rows, a + j, stride); });
}

void PriorityFactor::rotate(const Memory& memory, bool transposed, ColumnsRef columns) {
  const int r = memory.reflections;
  const auto U = memory.rotation.topLeftCorner(r, r);
  auto head = columns.middleRows(memory.stage.first, r);
  auto turned = buffer_.topLeftCorner(r, columns.cols());
  if (transposed)
    turned.noalias() = U.transpose().lazyProduct(head);
  else
    turned.noalias() = U.lazyProduct(head);
  head = turned;
}

void PriorityFactor::turn(int stage, ColumnsRef columns) {
  const Memory& memory = memories_[stage];
  if (columns.cols() == 0) return;
  for (int i = 0; i < memory.reflections; ++i) reflect(memory, i, columns);
  if (memory.rotated) rotate(memory, false, columns);
}

void PriorityFactor::turnBack(int stage, ColumnsRef columns) {
  const Memory& memory = memories_[stage];
  if (columns.cols() == 0) return;
  if (memory.rotated) rotate(memory, true, columns);
  for (int i = memory.reflections - 1; i >= 0; --i) reflect(memory, i, columns);
}

void PriorityFactor::fadeDirections(const Memory& memory, ColumnsRef columns) {
  if (!memory.rotated) return;
  for (int i = memory.stage.held; i < memory.reflections; ++i) columns.row(memory.stage.first + i) *= memory.keep[i];
}

void PriorityFactor::bringBack(int stage, ColumnsRef columns) {
  fadeDirections(memories_[stage], columns);
  turnBack(stage, columns);
}

void PriorityFactor::advance(int stage, ColumnsRef columns) {
  turn(stage, columns);
  fadeDirections(memories_[stage], columns);
}

void PriorityFactor::advance(ColumnsRef columns) {
  for (int stage = 0; stage < stage_count_; ++stage) advance(stage, columns);
}

void PriorityFactor::embed(ColumnsRef columns) {
  columns.topRows(held()).setZero();
  for (int stage = stage_count_ - 1; stage >= 0; --stage) turnBack(stage, columns);
}

// The stage's columns are Q R P, R (r × count) upper trapezoidal.  Independent rows: S = W Rᵀ.  Dependent rows, or
// singular directions, G = Uᵀ R: W Rᵀ (W Gᵀ) = Q' T, S = T.
void PriorityFactor::leastSquares(const ConstColumnsRef& columns, const Eigen::Ref<const Eigen::VectorXd>& b,
                                  const Eigen::Ref<const Eigen::VectorXd>& W, VectorRef z) {
  const Memory& memory = memories_[stage_count_ - 1];
  const int first = memory.stage.first;
  const int held = memory.stage.held;
  const int count = static_cast<int>(columns.cols());
  z.setZero();
  auto target = target_.head(count);
  auto weights = row_weights_.head(count);
  const double heaviest = count > 0 ? W.head(count).maxCoeff() : 1;
  for (int j = 0; j < count; ++j) {
    weights[j] = W[order_[j]] / heaviest;
    target[j] = weights[j] * b[order_[j]];
  }
  if (memory.rotated || count > memory.reflections) {
    for (int i = 0; i < held; ++i) {
      if (memory.rotated)
        tall_.col(i).head(count) = triangle_.row(i).head(count).transpose();
      else
        tall_.col(i).head(count) = columns.row(first + i).transpose();
      tall_.col(i).head(count).array() *= weights.array();
    }
    for (int i = 0; i < held; ++i) {
      auto v = tall_.col(i).segment(i, count - i);
      const double norm = v.norm();
      const double head = std::copysign(norm, v[0]);
      v[0] += head;
      const double beta = 1 / (norm * std::abs(v[0]));
      for (int k = i + 1; k < held; ++k) {
        auto column = tall_.col(k).segment(i, count - i);
        column -= beta * v.dot(column) * v;
      }
      auto rest = target.segment(i, count - i);
      rest -= beta * v.dot(rest) * v;
      tall_(i, i) = -head;                                         // below it v, which is not needed again
    }
  }
  z.segment(first, held) = target.head(held);
  fromMetric(columns, z);
  if (held == memory.stage.rank) return;
  // Each faded direction alone, of what the held ones leave.
  for (int j = 0; j < count; ++j)
    target[j] = b[order_[j]] - triangle_.col(j).head(held).dot(z.segment(first, held));
  for (int i = held; i < memory.stage.rank; ++i) {
    double along = 0, square = 0;
    for (int j = 0; j < count; ++j) {
      const double row = weights[j] * triangle_(i, j);
      along += row * weights[j] * target[j];
      square += row * row;
    }
    z[first + i] = fadeWeight(sigma_[i], options_) * along / square;
  }
}

void PriorityFactor::toMetric(const ConstColumnsRef& columns, ColumnsRef rows) const {
  const Memory& memory = memories_[stage_count_ - 1];
  const int first = memory.stage.first;
  const int held = memory.stage.held;
  if (memory.rotated || columns.cols() > memory.reflections) {     // T⁻ᵀ
    for (int i = 0; i < held; ++i) {
      for (int k = 0; k < i; ++k) rows.row(first + i) -= tall_(k, i) * rows.row(first + k);
      rows.row(first + i) /= tall_(i, i);
    }
  } else {                                                         // W⁻¹ R⁻¹
    for (int i = held - 1; i >= 0; --i) {
      for (int k = i + 1; k < held; ++k)
        if (columns(first + i, k) != 0) rows.row(first + i) -= columns(first + i, k) * rows.row(first + k);
      rows.row(first + i) /= columns(first + i, i);
    }
    for (int i = 0; i < held; ++i) rows.row(first + i) /= row_weights_[i];
  }
}

void PriorityFactor::fromMetric(const ConstColumnsRef& columns, VectorRef u) const {
  const Memory& memory = memories_[stage_count_ - 1];
  const int first = memory.stage.first;
  const int held = memory.stage.held;
  auto z = u.segment(first, held);
  if (memory.rotated || columns.cols() > memory.reflections) {     // T⁻¹
    for (int i = held - 1; i >= 0; --i) {
      for (int k = i + 1; k < held; ++k) z[i] -= tall_(i, k) * z[k];
      z[i] /= tall_(i, i);
    }
  } else {                                                         // R⁻ᵀ W⁻¹
    for (int i = 0; i < held; ++i) {
      z[i] /= row_weights_[i];
      for (int k = 0; k < i; ++k) z[i] -= columns(first + k, i) * z[k];
      z[i] /= columns(first + i, i);
    }
  }
}

}  // namespace tactus::control
