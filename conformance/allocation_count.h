#pragma once

namespace tactus::conformance {

/// How often this program has asked for memory, by malloc (Eigen) or operator new, in all its threads.  Counted since a
/// program that calls this brings its own malloc, which counts and hands on.
long allocationCount();

}  // namespace tactus::conformance
