#pragma once

#include <filesystem>
#include <string>

namespace tactus::runtime {

/// A new folder whose name begins with `stem` and a few letters more, taken away at the end.
class TemporaryFolder {
 public:
  /// Both throw FileError.  Without a stem it stands where TMPDIR says.
  TemporaryFolder();
  explicit TemporaryFolder(const std::filesystem::path& stem);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string path;
};

}  // namespace tactus::runtime
