#pragma once

#include <vector>

#include "dsl/diagnostic.h"
#include "dsl/stack.h"
#include "framework/control/registry.h"

namespace tactus::dsl {

/// What is allowed in a stack and yet hardly meant (`tactus check --strict`), looked at where the robot starts, without
/// any contact:
///   W020  a level whose tasks find every direction taken by higher ones
///   W021  two equality tasks of one level that ask for the same directions
///   W022  a task that holds every joint while levels stand below it
///   W023  more desired contacts than the links that should make them can move in directions
///   W024  a task whose own springs and dampers, held for a tick, make the robot diverge: eigenvalues of the linear
///         robot-and-task in discrete time, one tick of semi-implicit Euler
///   W025  a place that the link which should reach it cannot come near
///   W026  a phase that no other leads to
/// Builds the controller and ticks it once.  `plant_step`, s, as in ReadOptions: no faster rate is advised.  Throws
/// InvalidStack as compile() does.
std::vector<Diagnostic> lint(const Stack& stack, const control::Registry& registry, double plant_step = 0);

}  // namespace tactus::dsl
