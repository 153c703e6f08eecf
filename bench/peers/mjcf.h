#pragma once

#include <string>

#include "bench/peers/problem.h"

namespace tactus::bench {

/// The problem's bodies in MuJoCo's language.  Moments of inertia are given as principal ones, to full precision:
/// MuJoCo's own diagonalisation of a full tensor keeps only nine digits.
std::string mjcf(const Problem& problem);

}  // namespace tactus::bench
