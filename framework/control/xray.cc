#include "framework/control/xray.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "framework/control/least_distance.h"
#include "framework/control/level_ranks.h"
#include "framework/control/whitened_problem.h"

namespace tactus::control {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double at_limit = 1e-6;                                  // relative to the limits' distance
constexpr double same_torque = 1e-6;                               // relative, of a cascade's sum and the tick's torque
constexpr double same_share = 1e-9;                                // of two takers: the higher one goes first

/// The rows of a task as unit columns, and an orthonormal basis of their span.
struct Span {
  MatrixXd unit;                                                   // dof × rows
  MatrixXd basis;                                                  // dof × rank
  MatrixXd coefficients;                                           // basis = unit · coefficients
  int rank = 0;
};

/// Σ JᵀF of a level, N m.
VectorXd ownTorque(const TickLevel& level) {
  VectorXd torque = VectorXd::Zero(level.tasks.empty() ? 0 : level.tasks[0].jacobian.cols());
  for (const TickTask& rows : level.tasks) torque += rows.J().transpose() * rows.F();
  return torque;
}

/// Norms over the rows that ask for something; `acceleration` is M⁻¹ τ, `own` M⁻¹ Σ JᵀF of the task's level.
TaskError taskError(const TickTask& rows, const VectorXd& acceleration, const VectorXd& own) {
  double asked = 0, residual = 0;
  for (int row = 0; row < rows.rows; ++row) {
    if (rows.relation == Relation::inequality && rows.force[row] == 0) continue;
    const auto j = rows.jacobian.row(row);
    const double a = rows.has_acceleration ? rows.acceleration[row] : j.dot(own);
    const double r = j.dot(acceleration) - a;
    asked += a * a;
    residual += r * r;
  }
  return {0, 0, std::sqrt(asked), std::sqrt(residual)};
}

class Machine {
 public:
  Machine(const TickProblem& problem, const TickSolution& solution, const XrayOptions& options)
      : problem_(problem), solution_(solution), options_(options), whitened_(problem) {}

  Xray look() {
    Xray xray;
    xray.usable = whitened_.update(problem_) && solution_.torque.size() == problem_.dof && solution_.torque.allFinite();
    if (!xray.usable) return xray;
    y_ = whitened_.massFactor().triangularView<Eigen::Lower>().solve(solution_.torque);
    xray.scale = solution_.scale;
    for (int i = 0; i <= levelCount(); ++i) above_.push_back(makeAbove(i));
    lookAtLevels(xray);
    for (int i = 0; i < levelCount(); ++i)
      for (int t = 0; t < taskCount(i); ++t)
        if (problem_.levels[i].tasks[t].rows > 0) xray.tasks.push_back(lookAtTask(i, t));
    lookAtCascade(xray);
    xray.limits = limitsHit(problem_, solution_.torque);
    return xray;
  }

 private:
  int levelCount() const { return static_cast<int>(problem_.levels.size()); }
  int taskCount(int level) const { return static_cast<int>(problem_.levels[level].tasks.size()); }
  const TickTask& task(int level, int index) const { return problem_.levels[level].tasks[index]; }

  bool isActive(const ActiveRow& at) const {
    for (const LevelReport& level : solution_.levels)
      for (const ActiveRow& row : level.active)
        if (row.level == at.level && row.task == at.task && row.row == at.row) return true;
    return false;
  }

  /// Does the row keep lower levels from anything in this tick?
  bool isHeld(int column) const {
    return column < whitened_.firstInequality() || isActive(whitened_.origin(column));
  }

  /// Unit rows as columns, dof × m.
  MatrixXd columns(const std::vector<int>& indices) const {
    MatrixXd unit(problem_.dof, static_cast<Eigen::Index>(indices.size()));
    for (std::size_t k = 0; k < indices.size(); ++k) unit.col(static_cast<Eigen::Index>(k)) = whitened_.row(indices[k]);
    return unit;
  }

  Span span(const MatrixXd& unit) const {
    Span span;
    span.unit = unit;
    span.basis.resize(unit.rows(), 0);
    if (unit.cols() == 0) return span;
    const Eigen::JacobiSVD<MatrixXd> svd(unit, Eigen::ComputeThinU | Eigen::ComputeThinV);
    while (span.rank < svd.singularValues().size() && svd.singularValues()[span.rank] > options_.rank.rank_tolerance)
      ++span.rank;
    span.basis = svd.matrixU().leftCols(span.rank);
    span.coefficients = svd.matrixV().leftCols(span.rank) *
                        svd.singularValues().head(span.rank).cwiseInverse().asDiagonal();
    return span;
  }

  template <class Accept>
  std::vector<int> columnsWhere(Accept accept) const {
    std::vector<int> columns;
    for (int j = 0; j < whitened_.rowCount(); ++j)
      if (whitened_.norm(j) > 0 && accept(whitened_.origin(j), j)) columns.push_back(j);
    return columns;
  }
  std::vector<int> columnsOf(int level, int index) const {
    return columnsWhere([&](const ActiveRow& at, int) { return at.level == level && at.task == index; });
  }
  std::vector<int> heldColumnsOf(int level, int index) const {
    return columnsWhere([&](const ActiveRow& at, int j) { return at.level == level && at.task == index && isHeld(j); });
  }

  /// What all levels above `level` hold: equality rows level by level, then active inequality rows.
  PriorityFactor makeAbove(int level) const {
    PriorityFactor factor(problem_.dof, std::max(1, whitened_.rowCount()), levelCount() + 1, options_.rank);
    const auto hold = [&](const std::vector<int>& indices) {
      RowMajorMatrix rows = columns(indices);
      factor.advance(rows);
      factor.hold(rows);
    };
    const int first = whitened_.firstInequality();
    for (int i = 0; i < level; ++i)
      hold(columnsWhere([&](const ActiveRow& at, int j) { return at.level == i && j < first; }));
    hold(columnsWhere([&](const ActiveRow& at, int j) { return at.level < level && j >= first && isHeld(j); }));
    return factor;
  }

  /// What is left of the columns: zero in the coordinates that are held.
  static MatrixXd left(PriorityFactor& factor, const MatrixXd& columns) {
    RowMajorMatrix rows = columns;
    factor.advance(rows);
    rows.topRows(factor.held()).setZero();
    return rows;
  }

  void lookAtLevels(Xray& xray) {
    TickSolution ranks;
    ranks.levels.resize(problem_.levels.size());
    LevelRanks(problem_, options_.rank).report(whitened_, ranks);
    for (int i = 0; i < levelCount(); ++i) {
      const int wanted = span(columns(columnsWhere([&](const ActiveRow& at, int j) {
                           return at.level == i && j < whitened_.firstInequality();
                         }))).rank;
      xray.levels.push_back({problem_.levels[i].priority, wanted, ranks.levels[i].rank, ranks.levels[i].nullity});
    }
  }

  TaskXray lookAtTask(int level, int index) const {
    const TickTask& rows = task(level, index);
    const std::vector<int> indices = columnsOf(level, index);
    const Span own = span(columns(indices));
    TaskXray xray;
    xray.level = level;
    xray.task = index;
    xray.rows = rows.rows;
    xray.wanted = own.rank;
    xray.torque = rows.J().transpose() * rows.F();
    for (int row = 0; row < rows.rows; ++row)
      if (isActive({level, index, row})) xray.active.push_back(row);
    lookAtErrors(rows, xray);
    if (own.rank == 0) return xray;

    PriorityFactor& factor = above_[level];
    const VectorXd sigmas = Eigen::JacobiSVD<MatrixXd>(left(factor, own.unit)).singularValues();
    for (const double sigma : sigmas.head(std::min<Eigen::Index>(sigmas.size(), own.rank))) {
      if (sigma <= options_.rank.rank_tolerance) continue;
      ++xray.granted;
      if (sigma < options_.rank.fade) xray.faded.push_back({sigma, fadeWeight(sigma, options_.rank)});
    }
    lookAtLoss(own, indices, factor, xray);
    return xray;
  }

  void lookAtErrors(const TickTask& rows, TaskXray& xray) const {
    const VectorXd own = ownTorque(problem_.levels[static_cast<std::size_t>(xray.level)]);
    const TaskError error = taskError(rows, solve(solution_.torque), solve(own));
    xray.asked = error.asked;
    xray.residual = error.residual;
  }

  /// M⁻¹ τ
  VectorXd solve(const VectorXd& torque) const {
    VectorXd x = whitened_.massFactor().triangularView<Eigen::Lower>().solve(torque);
    whitened_.massFactor().triangularView<Eigen::Lower>().transpose().solveInPlace(x);
    return x;
  }

  // cos²θ = 1 − σ², σ the singular values of what is left of an orthonormal basis.
  void lookAtLoss(const Span& own, const std::vector<int>& indices, PriorityFactor& factor, TaskXray& xray) const {
    const MatrixXd remaining = left(factor, own.basis);
    const Eigen::JacobiSVD<MatrixXd> svd(remaining, Eigen::ComputeFullV);
    for (int k = own.rank - 1; k >= 0; --k) {
      const double sigma = k < svd.singularValues().size() ? svd.singularValues()[k] : 0;
      const double share = 1 - std::min(1.0, sigma * sigma);
      if (share < options_.least_share) return;
      const VectorXd direction = own.basis * svd.matrixV().col(k);
      LostDirection lost;
      lost.share = share;
      lost.rows = rowsOf(own, indices, svd.matrixV().col(k), task(xray.level, xray.task));
      lost.joints = task(xray.level, xray.task).J().transpose() * lost.rows;
      lost.joints.normalize();
      lost.takers = takersOf(direction, xray.level);
      xray.lost.push_back(std::move(lost));
    }
  }

  /// The combination of the task's rows behind a direction of their span.
  VectorXd rowsOf(const Span& own, const std::vector<int>& indices, const VectorXd& direction,
                  const TickTask& rows) const {
    const VectorXd unit = own.coefficients * direction;
    VectorXd combination = VectorXd::Zero(rows.rows);
    for (std::size_t k = 0; k < indices.size(); ++k)
      combination[whitened_.origin(indices[k]).row] =
          unit[static_cast<Eigen::Index>(k)] / whitened_.norm(indices[k]);
    combination.normalize();
    const double asked = combination.dot(rows.F());
    Eigen::Index largest = 0;
    combination.cwiseAbs().maxCoeff(&largest);
    const bool asks = std::abs(asked) > 1e-9 * rows.F().norm();
    if (asks ? asked < 0 : combination[largest] < 0) combination = -combination;
    return combination;
  }

  // Level by level: of what is left of the direction there, each task takes what its rows, projected likewise, span.
  std::vector<Taker> takersOf(const VectorXd& direction, int level) const {
    std::vector<Taker> takers;
    for (int i = 0; i < level; ++i) {
      const VectorXd here = left(above_[i], direction);
      const double taken = here.squaredNorm() - left(above_[i + 1], direction).squaredNorm();
      double sum = 0;
      const std::size_t first = takers.size();
      for (int t = 0; t < taskCount(i); ++t) {
        const MatrixXd rows = left(above_[i], columns(heldColumnsOf(i, t)));
        const double share = (span(rows).basis.transpose() * here).squaredNorm();
        if (share > 0) takers.push_back({i, t, share});
        sum += share;
      }
      // Rows of several tasks can span together what none of them does alone.
      for (std::size_t k = first; k < takers.size(); ++k)
        takers[k].share = std::min(1.0, takers[k].share * std::max(1.0, taken / sum));
    }
    std::erase_if(takers, [&](const Taker& taker) { return taker.share < options_.least_share; });
    std::stable_sort(takers.begin(), takers.end(),
                     [](const Taker& a, const Taker& b) { return a.share > b.share + same_share; });
    return takers;
  }

  /// Looks for the cascade whose sum of projected task torques is the tick's torque: that is how it came about.
  void lookAtCascade(Xray& xray) const {
    MatrixXd own(problem_.dof, static_cast<Eigen::Index>(xray.tasks.size()));
    for (std::size_t k = 0; k < xray.tasks.size(); ++k)
      own.col(static_cast<Eigen::Index>(k)) =
          whitened_.massFactor().triangularView<Eigen::Lower>().solve(xray.tasks[k].torque);
    for (const bool one_pass : {false, true})
      for (const bool successive : {false, true}) {
        const MatrixXd parts = successive ? successiveParts(xray, own, one_pass) : augmentedParts(xray, own, one_pass);
        if ((solution_.scale * parts.rowwise().sum() - y_).norm() > same_torque * y_.norm()) continue;
        for (std::size_t k = 0; k < xray.tasks.size(); ++k)
          xray.tasks[k].torque_left = whitened_.massFactor().triangularView<Eigen::Lower>() *
                                      (solution_.scale * parts.col(static_cast<Eigen::Index>(k)));
        return;
      }
  }

  /// Each level's torque is projected alone onto the rows of all levels above.
  MatrixXd augmentedParts(const Xray& xray, MatrixXd parts, bool one_pass) const {
    for (int i = 0; i < levelCount(); ++i) {
      const MatrixXd held = heldAgainst(whitened_.ownTorque(i), 0, i, one_pass);
      for (std::size_t k = 0; k < xray.tasks.size(); ++k)
        if (xray.tasks[k].level == i) project(held, parts, k);
    }
    return parts;
  }

  /// From the lowest level up, all that is below is projected onto each level's rows.
  MatrixXd successiveParts(const Xray& xray, MatrixXd parts, bool one_pass) const {
    for (int i = levelCount() - 2; i >= 0; --i) {
      VectorXd below = VectorXd::Zero(problem_.dof);
      for (std::size_t k = 0; k < xray.tasks.size(); ++k)
        if (xray.tasks[k].level > i) below += parts.col(static_cast<Eigen::Index>(k));
      const MatrixXd held = heldAgainst(below, i, i + 1, one_pass);
      for (std::size_t k = 0; k < xray.tasks.size(); ++k)
        if (xray.tasks[k].level > i) project(held, parts, k);
    }
    return parts;
  }

  static void project(const MatrixXd& held, MatrixXd& parts, std::size_t k) {
    auto part = parts.col(static_cast<Eigen::Index>(k));
    part -= held * (held.transpose() * part).eval();
  }

  /// An orthonormal basis of what the projection of `torque` onto the rows of levels from `begin` to before `end` takes
  /// from it: their equality rows, and their inequality rows that it would break.
  MatrixXd heldAgainst(const VectorXd& torque, int begin, int end, bool one_pass) const {
    const int first = whitened_.firstInequality();
    const auto within = [&](const ActiveRow& at) { return at.level >= begin && at.level < end; };
    const MatrixXd basis =
        span(columns(columnsWhere([&](const ActiveRow& at, int j) { return within(at) && j < first; }))).basis;
    RowMajorMatrix rows(problem_.dof, whitened_.rowCount());
    int count = 0;
    for (const int j : columnsWhere([&](const ActiveRow& at, int j) { return within(at) && j >= first; })) {
      VectorXd row = whitened_.row(j);
      if (one_pass && row.dot(torque) <= 0) continue;
      row -= basis * (basis.transpose() * row);
      if (row.norm() > options_.rank.rank_tolerance) rows.col(count++) = row.normalized();
    }
    if (count == 0) return basis;
    MatrixXd held = rows.leftCols(count);
    if (!one_pass) {
      LeastDistance nearest(problem_.dof, count);
      const VectorXd free = torque - basis * (basis.transpose() * torque);
      const auto outcome = nearest.solve(rows.leftCols(count), VectorXd::Zero(count), free);
      if (outcome != LeastDistance::Outcome::solved) return basis;
      held.resize(problem_.dof, nearest.activeCount());
      for (int k = 0; k < nearest.activeCount(); ++k) held.col(k) = rows.col(nearest.active(k));
    }
    const MatrixXd more = span(held).basis;
    MatrixXd all(problem_.dof, basis.cols() + more.cols());
    all << basis, more;
    return all;
  }

  const TickProblem& problem_;
  const TickSolution& solution_;
  const XrayOptions& options_;
  WhitenedProblem whitened_;
  mutable std::vector<PriorityFactor> above_;                      // by level; a factor uses its own memory as it works
  VectorXd y_;                                                     // L⁻¹ τ
};

}  // namespace

std::vector<LimitHit> limitsHit(const TickProblem& problem, const VectorXd& torque) {
  std::vector<LimitHit> hits;
  if (!problem.torque_limits) return hits;
  const TorqueLimits& limits = *problem.torque_limits;
  for (int i = 0; i < problem.dof; ++i) {
    const double range = limits.upper[i] - limits.lower[i];
    const double tolerance = at_limit * (std::isfinite(range) ? range : 1);
    if (torque[i] >= limits.upper[i] - tolerance)
      hits.push_back({i, true, limits.upper[i]});
    else if (torque[i] <= limits.lower[i] + tolerance)
      hits.push_back({i, false, limits.lower[i]});
  }
  return hits;
}

std::vector<TaskError> taskErrors(const TickProblem& problem, const VectorXd& torque) {
  std::vector<TaskError> errors;
  const Eigen::LLT<MatrixXd> mass(problem.mass_matrix);
  const VectorXd acceleration = mass.solve(torque);
  for (std::size_t i = 0; i < problem.levels.size(); ++i) {
    const TickLevel& level = problem.levels[i];
    if (level.tasks.empty()) continue;
    const VectorXd own = mass.solve(ownTorque(level));
    for (std::size_t k = 0; k < level.tasks.size(); ++k) {
      if (level.tasks[k].rows == 0) continue;
      errors.push_back(taskError(level.tasks[k], acceleration, own));
      errors.back().level = static_cast<int>(i);
      errors.back().task = static_cast<int>(k);
    }
  }
  return errors;
}

Xray xray(const TickProblem& problem, const TickSolution& solution, const XrayOptions& options) {
  return Machine(problem, solution, options).look();
}

}  // namespace tactus::control
