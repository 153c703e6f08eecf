#pragma once

#include <string>
#include <vector>

#include "conformance/report.h"
#include "dsl/stack.h"
#include "framework/control/registry.h"

/// What can be demanded of every element, whatever it is for; from `tactus plugins check` and from tests:
///
///   const auto report = conformance::checkPlugin("build/acme.so", "stack.xml");
///   EXPECT_TRUE(report.conforms()) << report.text();
///
/// Elements are asked at random states near the stack's start, in stretches of 20 ticks of steady motion, with random
/// contacts on the robot's skin that move with their links.  Seeds are fixed: a verdict repeats.
///
/// of each row of the element table
///   schema       element, attributes and ports are described; numbers and scalar ports have a unit ("1" where they
///                have none); defaults parse.
///   instance     it can be made: from the stack, or from its defaults and plausible values for what it requires.
///   attributes   the factories of the stack's instances ask for every attribute, each for some.
///
/// of each task
///   rows         0 ≤ rows ≤ capacity, storage keeps its size, J, F, acceleration and error are finite, and there are
///                rows in some state.
///   jacobian     J is the derivative of Task::displacement, to 1e-6 for a unit motion of each joint.  Of a task that
///                does not tell its displacement: a motion that J does not see (J δ = 0) changes neither F nor error.
///   bias         of a task that asks for accelerations: the part of them that is even in q̇, less that at rest, is
///                −J̇q̇, with J̇ from differences of J along q̇.  So a wish is affine in the velocity.
///   frame        base, contacts, signals and values in world axes (AttributeRow::in_world) turned together about the
///                vertical and moved: the same joint torques JᵀF, and JᵀJ: the same rows up to their axes.
///   allocation   an update takes no memory.
///   determinism  two instances give the same bytes for the same inputs, also after a third one was given others.
///   state        an instance that went another way and is then restored from one in the middle of its run goes on as
///                that one does, to the byte: its doArchive names all that it carries.  Asked where determinism is kept.
///
/// of each sensor
///   felt         joints keep their number, contacts are at links of the robot, readings are finite or NaN.
///   allocation, determinism, state   of one tick; two instances of one seed feel the same.
///
/// of each controller
///   tasks        it owns one; each keeps the laws of tasks, under its full name.
///   allocation, determinism, state   of its update; of its columns and the forces of its tasks.
///
/// of each measure
///   figures      it has a figure or a column; figures keep their names from before the first tick on, none is infinite.
///   allocation, determinism, state   over figures and columns.
///
/// of each recorder
///   files        it writes what it writes into the run folder, and throws nothing.
///   determinism  a second run of the same inputs leaves the same files, however long its ticks took.
///
/// of each signal
///   ports        every declared port is served, at one address for the signal's life; scalars are finite.
///   allocation, determinism, state   as for tasks, over scalar ports and log columns.
///
/// of each shape, those of the stack's scene or one made from its defaults: finite, gradient, lipschitz, foot,
/// bounding, support, convex, determinism, allocation, as shape_laws.h tells.
///
/// of each back end, on the tick problems of the stack
///   torque       finite, and within the limits where it declares that it honours them.
///   determinism  as above.
namespace tactus::conformance {

/// The laws of `elements`, on their instances in `stack`; those without one there are made from their defaults.
Report checkElements(const control::Registry& registry, const std::vector<std::string>& elements,
                     const dsl::Stack* stack = nullptr);

/// All elements of a plugin library.  Throws runtime::PluginError, dsl::InvalidStack.
Report checkPlugin(const std::string& library, const std::string& stack_file = "");

}  // namespace tactus::conformance
