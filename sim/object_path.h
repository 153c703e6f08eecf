#pragma once

#include <vector>

#include "framework/description/scene.h"
#include "sim/contact_force.h"

namespace tactus::sim {

/// Where a path is at `time`, and how it moves: from waypoint to waypoint with s = 10u³ − 15u⁴ + 6u⁵ of the way at the
/// part u of the time (Flash and Hogan 1985), on a straight line and about a fixed axis; at rest at each, before the
/// first and after the last.  The path has a waypoint at least.
BodyMotion motionOn(const std::vector<description::Waypoint>& path, double time);

}  // namespace tactus::sim
