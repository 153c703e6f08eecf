#include "framework/runtime/file_error.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace tactus::runtime {
namespace {

/// A file descriptor that is closed when it leaves its scope.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags) : number(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number;
};

}  // namespace

FileError::FileError(const std::string& path, const std::string& action, int error_number)
    : FileError(path, action + ": " + std::strerror(error_number)) {}

std::string readFile(const std::string& path) {
  Descriptor file(path, O_RDONLY);
  if (file.number < 0) throw FileError(path, "cannot be opened", errno);
  std::string content;
  char block[65536];
  for (;;) {
    const ssize_t count = ::read(file.number, block, sizeof block);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw FileError(path, "cannot be read", errno);
    if (count == 0) return content;
    content.append(block, static_cast<size_t>(count));
  }
}

void writeFile(const std::string& path, const std::string& content) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (file.number < 0) throw FileError(path, "cannot be created", errno);
  for (size_t done = 0; done < content.size();) {
    const ssize_t count = ::write(file.number, content.data() + done, content.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw FileError(path, "cannot be written", errno);
    done += static_cast<size_t>(count);
  }
}

void writeWhole(const std::string& path, const std::string& content) {
  try {
    writeFile(path + unfinished_suffix, content);
  } catch (const FileError& error) {
    dropUnfinished(path);
    throw FileError(path, error.reason);
  }
  finishFile(path);
}

void finishFile(const std::string& path) {
  if (std::rename((path + unfinished_suffix).c_str(), path.c_str()) == 0) return;
  const int error = errno;
  dropUnfinished(path);
  throw FileError(path, "cannot be written", error);
}

void dropUnfinished(const std::string& path) noexcept { ::unlink((path + unfinished_suffix).c_str()); }

}  // namespace tactus::runtime
