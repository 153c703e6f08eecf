#pragma once

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

#include "tests/dsl/placed.h"

namespace tactus::fuzz {

/// Ends the program, so that the fuzzer keeps the input, when something is `lacking`.
inline void require(const std::string& lacking) {
  if (lacking.empty()) return;
  std::cerr << lacking << std::endl;
  std::abort();
}

/// Returns the file.
inline std::string write(const std::string& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

}  // namespace tactus::fuzz
