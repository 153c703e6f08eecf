#include "apps/tactus/inputs.h"

#include <cstdint>

#include "dsl/file_value.h"

namespace tactus::app {

std::string hashOf(const std::string& content) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char c : content) hash = (hash ^ c) * 0x100000001b3;
  std::string digits = "fnv1a64:";
  for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[(hash >> shift) & 15];
  return digits;
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
