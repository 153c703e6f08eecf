#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::runtime {

/// Writes rows of comma-separated values as they come.  Numbers take the shortest text that reads back to the
/// same double, whatever the locale.  Whole rows go to the file when the buffer is full, or in the first row that
/// ends more than a second after the last: a killed run leaves a readable file.
/// Throws FileError when the file cannot be written.
class CsvWriter {
 public:
  CsvWriter(const std::string& path, const std::vector<std::string>& columns);
  ~CsvWriter();                                                    ///< writes what is left; only close() tells errors
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  CsvWriter& operator<<(double value);
  CsvWriter& operator<<(std::string_view text);                    ///< as it is: no comma, quote or line end
  void endRow();
  void flush();
  void close();

 private:
  void separate();

  std::string path_;
  int descriptor_ = -1;
  std::string buffer_;
  bool row_begun_ = false;
  std::chrono::steady_clock::time_point last_flush_;
};

}  // namespace tactus::runtime
