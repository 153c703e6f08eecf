#pragma once

#include <string>

#include "apps/tactus/session.h"

namespace tactus::app {

inline constexpr const char* scene_format = "tactus-scene/1";

/// Writes what a replay shows, as it stands at the session's time; throws FileError.  JSON, SI units:
///   format; robot: its name;
///   links: of those with shapes {name, skin (true where it feels), pose, capsules: [{from, to, radius}],
///     boxes: [{pose, size}]}, shapes in the link frame;
///   objects: {name, moves, pose, vertices: [x, y, z, …], triangles: [three vertices each, …]} in the object frame;
///     `simplified_from`: how many triangles there were, where there are fewer than the surface has.
/// A pose is [x, y, z, qw, qx, qy, qz] in W, but for those of shapes.
void writeScene(const std::string& path, const Session& session);

}  // namespace tactus::app
