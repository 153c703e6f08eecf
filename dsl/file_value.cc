#include "dsl/file_value.h"

#include <filesystem>

#include "dsl/stack_document.h"

namespace tactus::dsl {

std::string fileOf(const control::Value& value) {
  return std::filesystem::absolute(pathBeside(value.origin.place.file, value.text)).lexically_normal().string();
}

}  // namespace tactus::dsl
