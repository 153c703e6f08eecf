#include "plugins/exploration/gaussian_process.h"

#include <algorithm>
#include <cmath>

namespace tactus::exploration {

GaussianProcess::GaussianProcess(const Covariance& covariance, double prior_mean, int capacity)
    : covariance_(covariance),
      prior_mean_(prior_mean),
      points_(3, capacity),
      values_(capacity),
      factor_(capacity, capacity),
      forward_(capacity),
      weights_(capacity),
      work_(capacity) {}

double GaussianProcess::kernel(const Eigen::Vector3d& p, int i) const {
  const double square = (p - points_.col(i)).squaredNorm();
  return covariance_.deviation * covariance_.deviation *
         std::exp(-0.5 * square / (covariance_.length * covariance_.length));
}

bool GaussianProcess::observe(const Eigen::Vector3d& p, double y) {
  const int n = count_;
  if (n == capacity()) return false;
  // The new row of L: L l = k, λ² = k(p, p) + σ_n² − lᵀ l.
  for (int i = 0; i < n; ++i) work_[i] = kernel(p, i);
  auto l = factor_.row(n).head(n);
  for (int i = 0; i < n; ++i) l[i] = (work_[i] - factor_.row(i).head(i).dot(l.head(i))) / factor_(i, i);
  const double prior = covariance_.deviation * covariance_.deviation + covariance_.noise * covariance_.noise;
  const double square = prior - l.squaredNorm();
  if (!(square > 1e-12 * prior)) return false;
  factor_(n, n) = std::sqrt(square);
  points_.col(n) = p;
  values_[n] = y;
  forward_[n] = (y - prior_mean_ - l.dot(forward_.head(n))) / factor_(n, n);
  ++count_;
  weights_.head(count_) = forward_.head(count_);
  for (int i = count_ - 1; i >= 0; --i) {
    weights_[i] /= factor_(i, i);
    weights_.head(i) -= weights_[i] * factor_.row(i).head(i).transpose();
  }
  return true;
}

double GaussianProcess::mean(const Eigen::Vector3d& p) const {
  double mean = prior_mean_;
  for (int i = 0; i < count_; ++i) mean += weights_[i] * kernel(p, i);
  return mean;
}

double GaussianProcess::mean(const Eigen::Vector3d& p, Eigen::Vector3d& gradient) const {
  double mean = prior_mean_;
  gradient.setZero();
  for (int i = 0; i < count_; ++i) {
    const double share = weights_[i] * kernel(p, i);
    mean += share;
    gradient -= share / (covariance_.length * covariance_.length) * (p - points_.col(i));
  }
  return mean;
}

double GaussianProcess::variance(const Eigen::Vector3d& p) {
  double explained = 0;
  for (int i = 0; i < count_; ++i) {
    work_[i] = (kernel(p, i) - factor_.row(i).head(i).dot(work_.head(i))) / factor_(i, i);
    explained += work_[i] * work_[i];
  }
  return std::max(covariance_.deviation * covariance_.deviation - explained, 0.0);
}

}  // namespace tactus::exploration
