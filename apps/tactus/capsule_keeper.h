#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/tactus/session.h"
#include "dsl/capsule.h"

namespace tactus::app {

/// Writes the first ticks of a run that failed or came late, and the one that broke it because its back end threw, into
/// its folder, each as capsule-<tick>.json (dsl/capsule.h).  A capsule that cannot be written is a warning: no further
/// one is tried, and the run goes on.
class CapsuleKeeper final : public control::Observer {
 public:
  static constexpr int most_capsules = 5;

  CapsuleKeeper(const Session& session, const std::string& folder);

  void before(const control::Controller& controller) override;
  void observe(const control::ObservedTick& tick) override;
  void broken(const control::BrokenTick& tick) override;

  const std::vector<std::string>& files() const { return files_; }       ///< names within the folder
  /// What could not be written, and which tasks contradicted each other in the first infeasible tick.
  std::vector<std::string> warnings() const;

  static bool isCapsule(const std::string& file_name);

 private:
  bool hasRoom() const { return static_cast<int>(files_.size()) < most_capsules && warnings_.empty(); }
  /// Problem, back end and state of the tick, without what came of it.
  dsl::Capsule capsuleOf(const control::Controller& controller, const control::Sensed& sensed) const;
  void write(const control::TickProblem& problem, const dsl::Capsule& capsule);

  const dsl::Stack& stack_;
  std::map<std::string, std::string> places_;                      // of tasks
  std::string folder_;
  int tick_ = 0;
  control::WarmStart before_;                                      // of the tick
  std::vector<std::string> files_;
  std::vector<std::string> warnings_;
  std::optional<control::TickProblem> infeasible_;                 // the first one
  double infeasible_time_ = 0;                                     // s
  std::vector<std::string> joints_;
};

}  // namespace tactus::app
