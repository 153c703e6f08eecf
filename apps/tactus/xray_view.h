#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/tactus/json_place.h"
#include "apps/tactus/session.h"
#include "framework/control/xray.h"

/// The priority x-ray (framework/control/xray.h) as data, as a table for people, and as a table of a page.
namespace tactus::app {

/// A tick that an x-ray is taken of.
struct XrayedTick {
  double time = 0;                                                 ///< s
  std::string why;                                                 ///< "last tick", "largest loss"; may be empty
  control::TickProblem problem;
  control::TickSolution solution;
};

/// {time, why?, backend, options: {name: text}, status, message?, rank_tolerance, fade, scale, joints: [names],
///  levels: [{priority, wanted, granted, freedom_left}],
///  tasks: [{level, name, place, rows, wanted, granted, lost: [{share, rows, joints: {name: part}, takers: [{task,
///           share}]}], faded: [{sigma, weight}], active: [rows], asked, residual, torque, torque_left?}],
///  limits: [{joint, side: "upper" | "lower", limit_Nm}]}
/// A level is named by its priority; torques in the order of `joints`; `joints` of a direction keeps its largest parts.
nlohmann::ordered_json xrayToJson(const XrayedTick& tick, const Session& session);

/// The rows of the table of tasks, its head first.
std::vector<std::vector<std::string>> xrayRows(const JsonPlace& xray);
/// What the table cannot hold, a sentence each: lost directions and who took them, faded directions, limits.
std::vector<std::string> xraySentences(const JsonPlace& xray);
/// Table and sentences.
std::string xrayText(const JsonPlace& xray);

/// Keeps the tick in which the levels lost the most rank; the last one is in the session.
class XrayKeeper final : public control::Observer {
 public:
  explicit XrayKeeper(const Session& session) : session_(session) {}
  void observe(const control::ObservedTick& tick) override;
  /// {format, xrays: [that of the largest loss, that of the last tick]}; none before the first tick.  After a tick that
  /// threw the session holds only a part of one: no x-ray of it.
  nlohmann::ordered_json describe(bool threw) const;

 private:
  const Session& session_;
  int largest_loss_ = -1;
  XrayedTick worst_;
  double last_time_ = 0;                                           // s
  bool worst_is_last_ = false;
};

inline constexpr const char* xray_format = "tactus-xray/1";
inline constexpr const char* xray_file = "xray.json";

}  // namespace tactus::app
