#pragma once

#include <memory>

#include "plugins/qp/qp_back_end.h"
#include "plugins/qp/qp_solver.h"

namespace tactus::qp {

/// The project's own: for real time.
std::unique_ptr<ProgrammeSolver> makeActiveSetSolver();

/// A reference solver, Ipopt or NLopt, that sees the programme through LazyRows.  Polishing tries its tolerances from
/// the least; where none gives an optimum, the solver's own numbers stand.  Takes memory in every tick.
std::unique_ptr<ProgrammeSolver> makeReferenceSolver(std::unique_ptr<QpSolver> solver, bool polish = true);

}  // namespace tactus::qp
