#pragma once

#include <gtest/gtest.h>

#include <iostream>

#include "framework/control/tick_problem.h"

namespace tactus::test {

/// How wide the random problems of a law were: so that no change of a generator or a filter thins a law out unseen.
class MetShapes {
 public:
  void add(const control::TickProblem& problem) {
    int rows = 0;
    for (const control::TickLevel& level : problem.levels)
      for (const control::TickTask& task : level.tasks)
        if (task.contact) rows += task.rows;
    ++problems_;
    crowded_ += rows >= 15;
    most_contact_rows_ = std::max(most_contact_rows_, rows);
    most_levels_ = std::max(most_levels_, static_cast<int>(problem.levels.size()));
    deep_ += problem.levels.size() >= 5;
    small_ += problem.dof <= 15;
    large_ += problem.dof >= 40;
  }

  /// A share of the problems has 15 to 20 contact rows, 9 to 15 joints, 40 to 50, and, where the law has no depth of
  /// its own, 5 or 6 levels.
  void expectWide(double crowded_share = 0.2, int levels = 6) const {
    std::cout << "of " << problems_ << " problems " << crowded_ << " with 15 to " << most_contact_rows_
              << " contact rows, " << deep_ << " with 5 or 6 levels, " << small_ << " with up to 15 joints, " << large_
              << " with 40 to 50\n";
    EXPECT_GE(crowded_, crowded_share * problems_);
    EXPECT_EQ(most_contact_rows_, 20);
    EXPECT_EQ(most_levels_, levels);
    if (levels == 6) {
      EXPECT_GE(deep_, 0.2 * problems_);
    }
    EXPECT_GE(small_, 0.08 * problems_);
    EXPECT_GE(large_, 0.15 * problems_);
  }

 private:
  int problems_ = 0, crowded_ = 0, most_contact_rows_ = 0, most_levels_ = 0, deep_ = 0, small_ = 0, large_ = 0;
};

}  // namespace tactus::test
