#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/control/observer.h"
#include "framework/description/scene.h"
#include "framework/dynamics/kinematics.h"
#include "framework/runtime/csv_writer.h"

namespace tactus::runtime {

/// Writes what happened in space, a frame every 20 ms, as it truly was, whatever sensors told:
///   replay.csv           time and, each as its path,
///                        link/<name>/{x,y,z,qw,qx,qy,qz}    link frames in W of links with shapes that move
///                        object/<name>/{x,y,z,qw,qx,qy,qz}  object frames in W of objects that move
///                        mark/<task>/<name>/{x,y,z}         what tasks steer for (Task::marks)
///   replay_contacts.csv  time, link, on, x, y, z, force_x, force_y, force_z: every touch of that frame, on an object or
///                        another link; the force is what the link does, friction included
/// Lengths in m to 10 µm, quaternions with w ≥ 0 to 1e-5, forces in N to 0.1 mN.  Repeats to the byte.
/// What is older than a second of the wall clock is in the files at every tick.
/// Throws FileError when a file cannot be written.
class ReplayRecorder final : public control::Observer {
 public:
  static constexpr double frame_time = 0.02;                       ///< s; the period of the control where that is longer

  /// `robot` and `scene` outlive it; `first_tick` of the run, counted from its start.
  ReplayRecorder(const std::string& folder, const description::Robot& robot, const description::Scene& scene,
                 long first_tick = 0);

  void observe(const control::ObservedTick& tick) override;
  /// Without it errors of the last rows are lost.
  void close() override;

 private:
  void start(const control::Controller& controller);
  void record(const control::ObservedTick& tick);
  void recordContacts(const control::Sensed& truth);

  std::string folder_;
  const description::Robot& robot_;
  const description::Scene& scene_;
  CsvWriter contacts_;
  std::optional<CsvWriter> frames_;                                // from the first tick on, as all that follows
  std::optional<dynamics::Workspace> workspace_;
  std::vector<int> links_;
  std::vector<size_t> objects_;
  std::vector<const Eigen::Vector3d*> marks_W_;
  long ticks_;
  long ticks_per_frame_ = 1;
};

}  // namespace tactus::runtime
