#pragma once

#include <memory>
#include <vector>

#include "framework/control/back_end.h"
#include "framework/control/priority_factor.h"

namespace tactus::hqp {

struct HqpOptions {
  control::RankOptions rank = control::dividing_rank;
  control::ObjectiveOptions objective = {};
};

/// Strict hierarchical quadratic programme (Escande, Mansard, Wieber 2014): level by level from the top,
///
///   min ‖J_i M⁻¹ τ − a_i‖², and of its optima τ⁽ⁱ⁾ the one with the least τᵀM⁻¹τ,
///
/// J_i the level's equality rows and its inequality rows with F ≠ 0, a_i = J_i M⁻¹ τ°_i or the acceleration that a task
/// asks for, errors and contacts as `objective` takes and damps them.  From then on E_i M⁻¹ τ = E_i M⁻¹ τ⁽ⁱ⁾ for its equality rows, I_i M⁻¹ τ ≤ I_i M⁻¹ τ⁽ⁱ⁾ for its inequality
/// rows.  Torque limits stand at the level of their priority, above all levels when they have none: from there on no
/// level leaves them; where the levels above already did, the least violation (in squares) is kept and the tick is
/// infeasible.  A contact's force_max and its friction cone bound its reference: no level below can change its rows.
///
/// In whitened coordinates each level is an orthogonal decomposition of its rows in what the levels above leave.  Where
/// its optimum leaves an inequality row or a limit, a dual active set finds the rows that must be at their bounds, with
/// the free directions at a price that hardly counts; the point itself is then computed without that price.  Each level
/// starts from the rows that it met in the last tick: where those that cost it something still do, which their
/// multipliers tell, and nothing else leaves its bounds, the optimum is found and nothing is priced.  Takes no memory
/// after `prepare`.
class Hqp final : public control::BackEnd {
 public:
  explicit Hqp(const HqpOptions& options = {});
  ~Hqp() override;

  control::WarmStart warmStart() const override;
  void setWarmStart(const control::WarmStart& start) override;

 private:
  void doPrepare(const control::TickProblem& shape) override;
  void doSolve(const control::TickProblem& problem, control::TickSolution& solution) override;

  class Solver;
  HqpOptions options_;
  std::unique_ptr<Solver> solver_;
};

}  // namespace tactus::hqp
