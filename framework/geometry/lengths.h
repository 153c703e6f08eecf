#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

namespace tactus::geometry {

/// The length, when it is finite and above 0; otherwise throws std::invalid_argument, which says of what.
inline double positive(const char* what, double length) {
  if (!(length > 0) || !std::isfinite(length)) throw std::invalid_argument(std::string(what) + " is finite and > 0");
  return length;
}

}  // namespace tactus::geometry
