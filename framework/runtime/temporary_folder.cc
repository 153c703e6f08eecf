#include "framework/runtime/temporary_folder.h"

#include <stdlib.h>

#include <cerrno>

#include "framework/runtime/file_error.h"

namespace tactus::runtime {
namespace {

std::filesystem::path temporaryPlace() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) throw FileError("TMPDIR", "is no folder for temporary files: " + error.message());
  return folder;
}

}  // namespace

TemporaryFolder::TemporaryFolder() : TemporaryFolder(temporaryPlace() / "tactus-") {}

TemporaryFolder::TemporaryFolder(const std::filesystem::path& stem) : path(stem.string() + "XXXXXX") {
  if (!::mkdtemp(path.data())) throw FileError(path, "cannot be created", errno);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

}  // namespace tactus::runtime
