#pragma once

namespace tactus::sim_tests {

/// How often this program has called operator new; link count_allocations.cc with it.
long allocations();

}  // namespace tactus::sim_tests
