#include "tasks/posture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tactus::tasks {

using namespace control;

void Posture::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "posture";
  row.kind = ElementKind::task;
  row.description = "Springs and dampers on joints, towards a rest configuration.";
  row.source = "thesis 4.3.1";
  row.attributes = {
      {.name = "joints", .type = ValueType::joints, .required = true,
       .description = "Joints or joint groups; \"free\" is the set K of 4.3.1.", .choices = {"free"}},
      {.name = "among", .type = ValueType::joints, .description = "For joints=\"free\": only these."},
      {.name = "stiffness", .type = ValueType::reals, .unit = "N m/rad", .default_text = "1",
       .description = "k; one number, or one a joint.", .lower = 0},
      {.name = "damping", .type = ValueType::reals, .unit = "N m s/rad", .default_text = "0.02",
       .description = "d; one number, or one a joint.", .lower = 0},
      {.name = "q", .type = ValueType::reals, .unit = "rad",
       .description = "Reference, one number a joint; not given: the configuration of the first tick."},
      {.name = "swing", .type = ValueType::reals, .unit = "rad", .default_text = "0",
       .description = "The reference swings about itself by so much, from time 0; one number, or one a joint. Joints of "
                      "opposite sign swing against each other."},
      {.name = "swing-rate", .type = ValueType::real, .unit = "Hz", .default_text = "0.5",
       .description = "How often it does.", .lower = 0},
      {.name = "on", .type = ValueType::port, .default_text = "touch.all",
       .description = "For joints=\"free\": the contacts C.", .port_type = "contact-set"},
      {.name = "desired", .type = ValueType::port, .default_text = "touch.desired",
       .description = "For joints=\"free\": the desired links D.", .port_type = "frame-set"},
      {.name = "delay", .type = ValueType::real, .unit = "s", .default_text = "0.2",
       .description = "For joints=\"free\": untouched for so long, all joints are free.", .lower = 0},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<Posture>(context); });
}

namespace {

bool wantsFree(const BuildContext& context) { return context.values.text("joints") == "free"; }

std::vector<int> postureJoints(const BuildContext& context) {
  if (!wantsFree(context)) return context.joints("joints");
  if (context.values.has("among")) return context.joints("among");
  std::vector<int> joints(context.model.dof());
  std::iota(joints.begin(), joints.end(), 0);
  return joints;
}

Eigen::VectorXd onePerJoint(const BuildContext& context, const std::string& attribute, std::size_t count) {
  const std::vector<double>& numbers = context.values.numbers(attribute);
  if (numbers.size() == 1) return Eigen::VectorXd::Constant(count, numbers[0]);
  if (numbers.size() != count) {
    throw ElementError(attribute, attribute + " has " + std::to_string(numbers.size()) + " numbers, expected 1 or " +
                                      std::to_string(count) + " (one a joint)");
  }
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), count);
}

/// Does some chain from the base to a tip hold both the joint and the frame?
bool shareChain(const dynamics::Model& model, int joint, int frame) {
  if (model.supports(joint, frame)) return true;
  // The frame's body is an ancestor of the joint.
  for (int i = 0; i < model.bodyCount(); ++i) {
    if (model.bodies()[i].coordinate != joint) continue;
    int body = model.parent(i);
    while (body >= 0 && body != model.frames()[frame].body) body = model.parent(body);
    if (body >= 0) return true;
  }
  return false;
}

}  // namespace

Posture::Posture(const BuildContext& context) : Posture(context, postureJoints(context)) {}

Posture::Posture(const BuildContext& context, std::vector<int> joints)
    : Task(Relation::equality, static_cast<int>(joints.size())),
      joints_(std::move(joints)),
      stiffness_(onePerJoint(context, "stiffness", joints_.size())),
      damping_(onePerJoint(context, "damping", joints_.size())),
      swing_(onePerJoint(context, "swing", joints_.size())),
      swing_frequency_(2 * std::numbers::pi * context.values.real("swing-rate")),
      reference_(Eigen::VectorXd::Zero(joints_.size())),
      has_reference_(context.values.has("q")) {
  if (has_reference_) reference_ = onePerJoint(context, "q", joints_.size());
  if (!wantsFree(context)) return;

  contacts_ = &context.port<ContactSet>("on");
  delay_ = context.values.real("delay");
  const std::vector<int>& desired = context.port<FrameSet>("desired").frames;
  const int frames = static_cast<int>(context.model.frames().size());
  in_contact_.assign(frames, 0);
  for (const int joint : joints_) {
    std::vector<int>& chain = chain_frames_.emplace_back();
    for (int frame = 0; frame < frames; ++frame) {
      if (shareChain(context.model, joint, frame)) chain.push_back(frame);
    }
    carries_desired_.push_back(
        std::any_of(desired.begin(), desired.end(), [&](int d) { return shareChain(context.model, joint, d); }));
  }
}

bool Posture::isFree(int index) const {
  if (contacts_ == nullptr || !touched_) return true;
  if (carries_desired_[index]) return false;
  const std::vector<int>& chain = chain_frames_[index];
  return std::none_of(chain.begin(), chain.end(), [&](int frame) { return in_contact_[frame] != 0; });
}

void Posture::doUpdate(const Tick& tick, TickTask& rows) {
  if (!has_reference_) {
    for (std::size_t k = 0; k < joints_.size(); ++k) reference_[k] = tick.robot.q()[joints_[k]];
    has_reference_ = true;
  }
  if (contacts_ != nullptr) {
    std::fill(in_contact_.begin(), in_contact_.end(), 0);
    for (const Contact& contact : contacts_->contacts) in_contact_[contact.frame] = 1;
    if (!contacts_->contacts.empty()) {
      touched_ = true;
      last_touch_ = tick.time;
    } else if (tick.time - last_touch_ >= delay_) {
      touched_ = false;
    }
  }
  const double swung = std::sin(swing_frequency_ * tick.time);
  const double swing_speed = swing_frequency_ * std::cos(swing_frequency_ * tick.time);
  rows.rows = 0;
  error_ = 0;
  for (int k = 0; k < static_cast<int>(joints_.size()); ++k) {
    if (!isFree(k)) continue;
    const int i = joints_[k];
    const double away = reference_[k] + swing_[k] * swung - tick.robot.q()[i];
    rows.jacobian.row(rows.rows).setZero();
    rows.jacobian(rows.rows, i) = 1;
    rows.force[rows.rows] = stiffness_[k] * away + damping_[k] * (swing_[k] * swing_speed - tick.robot.qd()[i]);
    ++rows.rows;
    error_ = std::max(error_, std::abs(away));
  }
}

void Posture::doArchive(Archive& archive) {
  archive("reference", reference_);
  archive("has-reference", has_reference_);
  archive("last-touch", last_touch_);
  archive("touched", touched_);
}

bool Posture::displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                           Eigen::Ref<Eigen::VectorXd> dx) const {
  int row = 0;
  for (int k = 0; k < static_cast<int>(joints_.size()); ++k) {
    if (isFree(k)) dx[row++] = to.q()[joints_[k]] - from.q()[joints_[k]];
  }
  return true;
}

}  // namespace tactus::tasks
