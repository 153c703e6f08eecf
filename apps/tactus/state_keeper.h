#pragma once

#include <set>
#include <string>
#include <vector>

#include "apps/tactus/session.h"

namespace tactus::app {

/// Writes the state of a run into its folder, as state-<time>.json, just before the ticks that it was asked for.
/// Throws FileError.
class StateKeeper final : public control::Observer {
 public:
  /// `times` in s, each taken to the nearest tick.
  StateKeeper(Session& session, const std::string& folder, const std::vector<double>& times);

  void before(const control::Controller& controller) override;
  void observe(const control::ObservedTick&) override {}
  /// Whether the tick that comes next is one of them.
  bool isDue() const { return ticks_.contains(session_.tick()); }
  /// The state as it is now, once.
  void save();

  const std::vector<std::string>& files() const { return files_; }       ///< names within the folder

  static bool isState(const std::string& file_name);

 private:
  Session& session_;
  std::string folder_;
  std::set<long> ticks_;
  std::vector<std::string> files_;
};

}  // namespace tactus::app
