#include "apps/tactus/mcap_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

constexpr std::string_view magic("\x89MCAP0\r\n", 8);
constexpr size_t chunk_size = 1 << 20;

/// What kind of record follows.
enum class Record : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f
};

/// Numbers, little-endian, and texts with their lengths before them, one after another.
class Bytes {
 public:
  Bytes& u8(std::uint64_t value) { return number(value, 1); }
  Bytes& u16(std::uint64_t value) { return number(value, 2); }
  Bytes& u32(std::uint64_t value) { return number(value, 4); }
  Bytes& u64(std::uint64_t value) { return number(value, 8); }
  Bytes& text(std::string_view value) { return u32(value.size()).raw(value); }
  Bytes& raw(std::string_view value) {
    bytes_ += value;
    return *this;
  }
  const std::string& get() const { return bytes_; }

 private:
  Bytes& number(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_ += static_cast<char>(value >> 8 * i & 0xff);
    return *this;
  }
  std::string bytes_;
};

std::string record(Record kind, const Bytes& content) {
  return Bytes().u8(static_cast<std::uint8_t>(kind)).u64(content.get().size()).raw(content.get()).get();
}

/// CRC-32 of ISO 3309 and zlib, going on from `sum`, which is 0 at first.
std::uint32_t checksum(std::string_view bytes, std::uint32_t sum = 0) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> entries{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      entries[i] = i;
      for (int bit = 0; bit < 8; ++bit) entries[i] = entries[i] >> 1 ^ (entries[i] & 1 ? 0xedb88320u : 0u);
    }
    return entries;
  }();
  sum = ~sum;
  for (const char byte : bytes) sum = sum >> 8 ^ table[(sum ^ static_cast<unsigned char>(byte)) & 0xff];
  return ~sum;
}

}  // namespace

McapWriter::McapWriter(const std::string& path, const std::string& library) : path_(path) {
  descriptor_ = ::open((path + runtime::unfinished_suffix).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw runtime::FileError(path_, "cannot be created", errno);
  chunk_.reserve(2 * chunk_size);
  try {
    put(magic);
    put(record(Record::header, Bytes().text("").text(library)));
  } catch (...) {
    ::close(descriptor_);
    runtime::dropUnfinished(path_);
    throw;
  }
}

McapWriter::~McapWriter() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  runtime::dropUnfinished(path_);
}

void McapWriter::put(std::string_view bytes) {
  checksum_ = checksum(bytes, checksum_);
  written_ += bytes.size();
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw runtime::FileError(path_, "cannot be written", errno);
    bytes.remove_prefix(static_cast<size_t>(count));
  }
}

std::uint16_t McapWriter::addSchema(const std::string& name, const std::string& json_schema) {
  const auto number = static_cast<std::uint16_t>(schemas_.size() + 1);  // 0 means none
  schemas_.push_back(record(Record::schema, Bytes().u16(number).text(name).text("jsonschema").text(json_schema)));
  chunk_ += schemas_.back();
  return number;
}

std::uint16_t McapWriter::addChannel(const std::string& topic, std::uint16_t schema) {
  const auto number = static_cast<std::uint16_t>(channels_.size());
  const Bytes content = Bytes().u16(number).u16(schema).text(topic).text("json").u32(0);
  channels_.push_back({record(Record::channel, content), 0, {}});
  chunk_ += channels_.back().record;
  return number;
}

void McapWriter::addMetadata(const std::string& name, const std::map<std::string, std::string>& facts) {
  Bytes pairs;
  for (const auto& [key, value] : facts) pairs.text(key).text(value);
  const std::string text = record(Record::metadata, Bytes().text(name).text(pairs.get()));
  metadata_indexes_.push_back(record(Record::metadata_index, Bytes().u64(written_).u64(text.size()).text(name)));
  put(text);
}

void McapWriter::write(std::uint16_t channel, std::uint64_t time, std::string_view json) {
  Channel& to = channels_[channel];
  if (messages_in_chunk_++ == 0) chunk_start_ = time;
  if (messages_++ == 0) start_ = time;
  chunk_end_ = end_ = time;
  to.in_chunk.push_back({time, chunk_.size()});
  chunk_ += record(Record::message, Bytes().u16(channel).u32(to.messages++).u64(time).u64(time).raw(json));
  if (chunk_.size() >= chunk_size) endChunk();
}

void McapWriter::endChunk() {
  if (chunk_.empty()) return;
  if (messages_in_chunk_ == 0) chunk_start_ = chunk_end_ = end_;
  const std::uint64_t offset = written_;
  put(record(Record::chunk, Bytes()
                                .u64(chunk_start_)
                                .u64(chunk_end_)
                                .u64(chunk_.size())
                                .u32(checksum(chunk_))
                                .text("")                          // no compression
                                .u64(chunk_.size())
                                .raw(chunk_)));
  const std::uint64_t length = written_ - offset;

  Bytes offsets;
  for (size_t i = 0; i < channels_.size(); ++i) {
    std::vector<Indexed>& in_chunk = channels_[i].in_chunk;
    if (in_chunk.empty()) continue;
    offsets.u16(i).u64(written_);
    Bytes entries;
    for (const Indexed& message : in_chunk) entries.u64(message.time).u64(message.offset);
    put(record(Record::message_index, Bytes().u16(i).text(entries.get())));
    in_chunk.clear();
  }
  chunk_indexes_.push_back(record(Record::chunk_index, Bytes()
                                                           .u64(chunk_start_)
                                                           .u64(chunk_end_)
                                                           .u64(offset)
                                                           .u64(length)
                                                           .text(offsets.get())
                                                           .u64(written_ - offset - length)
                                                           .text("")
                                                           .u64(chunk_.size())
                                                           .u64(chunk_.size())));
  chunk_.clear();
  messages_in_chunk_ = 0;
}

std::string McapWriter::statistics() const {
  Bytes counts;
  for (size_t i = 0; i < channels_.size(); ++i) counts.u16(i).u64(channels_[i].messages);
  return record(Record::statistics, Bytes()
                                        .u64(messages_)
                                        .u16(schemas_.size())
                                        .u32(channels_.size())
                                        .u32(0)                    // attachments
                                        .u32(metadata_indexes_.size())
                                        .u32(chunk_indexes_.size())
                                        .u64(start_)
                                        .u64(end_)
                                        .text(counts.get()));
}

void McapWriter::close() {
  endChunk();
  put(record(Record::data_end, Bytes().u32(checksum_)));

  const std::uint64_t summary = written_;
  checksum_ = 0;
  Bytes offsets;
  const auto putGroup = [&](Record kind, const std::vector<std::string>& records) {
    if (records.empty()) return;
    const std::uint64_t start = written_;
    for (const std::string& one : records) put(one);
    offsets.raw(record(Record::summary_offset,
                       Bytes().u8(static_cast<std::uint8_t>(kind)).u64(start).u64(written_ - start)));
  };
  std::vector<std::string> channels;
  for (const Channel& channel : channels_) channels.push_back(channel.record);
  putGroup(Record::schema, schemas_);
  putGroup(Record::channel, channels);
  putGroup(Record::statistics, {statistics()});
  putGroup(Record::metadata_index, metadata_indexes_);
  putGroup(Record::chunk_index, chunk_indexes_);
  const std::uint64_t summary_offsets = written_;
  put(offsets.get());

  // The footer's checksum covers all of it up to the checksum itself.
  constexpr std::uint64_t footer_size = 8 + 8 + 4;
  put(Bytes().u8(static_cast<std::uint8_t>(Record::footer)).u64(footer_size).u64(summary).u64(summary_offsets).get());
  put(Bytes().u32(checksum_).get());
  put(magic);
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0) {
    const int error = errno;
    runtime::dropUnfinished(path_);
    throw runtime::FileError(path_, "cannot be written", error);
  }
  runtime::finishFile(path_);
}

}  // namespace tactus::app
