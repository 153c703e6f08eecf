#pragma once

#include <Eigen/Core>
#include <deque>
#include <string>
#include <vector>

#include "framework/control/archive.h"

namespace tactus::control {

/// Where a port of a sensor stands in Sensed::readings: after those before it.
struct ReadingRow {
  std::string sensor;
  std::string port;
  int count = 1;
  bool scalar = true;                                              ///< of type "scalar", else "vector"
};

/// The controller's copy of what sensors read, at one address for its life, so that ports can point there.
class Readings {
 public:
  explicit Readings(std::vector<ReadingRow> rows = {});

  /// A number that is not finite, or that is missing, leaves the last good one standing (0 at first).
  void take(const Eigen::VectorXd& readings);

  void archive(Archive& archive);

  const std::vector<ReadingRow>& rows() const { return rows_; }
  int size() const { return size_; }
  /// Of the row of that index.
  const Eigen::VectorXd& values(std::size_t row) const { return vectors_[row]; }
  /// `const double*` behind a scalar, `const Eigen::VectorXd*` behind a vector; null where there is no such port.
  const void* port(const std::string& sensor, const std::string& port) const;

 private:
  std::vector<ReadingRow> rows_;
  std::deque<Eigen::VectorXd> vectors_;
  int size_ = 0;
};

}  // namespace tactus::control
