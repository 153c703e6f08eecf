#pragma once

#include <filesystem>
#include <string>

namespace tactus::app {

/// A new folder whose name begins with `stem` and a few letters more, taken away at the end.
class TemporaryFolder {
 public:
  /// Throws FileError.
  explicit TemporaryFolder(const std::filesystem::path& stem = std::filesystem::temp_directory_path() / "tactus-");
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string path;
};

}  // namespace tactus::app
