#pragma once

#include <string>

namespace tactus::description {

/// Where a value was written: file, line and column, both counted from 1.  Line 0 means "made in code".
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

}  // namespace tactus::description
