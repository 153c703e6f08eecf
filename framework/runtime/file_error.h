#pragma once

#include <stdexcept>
#include <string>

namespace tactus::runtime {

/// A file that could not be opened, read or written; the message starts with its path.
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& path, const std::string& reason)
      : std::runtime_error(path + ": " + reason), path(path), reason(reason) {}
  /// The reason is that of `error_number` (errno).
  FileError(const std::string& path, const std::string& action, int error_number);
  std::string path;
  std::string reason;                                              ///< without the path
};

/// The whole content; throws FileError.
std::string readFile(const std::string& path);
/// Writes the whole content, replacing what was there; throws FileError, on a full disk too.
void writeFile(const std::string& path, const std::string& content);
/// As writeFile, all of it or nothing: a program that is killed leaves what was there before.
void writeWhole(const std::string& path, const std::string& content);

/// Where a file is made that takes its name when it is whole: the name with this at its end.
inline constexpr const char* unfinished_suffix = ".new";
/// Gives an unfinished file its name; throws FileError.
void finishFile(const std::string& path);
/// Takes an unfinished file away, if it is there.
void dropUnfinished(const std::string& path) noexcept;

}  // namespace tactus::runtime
