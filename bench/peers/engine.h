#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "bench/peers/problem.h"

namespace tactus::bench {

enum class Operation {
  rnea,                                                            ///< τ = M q̈ + b + g
  bias,                                                            ///< b + g
  mass_matrix,                                                     ///< M, full
  forward_dynamics,                                                ///< q̈ = M⁻¹ (τ − b − g)
  point_jacobians,                                                 ///< of Problem::points, from q
  tick,                                                            ///< M, b + g and the point Jacobians, from q, q̇
  cache_tick                                                       ///< Tactus's whole tick: also g and a factor of M
};

/// In the coordinates of the Problem, whatever the engine's own ones are.  What was not asked for is empty.
struct Results {
  Eigen::VectorXd vector;                                          ///< τ, b + g or q̈
  Eigen::MatrixXd mass_matrix;
  Eigen::MatrixXd jacobians;                                       ///< 3 rows a point
};

/// A rigid-body dynamics engine that was told one Problem.  Its own states are made at construction; `run` starts
/// from q (nothing is kept from call to call) and leaves the results in the engine's own memory.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual std::string name() const = 0;
  virtual bool offers(Operation operation) const = 0;
  /// What is timed.
  virtual void run(Operation operation, int state) = 0;
  /// Of the last run, which was of this operation and state.  Not timed.
  virtual Results results(Operation operation, int state) = 0;
};

std::unique_ptr<Engine> makeTactus(const Problem& problem);
std::unique_ptr<Engine> makeMujoco(const Problem& problem);
std::unique_ptr<Engine> makeKdl(const Problem& problem);
std::unique_ptr<Engine> makeDart(const Problem& problem);
std::unique_ptr<Engine> makeSimbody(const Problem& problem);

/// This engine first; then every peer that was built in and can be told the problem.  The problem must outlive them.
std::vector<std::unique_ptr<Engine>> makeEngines(const Problem& problem);
/// Peers that were not found when the program was configured, each with the package that brings it.
std::vector<std::string> absentEngines();

}  // namespace tactus::bench
