#pragma once

namespace tactus::dynamics {

/// Sines and cosines of many angles (rad), two at a time: a robot's joints are turned at once, and alike on every
/// machine, whatever its mathematical library.  Errors stay below 2e-16 for |angle| ≤ 1e5, where the argument is reduced
/// in three parts (Cody & Waite 1980) and the polynomials are the minimax ones of Moshier (Cephes, 1989) on |x| ≤ π/4;
/// larger angles, and those that are not finite, go to the standard library.
///
/// `count` is even: callers pad.
void sinesAndCosines(const double* angles, int count, double* sines, double* cosines);

}  // namespace tactus::dynamics
