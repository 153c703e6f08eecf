#pragma once

#include <string>

#include "framework/geometry/triangle_mesh.h"

namespace tactus::dsl {

/// The triangles of an OBJ or STL file (by its ending), vertices of the same place joined; larger faces are cut.  No
/// other file is opened, whatever the file names.  Throws std::runtime_error, with a sentence, for a file that cannot
/// be read, is neither, or holds more than a million triangles or none.
geometry::TriangleMesh readMeshFile(const std::string& file);

}  // namespace tactus::dsl
