#include "tasks/broken_rows.h"

#include <algorithm>

#include "framework/control/controller.h"

namespace tactus::tasks {

using namespace control;

namespace {

constexpr double tolerance = 1e-6;                                 // where the default fades of the back ends end
constexpr double none = std::numeric_limits<double>::quiet_NaN();

bool hasRows(const TickLevel& level) {
  return std::any_of(level.tasks.begin(), level.tasks.end(), [](const TickTask& task) { return task.rows > 0; });
}

}  // namespace

void BrokenRows::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "broken-rows";
  row.description =
      "How often, and how hard, lower levels press on rows of inequality tasks, which they must not: each tick is solved "
      "again without them.";
  row.source = "thesis 4.2.9";
  registry.addMeasure(row, [](const MeasureContext& context) { return std::make_unique<BrokenRows>(context); });
}

BrokenRows::BrokenRows(const MeasureContext& context)
    : back_end_(context.another_back_end ? context.another_back_end() : nullptr),
      above_(context.controller.problem()),
      whitened_(above_),
      y_(Eigen::VectorXd::Zero(above_.dof)),
      y_above_(y_) {
  if (!back_end_) throw ElementError("name", "the controller's back end cannot be made a second time");
  back_end_->setDeadline(context.controller.options().deadline);
  back_end_->setReportsRanks(false);
  back_end_->prepare(above_, answer_);
  for (const TickLevel& level : above_.levels)
    for (const TickTask& task : level.tasks)
      if (task.relation == Relation::inequality) tasks_.push_back({.task = task.name});
}

void BrokenRows::doObserve(const ObservedTick& tick) {
  rows_now_ = 0;
  for (Figures& task : tasks_) task.now = 0;
  const TickProblem& problem = tick.controller.problem();
  if (tick.controller.record().source != TorqueSource::solved || !whitened_.update(problem)) return;
  if (!unscaled(whitened_, tick.controller.solution(), y_)) return;
  above_ = problem;
  bool judged = false;
  bool has_below = false;
  for (int i = whitened_.levelCount() - 1; i >= 0; --i) {
    TickLevel& level = above_.levels[static_cast<std::size_t>(i)];
    if (has_below && whitened_.inequalityRowsAbove(i + 1) > whitened_.inequalityRowsAbove(i)) {
      back_end_->solve(above_, answer_);
      if (answer_.status == Status::ok && unscaled(whitened_, answer_, y_above_)) {
        judge(problem, i);
        judged = true;
      }
    }
    has_below = has_below || hasRows(level);
    for (TickTask& task : level.tasks) task.rows = 0;
  }
  ticks_ += judged;
  broken_ticks_ += rows_now_ > 0;
}

bool BrokenRows::unscaled(const WhitenedProblem& whitened, const TickSolution& solution, Eigen::VectorXd& y) {
  if (!(solution.scale > 0)) return false;
  y = solution.torque / solution.scale;
  whitened.massFactor().triangularView<Eigen::Lower>().solveInPlace(y);
  return y.allFinite();
}

void BrokenRows::judge(const TickProblem& problem, int level) {
  const double bound = tolerance * (y_.norm() + y_above_.norm());
  y_above_ = y_ - y_above_;
  const int begin = whitened_.firstInequality() + whitened_.inequalityRowsAbove(level);
  const int end = whitened_.firstInequality() + whitened_.inequalityRowsAbove(level + 1);
  for (int j = begin; j < end; ++j) {
    const ActiveRow& at = whitened_.origin(j);
    Figures& task = figuresOf(
        problem.levels[static_cast<std::size_t>(at.level)].tasks[static_cast<std::size_t>(at.task)].name);
    ++task.rows;
    const double pressed = whitened_.row(j).dot(y_above_);
    if (!(pressed > bound) || !(whitened_.norm(j) > 0)) continue;
    const double force = pressed / whitened_.norm(j);
    ++task.broken;
    task.force_sum += force;
    task.now = std::max(task.now, force);
    task.force_max = std::max(task.force_max, force);
    rows_now_ += 1;
  }
}

BrokenRows::Figures& BrokenRows::figuresOf(const std::string& task) {
  return *std::find_if(tasks_.begin(), tasks_.end(), [&](const Figures& figures) { return figures.task == task; });
}

void BrokenRows::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"rows", &rows_now_});
  for (const Figures& task : tasks_) columns.push_back({task.task, &task.now});
}

void BrokenRows::metrics(std::vector<Metric>& metrics) const {
  const auto share = [](long part, long whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : none;
  };
  metrics.push_back({"share", share(broken_ticks_, ticks_)});
  for (const Figures& task : tasks_) {
    const double mean = task.broken > 0 ? task.force_sum / static_cast<double>(task.broken) : 0;
    metrics.push_back({task.task + "_share", share(task.broken, task.rows)});
    metrics.push_back({task.task + "_mean", task.rows > 0 ? mean : none});
    metrics.push_back({task.task + "_max", task.rows > 0 ? task.force_max : none});
  }
}

void BrokenRows::Figures::archive(Archive& archive) {
  archive("rows", rows);
  archive("broken", broken);
  archive("force-sum", force_sum);
  archive("force-max", force_max);
}

void BrokenRows::doArchive(Archive& archive) {
  archive("ticks", ticks_);
  archive("broken-ticks", broken_ticks_);
  for (Figures& task : tasks_) archive.within(task.task, [&] { archive("figures", task); });
  WarmStart warm = back_end_->warmStart();
  archive.within("back-end", [&] { archive.growing("warm-start", warm); });
  if (archive.restores()) back_end_->setWarmStart(warm);
}

}  // namespace tactus::tasks
