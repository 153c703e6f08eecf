#pragma once

#include <string>
#include <vector>

#include "dsl/diagnostic.h"
#include "dsl/study.h"
#include "framework/control/registry.h"

namespace tactus::dsl {

/// Trials that a study has at most.
inline constexpr long most_trials = 1000000;

/// Adds the elements of a study: <study>, <factor>, <seeds>, <backends>, <metric>, <compare>.
void addStudyElements(control::Registry& registry);

/// Reads and checks a study.  Throws InvalidStack with every error found.  Back ends, parameters and metrics are names
/// until its stack is read.
Study readStudy(const std::string& file, const control::Registry& registry,
                const std::vector<std::string>& include_folders);

/// Whether the file is XML with <study> outermost.
bool isStudy(const std::string& file);

}  // namespace tactus::dsl
