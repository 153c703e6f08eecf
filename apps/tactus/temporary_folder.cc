#include "apps/tactus/temporary_folder.h"

#include <stdlib.h>

#include <cerrno>

#include "framework/runtime/file_error.h"

namespace tactus::app {

TemporaryFolder::TemporaryFolder(const std::filesystem::path& stem) : path(stem.string() + "XXXXXX") {
  if (!::mkdtemp(path.data())) throw runtime::FileError(path, "cannot be created", errno);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

}  // namespace tactus::app
