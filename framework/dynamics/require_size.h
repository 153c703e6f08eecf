#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>

namespace tactus::dynamics {

/// Throws std::invalid_argument: "qd has 3 numbers, the model takes 7".
inline void requireSize(const char* name, const Eigen::VectorXd& vector, Eigen::Index expected) {
  if (vector.size() == expected) return;
  throw std::invalid_argument(std::string(name) + " has " + std::to_string(vector.size()) +
                              " numbers, the model takes " + std::to_string(expected));
}

}  // namespace tactus::dynamics
