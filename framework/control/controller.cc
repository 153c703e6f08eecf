#include "framework/control/controller.h"

#include <algorithm>
#include <cmath>

#include "framework/control/element_values.h"
#include "framework/control/refuse_torque.h"

namespace tactus::control {

namespace {

/// Numbers beyond it overflow when a back end squares them.
constexpr double largest_usable = 1e150;

template <class Matrix>
bool isUsable(const Matrix& numbers) {
  return numbers.size() == 0 || (numbers.allFinite() && numbers.cwiseAbs().maxCoeff() < largest_usable);
}

bool isUsable(const TickTask& task) {
  return isUsable(task.J()) && isUsable(task.F()) && isUsable(task.J().transpose() * task.F()) &&
         (!task.has_acceleration || isUsable(task.acceleration.head(task.rows)));
}

/// Numbers that no back end can work with.
struct NoNumbers : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs the step of one part of the stack, "task 'hold'"; what it throws becomes a TickError that names the part.
template <class Step, class Name>
void guarded(TickError::Part part, double time, Step step, Name name) {
  const auto where = [&] { return name() + " failed at t = " + formatNumber(time) + " s"; };
  try {
    step();
  } catch (const std::exception& error) {
    throw TickError(part, where(), error.what());
  } catch (...) {
    throw TickError(part, where(), "it threw something that is not a std::exception");
  }
}

/// A task must leave its storage as it got it, and fill no more rows than it announced.
void checkRows(const TickTask& rows, int capacity, int dof) {
  if (rows.rows < 0 || rows.rows > capacity) {
    throw std::runtime_error("it fills " + std::to_string(rows.rows) + " rows, but announced at most " +
                             std::to_string(capacity));
  }
  if (rows.jacobian.rows() != capacity || rows.jacobian.cols() != dof || rows.force.size() != capacity ||
      rows.acceleration.size() != capacity) {
    throw std::runtime_error("it changed the size of its rows: jacobian must stay " + std::to_string(capacity) + " × " +
                             std::to_string(dof) + ", force and acceleration " + std::to_string(capacity));
  }
}

TickProblem makeProblemShape(const dynamics::Model& model, const std::vector<Level>& levels,
                             std::optional<int> limits_priority) {
  const int dof = model.dof();
  TickProblem problem;
  problem.dof = dof;
  problem.mass_matrix = Eigen::MatrixXd::Identity(dof, dof);
  TorqueLimits limits;
  limits.lower = -model.effort();
  limits.upper = model.effort();
  limits.priority = limits_priority;
  problem.torque_limits = limits;
  for (const Level& level : levels) {
    TickLevel& shape = problem.levels.emplace_back();
    shape.priority = level.priority;
    shape.weight = level.weight;
    for (const NamedTask& named : level.tasks) {
      TickTask& task = shape.tasks.emplace_back(named.name, named.task->capacity(), dof);
      task.relation = named.task->relation();
      task.contact = named.task->isContact();
    }
  }
  return problem;
}

}  // namespace

Controller::Controller(std::shared_ptr<const dynamics::Model> model, std::vector<NamedSignal> signals,
                       std::vector<Level> levels, std::unique_ptr<BackEnd> back_end, double period,
                       const Eigen::Vector3d& gravity_W, const ControllerOptions& options,
                       std::unique_ptr<Readings> readings)
    : model_(std::move(model)),
      signals_(std::move(signals)),
      levels_(std::move(levels)),
      back_end_(std::move(back_end)),
      readings_(readings ? std::move(readings) : std::make_unique<Readings>()),
      period_(period),
      options_(options),
      cache_(*model_, gravity_W),
      sensing_(*model_, static_cast<int>(model_->frames().size()), options.hold, period),
      problem_(makeProblemShape(*model_, levels_, options.limits_priority)),
      shaper_(model_->effort(), options.torque_rate, period),
      wanted_(Eigen::VectorXd::Zero(model_->dof())),
      last_solved_(Eigen::VectorXd::Zero(model_->dof())) {
  back_end_->setDeadline(options_.deadline);
  back_end_->prepare(problem_, solution_);
}

const Eigen::VectorXd& Controller::tick(const Sensed& raw) {
  record_ = TickRecord{};
  const Sensed& sensed = sensing_.check(raw);
  readings_->take(raw.readings);
  record_.sensing = sensing_.record();
  if (record_.sensing.blind)
    bearWeight(sensed);
  else
    solveTick(sensed);
  applyTorque();
  return shaper_.torque();
}

void Controller::solveTick(const Sensed& sensed) {
  cache_.update(sensed.q, sensed.qd);
  const Tick now{sensed.time, period_, sensed, cache_};
  updateSignals(now);
  assembleProblem(now);
  guarded(TickError::Part::back_end, now.time, [&] { back_end_->solve(problem_, solution_); }, [&] {
    const std::string& name = back_end_->recipe().back_end;
    return name.empty() ? "the back end" : "back end '" + name + "'";
  });
  chooseTorque();
}

void Controller::updateSignals(const Tick& tick) {
  for (NamedSignal& named : signals_) {
    if (named.switched_off) continue;
    const auto name = [&] { return "signal '" + named.name + "'"; };
    try {
      guarded(TickError::Part::signal, tick.time, [&] { named.signal->update(tick); }, name);
    } catch (const TickError& fault) {
      if (options_.on_fault != OnFault::switch_off) throw;
      named.switched_off = true;
      switchOffReaders(tick, named, name() + ": " + fault.reason);
    }
  }
}

void Controller::bearWeight(const Sensed& sensed) {
  record_.status = Status::failed;
  record_.source = TorqueSource::gravity;
  unsolved_for_ += period_;
  if (sensing_.knowsState()) {
    cache_.update(sensed.q, sensed.qd);
    wanted_ = cache_.bias();
  } else {
    wanted_.setZero();
  }
}

void Controller::chooseTorque() {
  const bool finite = solution_.torque.allFinite();
  if (!finite) refuseTorque(solution_);
  record_.status = solution_.status;
  record_.late = solution_.late;
  record_.limited = solution_.scale < 1;
  const bool solved = solution_.status == Status::ok && finite;
  if (!solved) record_.unusable_task = findUnusableTask();
  wanted_ = solution_.torque + cache_.bias();
  unsolved_for_ = solved ? 0 : unsolved_for_ + period_;
  if (solved) {
    record_.source = TorqueSource::solved;
  } else if (finite && !record_.unusable_task) {
    record_.source = TorqueSource::partial;
  } else if (unsolved_for_ <= options_.hold + 1e-9) {
    record_.source = TorqueSource::held;
    wanted_ = last_solved_;
  } else {
    record_.source = TorqueSource::gravity;
    wanted_ = cache_.bias();
  }
}

void Controller::applyTorque() {
  const TorqueSource source = record_.source;
  record_.fallback = source != TorqueSource::solved;
  // Between the others the torque goes on by itself: `partial` keeps the upper levels, `held` what was applied.
  const bool bears_weight = source == TorqueSource::gravity;
  if (bears_weight != bore_weight_) shaper_.startTransfer(options_.ramp);
  bore_weight_ = bears_weight;
  shaper_.apply(wanted_);
  record_.limited = record_.limited || shaper_.limited();
  record_.rate_limited = shaper_.rateLimited();
  if (source == TorqueSource::solved) last_solved_ = shaper_.torque();
}

void Controller::assembleProblem(const Tick& tick) {
  problem_.mass_matrix = cache_.massMatrix();
  problem_.torque_limits->lower = -model_->effort() - cache_.bias();
  problem_.torque_limits->upper = model_->effort() - cache_.bias();
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    if (level.activation.advance(tick.time, tick.dt)) shaper_.startTransfer(level.activation.ramp());
    if (level.owner.controller && !level.owner.switched_off && level.activation.stands()) steer(tick, i);
    for (std::size_t k = 0; k < level.tasks.size(); ++k) {
      NamedTask& named = level.tasks[k];
      TickTask& rows = problem_.levels[i].tasks[k];
      if (named.activation.advance(tick.time, tick.dt)) shaper_.startTransfer(named.activation.ramp());
      if (named.switched_off || !level.activation.stands() || !named.activation.stands()) {
        rows.rows = 0;
        continue;
      }
      fillRows(tick, named, rows);
      const double share = level.activation.share() * named.activation.share();
      if (share == 1) continue;
      rows.force.head(rows.rows) *= share;
      rows.acceleration.head(rows.rows) *= share;
    }
  }
}

void Controller::steer(const Tick& tick, std::size_t index) {
  Level& level = levels_[index];
  const auto update = [&] { level.owner.controller->update(tick); };
  const auto name = [&] { return "controller '" + level.owner.name + "'"; };
  if (options_.on_fault != OnFault::switch_off)
    return guarded(TickError::Part::controller, tick.time, update, name);
  try {
    guarded(TickError::Part::controller, tick.time, update, name);
  } catch (const TickError& fault) {
    switchOffOwner(tick, index, name() + ": " + fault.reason);
  }
}

void Controller::switchOffOwner(const Tick& tick, std::size_t index, const std::string& reason) {
  Level& level = levels_[index];
  level.owner.switched_off = true;
  for (std::size_t k = 0; k < level.tasks.size(); ++k)
    if (!level.tasks[k].switched_off) switchOff(tick, level.tasks[k], problem_.levels[index].tasks[k], reason, true);
}

void Controller::switchOffReaders(const Tick& tick, const NamedSignal& signal, const std::string& reason) {
  const auto reads = [&](const std::string& name) {
    return std::find(signal.readers.begin(), signal.readers.end(), name) != signal.readers.end();
  };
  for (NamedSignal& other : signals_) {
    if (other.switched_off || !reads(other.name)) continue;
    other.switched_off = true;
    switchOffReaders(tick, other, reason);
  }
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    if (level.owner.controller && !level.owner.switched_off && reads(level.owner.name)) switchOffOwner(tick, i, reason);
    for (std::size_t k = 0; k < level.tasks.size(); ++k)
      if (!level.tasks[k].switched_off && reads(level.tasks[k].name))
        switchOff(tick, level.tasks[k], problem_.levels[i].tasks[k], reason, true);
  }
}

void Controller::fillRows(const Tick& tick, NamedTask& named, TickTask& rows) {
  const auto update = [&] {
    named.task->update(tick, rows);
    checkRows(rows, named.task->capacity(), problem_.dof);
  };
  constexpr const char* no_numbers = "it gave numbers that are not finite, or too large to work with";
  if (options_.on_fault == OnFault::fall_back) {
    guarded(TickError::Part::task, tick.time, update, [&] { return "task '" + named.name + "'"; });
    return;
  }
  const auto judged = [&] {
    update();
    if (!isUsable(rows.J()) || !isUsable(rows.F())) throw NoNumbers(no_numbers);
    if (rows.has_acceleration && !isUsable(rows.acceleration.head(rows.rows))) throw NoNumbers(no_numbers);
  };
  if (options_.on_fault == OnFault::end) {
    guarded(TickError::Part::task, tick.time, judged, [&] { return "task '" + named.name + "'"; });
    return;
  }
  try {
    judged();
  } catch (const NoNumbers& fault) {
    switchOff(tick, named, rows, fault.what(), false);
  } catch (const std::exception& fault) {
    switchOff(tick, named, rows, fault.what(), true);
  } catch (...) {
    switchOff(tick, named, rows, "it threw something that is not a std::exception", true);
  }
}

// Its rows are made anew: it may have left them in any shape.
void Controller::switchOff(const Tick& tick, NamedTask& named, TickTask& rows, const std::string& reason, bool threw) {
  named.switched_off = true;
  TickTask clean(named.name, named.task->capacity(), problem_.dof);
  clean.relation = named.task->relation();
  clean.contact = named.task->isContact();
  rows = std::move(clean);
  switched_off_.push_back({named.name, tick.time, reason, threw});
  shaper_.startTransfer(options_.ramp);
}

Controller::Place Controller::placeOf(std::string_view task) const {
  std::string known;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    for (std::size_t k = 0; k < levels_[i].tasks.size(); ++k) {
      if (levels_[i].tasks[k].name == task) return {i, k};
      known += (known.empty() ? "" : ", ") + levels_[i].tasks[k].name;
    }
  }
  throw std::invalid_argument("there is no task '" + std::string(task) + "': there are " + known);
}

std::size_t Controller::levelOf(int priority) const {
  std::string known;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    if (levels_[i].priority == priority) return i;
    known += (known.empty() ? "" : ", ") + std::to_string(levels_[i].priority);
  }
  throw std::invalid_argument("there is no level of priority " + std::to_string(priority) + ": there are " + known);
}

const Activation& Controller::activationOf(std::string_view task) const {
  const Place at = placeOf(task);
  return levels_[at.level].tasks[at.task].activation;
}

void archive(Archive& archive, SwitchedOff& fault) {
  archive("task", fault.task);
  archive("time", fault.time);
  archive("reason", fault.reason);
  archive("threw", fault.threw);
}

void Controller::setActive(std::string_view task, bool active) {
  const Place at = placeOf(task);
  levels_[at.level].tasks[at.task].activation.setActive(active);
}

void Controller::setActive(int priority, bool active) { levels_[levelOf(priority)].activation.setActive(active); }

void Controller::setWeight(int priority, double weight) {
  const std::size_t level = levelOf(priority);
  if (!(weight > 0) || !std::isfinite(weight))
    throw std::invalid_argument("the weight of a level is finite and > 0, not " + formatNumber(weight));
  levels_[level].weight = problem_.levels[level].weight = weight;
  shaper_.startTransfer(options_.ramp);
}

void Controller::setPriority(std::string_view task, int priority) {
  const Place from = placeOf(task);
  const std::size_t to = levelOf(priority);
  if (from.level == to) return;
  const auto move = [&](auto& tasks_from, auto& tasks_to) {
    tasks_to.push_back(std::move(tasks_from[from.task]));
    tasks_from.erase(tasks_from.begin() + static_cast<std::ptrdiff_t>(from.task));
  };
  move(levels_[from.level].tasks, levels_[to].tasks);
  move(problem_.levels[from.level].tasks, problem_.levels[to].tasks);
  back_end_->prepare(problem_, solution_);
  shaper_.startTransfer(options_.ramp);
}

void Controller::setBackEnd(std::unique_ptr<BackEnd> back_end) {
  if (!back_end) throw std::invalid_argument("a controller needs a back end");
  for (const Level& level : levels_)
    for (const NamedTask& named : level.tasks)
      if (named.task->relation() == Relation::inequality && !back_end->abilities().inequalities)
        throw std::invalid_argument("task '" + named.name + "' is an inequality, and the back end honours none");
  back_end->setDeadline(options_.deadline);
  back_end->prepare(problem_, solution_);
  back_end_ = std::move(back_end);
  shaper_.startTransfer(options_.ramp);
}

void Controller::archive(Archive& archive) {
  archive("sensing", sensing_);
  archive("readings", *readings_);
  for (NamedSignal& named : signals_)
    archive.within("signal/" + named.name, [&] {
      archive("switched-off", named.switched_off);
      named.signal->archive(archive);
    });
  for (Level& level : levels_) {
    archive.within("level/" + std::to_string(level.priority), [&] { archive("activation", level.activation); });
    if (level.owner.controller)
      archive.within("owner/" + level.owner.name, [&] {
        archive("switched-off", level.owner.switched_off);
        level.owner.controller->archive(archive);
      });
    for (NamedTask& named : level.tasks)
      archive.within("task/" + named.name, [&] {
        archive("switched-off", named.switched_off);
        archive("activation", named.activation);
        named.task->archive(archive);
      });
  }
  archive.growing("switched-off", switched_off_);
  archive("torque", shaper_);
  archive.finite("last-solved", last_solved_);
  archive("unsolved-for", unsolved_for_);
  archive("bore-weight", bore_weight_);
  WarmStart warm = back_end_->warmStart();
  archive.within("back-end/" + back_end_->recipe().back_end, [&] { archive.growing("warm-start", warm); });
  if (archive.restores()) back_end_->setWarmStart(warm);
}

const std::string* Controller::findUnusableTask() const {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    for (std::size_t k = 0; k < levels_[i].tasks.size(); ++k) {
      if (!isUsable(problem_.levels[i].tasks[k])) return &levels_[i].tasks[k].name;
    }
  }
  return nullptr;
}

}  // namespace tactus::control
