#pragma once

#include "apps/tactus/command.h"
#include "apps/tactus/stack_arguments.h"

namespace tactus::app {

struct ExplainTickArguments {
  StackOptions stack;                                              ///< its file may be a run folder
  std::vector<std::string> plugins;
  double at = 0;                                                   ///< s
};

/// Runs a stack, or a run folder's stack again, to a time and prints the priority x-ray of its tick.  Of a run folder
/// the log is checked too: a run that does not repeat ends with exit_mismatch.
int explainTick(const ExplainTickArguments& arguments, bool json);

}  // namespace tactus::app
