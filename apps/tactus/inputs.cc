#include "apps/tactus/inputs.h"

#include <link.h>

#include <cstdint>
#include <filesystem>

#include "dsl/file_value.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {

std::string hashOf(const std::string& content) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char c : content) hash = (hash ^ c) * 0x100000001b3;
  std::string digits = "fnv1a64:";
  for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[(hash >> shift) & 15];
  return digits;
}

std::string hashOfProgram() {
  std::vector<std::string> files{"/proc/self/exe"};
  const auto note = [](dl_phdr_info* library, size_t, void* into) {
    if (std::filesystem::path(library->dlpi_name).filename().string().starts_with("libtactus"))
      static_cast<std::vector<std::string>*>(into)->push_back(library->dlpi_name);
    return 0;
  };
  ::dl_iterate_phdr(note, &files);
  std::string hashes;
  for (const std::string& file : files) hashes += hashOf(runtime::readFile(file));
  return hashOf(hashes);
}

std::vector<std::string> filesOfShapes(const dsl::Stack& stack) {
  std::vector<std::string> files;
  for (const dsl::ObjectDescription& object : stack.objects)
    for (const control::ElementValues& shape : object.shapes)
      for (const control::AttributeRow& attribute : shape.row().attributes)
        if (attribute.type == control::ValueType::file && shape.has(attribute.name))
          files.push_back(dsl::fileOf(shape.value(attribute.name)));
  return files;
}

}  // namespace tactus::app
