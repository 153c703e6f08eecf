#pragma once

#include <stdexcept>

namespace tactus::runtime {

/// A sensor, a measure or a recorder that threw, with which the run ends; the message names it and the time.
class PartError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tactus::runtime
