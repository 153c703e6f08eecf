#pragma once

namespace tactus::dynamics {

/// How often this program has asked for memory, by malloc (Eigen) or operator new.
long allocationCount();

}  // namespace tactus::dynamics
