#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::runtime {

/// Writes rows of comma-separated values as they come.  Numbers take the shortest text without an exponent that
/// reads back to the same double, whatever the locale: readers that tell a column's kind by its first cell, as
/// PlotJuggler does, know no exponents.  Whole rows go to the file when the buffer is full, and when a row ends, or
/// flushWhenDue() is called, a second of the wall clock after they last did: a program that is killed leaves a readable
/// file, without the rows of its last second.  The file takes its name when its header is in it.  Throws FileError when
/// the file cannot be written.
class CsvWriter {
 public:
  CsvWriter(const std::string& path, const std::vector<std::string>& columns);
  ~CsvWriter();                                                    ///< writes what is left; only close() tells errors
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  CsvWriter& operator<<(double value);
  CsvWriter& operator<<(std::string_view text);                    ///< as it is: no comma, quote or line end
  void endRow();
  /// For a writer whose rows are seldom: writes those older than a second.
  void flushWhenDue();
  void flush();
  void close();

 private:
  void separate();
  bool isDue() const;

  std::string path_;
  int descriptor_ = -1;
  std::string buffer_;
  bool row_begun_ = false;
  std::chrono::steady_clock::time_point last_flush_;
};

}  // namespace tactus::runtime
