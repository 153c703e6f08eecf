#pragma once

/// The version of Tactus: CMakeLists.txt reads it from here, and plugins are held against it.
#define TACTUS_VERSION "0.1.0"
