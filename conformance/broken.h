#pragma once

#include <string>

namespace tactus::conformance {

/// What a law throws: it is broken, or was not asked, and why.
struct Broken {
  std::string message;
};
struct NotAsked {
  std::string message;
};

}  // namespace tactus::conformance
