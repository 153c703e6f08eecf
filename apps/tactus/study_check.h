#pragma once

#include <vector>

#include "apps/tactus/program.h"
#include "apps/tactus/study_plan.h"
#include "dsl/diagnostic.h"

namespace tactus::app {

/// Holds a study against its stack: every condition is read and brought to life once.  Throws dsl::InvalidStack with
/// what the study or the stack under one of the conditions has wrong; figures that no run has are warnings.
StudyPlan planOf(Program& program, const dsl::Study& study, std::vector<dsl::Diagnostic>& warnings);

/// What `tactus run` is told of a trial, without a folder.
std::vector<std::string> runArguments(const dsl::Study& study, const StudyPlan& plan, const Trial& trial);

}  // namespace tactus::app
