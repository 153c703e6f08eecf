#include "framework/runtime/csv_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>

#include "framework/runtime/file_error.h"

namespace tactus::runtime {
namespace {

constexpr size_t buffer_size = 1 << 16;
constexpr std::chrono::seconds flush_interval{1};

}  // namespace

CsvWriter::CsvWriter(const std::string& path, const std::vector<std::string>& columns)
    : path_(path), last_flush_(std::chrono::steady_clock::now()) {
  descriptor_ = ::open((path + unfinished_suffix).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw FileError(path, "cannot be created", errno);
  buffer_.reserve(2 * buffer_size);
  try {
    for (const std::string& column : columns) *this << std::string_view(column);
    endRow();
    flush();
    finishFile(path);
  } catch (...) {
    ::close(descriptor_);
    dropUnfinished(path);
    throw;
  }
}

CsvWriter::~CsvWriter() {
  try {
    close();
  } catch (const FileError&) {
    // A destructor cannot tell; whoever wants to know calls close().
  }
}

void CsvWriter::separate() {
  if (row_begun_) buffer_ += ',';
  row_begun_ = true;
}

CsvWriter& CsvWriter::operator<<(double value) {
  separate();
  char digits[400];                                                // of 5e-324 there are 326
  const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed).ptr;
  buffer_.append(digits, end);
  return *this;
}

CsvWriter& CsvWriter::operator<<(std::string_view text) {
  separate();
  buffer_.append(text);
  return *this;
}

void CsvWriter::endRow() {
  buffer_ += '\n';
  row_begun_ = false;
  if (buffer_.size() >= buffer_size || isDue()) flush();
}

bool CsvWriter::isDue() const { return std::chrono::steady_clock::now() - last_flush_ >= flush_interval; }

void CsvWriter::flushWhenDue() {
  if (!row_begun_ && !buffer_.empty() && isDue()) flush();
}

void CsvWriter::flush() {
  last_flush_ = std::chrono::steady_clock::now();
  for (size_t done = 0; done < buffer_.size();) {
    const ssize_t count = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error = errno;
      buffer_.clear();
      throw FileError(path_, "cannot be written", error);
    }
    done += static_cast<size_t>(count);
  }
  buffer_.clear();
}

void CsvWriter::close() {
  if (descriptor_ < 0) return;
  const int descriptor = descriptor_;
  try {
    flush();
  } catch (...) {
    descriptor_ = -1;
    ::close(descriptor);
    throw;
  }
  descriptor_ = -1;
  if (::close(descriptor) != 0) throw FileError(path_, "cannot be written", errno);
}

}  // namespace tactus::runtime
