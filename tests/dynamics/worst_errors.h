#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

/// For comparisons of the dynamics with other engines.
namespace tactus::dynamics {

/// Greatest difference over greatest entry, or over `floor` where that is greater.
inline double relativeError(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double floor = 0) {
  if (a.size() == 0) return 0;
  return (a - b).cwiseAbs().maxCoeff() / std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), floor});
}

/// Expects every error to be below the tolerance, remembers the worst of each quantity and prints them when it goes.
class WorstErrors {
 public:
  WorstErrors(std::string of, double tolerance) : of_(std::move(of)), tolerance_(tolerance) {}
  WorstErrors(const WorstErrors&) = delete;
  WorstErrors& operator=(const WorstErrors&) = delete;
  ~WorstErrors() {
    std::printf("  worst relative errors, %s, %d states:\n", of_.c_str(), states_);
    for (const auto& [quantity, error] : worst_) std::printf("    %-24s %.1e\n", quantity.c_str(), error);
  }

  void beginState() { ++states_; }
  void check(const std::string& quantity, double error) { check(quantity, error, tolerance_); }
  void check(const std::string& quantity, double error, double tolerance) {
    EXPECT_LT(error, tolerance) << quantity;
    double& worst = worst_[quantity];
    worst = std::max(worst, error);
  }

 private:
  std::string of_;
  double tolerance_;
  int states_ = 0;
  std::map<std::string, double> worst_;
};

}  // namespace tactus::dynamics
