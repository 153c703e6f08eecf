#include "framework/runtime/replay_recorder.h"

#include <algorithm>
#include <cmath>

namespace tactus::runtime {
namespace {

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit + 0.0; }  // no −0

void write(CsvWriter& row, const Eigen::Vector3d& vector, double per_unit) {
  for (const double number : vector) row << rounded(number, per_unit);
}

constexpr double per_metre = 1e5, per_newton = 1e4, per_one = 1e5;

void write(CsvWriter& row, const Eigen::Isometry3d& pose) {
  write(row, pose.translation(), per_metre);
  const Eigen::Quaterniond q(pose.linear());
  const double sign = std::copysign(1.0, q.w());
  for (const double number : {q.w(), q.x(), q.y(), q.z()}) row << rounded(sign * number, per_one);
}

void addPose(std::vector<std::string>& columns, const std::string& path) {
  for (const char* number : {"x", "y", "z", "qw", "qx", "qy", "qz"}) columns.push_back(path + "/" + number);
}

}  // namespace

ReplayRecorder::ReplayRecorder(const std::string& folder, const description::Robot& robot,
                               const description::Scene& scene, long first_tick)
    : folder_(folder),
      robot_(robot),
      scene_(scene),
      contacts_(folder + "/replay_contacts.csv",
                {"time", "link", "on", "x", "y", "z", "force_x", "force_y", "force_z"}),
      ticks_(first_tick) {}

void ReplayRecorder::start(const control::Controller& controller) {
  const dynamics::Model& model = controller.model();
  workspace_.emplace(model);
  ticks_per_frame_ = std::max(1L, std::lround(frame_time / controller.period()));

  std::vector<std::string> columns{"time"};
  for (int link = 0; link < static_cast<int>(robot_.links.size()); ++link) {
    if (robot_.links[link].shapes.empty() || model.frames()[link].body < 0) continue;
    links_.push_back(link);
    addPose(columns, "link/" + robot_.links[link].name);
  }
  for (size_t object = 0; object < scene_.objects.size(); ++object) {
    if (scene_.objects[object].mobility == description::Mobility::fixed) continue;
    objects_.push_back(object);
    addPose(columns, "object/" + scene_.objects[object].name);
  }
  for (const control::Level& level : controller.levels())
    for (const control::NamedTask& named : level.tasks) {
      std::vector<control::Mark> marks;
      named.task->marks(marks);
      for (const control::Mark& mark : marks) {
        for (const char axis : {'x', 'y', 'z'}) columns.push_back("mark/" + named.name + "/" + mark.name + "/" + axis);
        marks_W_.push_back(mark.position_W);
      }
    }
  frames_.emplace(folder_ + "/replay.csv", columns);
}

void ReplayRecorder::observe(const control::ObservedTick& tick) {
  if (!frames_) start(tick.controller);
  if (ticks_++ % ticks_per_frame_ == 0) record(tick);
  frames_->flushWhenDue();
  contacts_.flushWhenDue();
}

void ReplayRecorder::record(const control::ObservedTick& tick) {
  const dynamics::Model& model = tick.controller.model();
  dynamics::forwardKinematics(model, tick.truth.q, *workspace_);
  *frames_ << tick.truth.time;
  for (const int link : links_) write(*frames_, dynamics::framePose(model, *workspace_, link));
  for (const size_t object : objects_)
    write(*frames_, object < tick.objects.size() ? tick.objects[object].pose : scene_.objects[object].pose);
  for (const Eigen::Vector3d* mark_W : marks_W_) write(*frames_, *mark_W, per_metre);
  frames_->endRow();
  recordContacts(tick.truth);
}

void ReplayRecorder::recordContacts(const control::Sensed& truth) {
  for (const control::ContactRecord& contact : truth.contacts) {
    if (contact.force_N <= 0) continue;
    contacts_ << truth.time << robot_.links[contact.link].name
              << (contact.isOfSelf() ? robot_.links[contact.other_link].name : scene_.objects[contact.object].name);
    write(contacts_, contact.point_W, per_metre);
    write(contacts_, contact.force_N * contact.normal_W + contact.friction_W, per_newton);
    contacts_.endRow();
  }
}

void ReplayRecorder::close() {
  if (frames_) frames_->close();
  contacts_.close();
}

}  // namespace tactus::runtime
