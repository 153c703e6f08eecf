#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::app {

/// Writes an MCAP file (https://mcap.dev/spec, version 0): messages of channels in uncompressed chunks, each chunk with
/// an index for every channel, checksums of chunks, data and summary, and a summary that repeats schemas and channels.
/// The bytes follow from the calls alone.  The file bears its name from close() on; until then it is <path>.new. Throws
/// FileError when it cannot be written.
class McapWriter {
 public:
  /// `library`: what writes it, for people.
  McapWriter(const std::string& path, const std::string& library);
  ~McapWriter();                                                   ///< takes an unfinished file away
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Returns its number, from 1 on.
  std::uint16_t addSchema(const std::string& name, const std::string& json_schema);
  /// Of JSON messages; returns its number, from 0 on.
  std::uint16_t addChannel(const std::string& topic, std::uint16_t schema);
  /// Facts about the whole; before the first message.
  void addMetadata(const std::string& name, const std::map<std::string, std::string>& facts);
  /// `time` in ns, not before that of the last message.
  void write(std::uint16_t channel, std::uint64_t time, std::string_view json);
  void close();

 private:
  struct Indexed {
    std::uint64_t time, offset;                                    ///< ns, bytes from the chunk's start
  };
  struct Channel {
    std::string record;
    std::uint32_t messages = 0;
    std::vector<Indexed> in_chunk;
  };

  void endChunk();
  void put(std::string_view bytes);
  std::string statistics() const;

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t written_ = 0;                                      ///< bytes
  std::uint32_t checksum_ = 0;                                     ///< of what was put since it was 0
  std::string chunk_;
  std::uint64_t chunk_start_ = 0, chunk_end_ = 0;                  ///< ns
  std::uint64_t start_ = 0, end_ = 0;                              ///< ns, of all messages
  std::uint64_t messages_ = 0;
  std::uint64_t messages_in_chunk_ = 0;
  std::vector<std::string> schemas_;                               ///< records
  std::vector<Channel> channels_;
  std::vector<std::string> chunk_indexes_, metadata_indexes_;      ///< records
};

}  // namespace tactus::app
