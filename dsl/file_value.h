#pragma once

#include <string>

#include "framework/control/element_values.h"

namespace tactus::dsl {

/// The full path of the file that a value names, found from the folder of the stack, or included file, in which the
/// value is written; what is made in code is found from the working folder.  There need be no such file.
std::string fileOf(const control::Value& value);

}  // namespace tactus::dsl
