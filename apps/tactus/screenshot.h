#pragma once

#include <string>

namespace tactus::app {

struct PictureSize {
  int width = 1200;                                                ///< CSS px; a picture has twice as many
  int height = 800;
};

/// "file:///…" of a path, with what a URL cannot hold escaped.
std::string fileAddress(const std::string& path);

/// Has Chromium open an address without a window and keep what it shows as a PNG file.  Throws FileError where no Chromium
/// is found on the path, where it fails, or where it takes longer than a minute.
void takeScreenshot(const std::string& address, const std::string& png, PictureSize size);

}  // namespace tactus::app
