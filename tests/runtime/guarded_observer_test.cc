// A recorder of a plugin that throws is named; it ends the run or falls silent, as the stack says.

#include "framework/runtime/guarded_observer.h"

#include <gtest/gtest.h>

#include "framework/runtime/file_error.h"
#include "framework/runtime/loop.h"
#include "tests/runtime/pendulum.h"

namespace tactus::runtime {
namespace {

struct Seen {
  int ticks = 0;
  bool closed = false;
};

class Pencil final : public control::Observer {
 public:
  Pencil(Seen& seen, int breaks_at, bool disk) : seen_(seen), breaks_at_(breaks_at), disk_(disk) {}
  void observe(const control::ObservedTick&) override {
    if (++seen_.ticks != breaks_at_) return;
    if (disk_) throw FileError("/full", "no space left");
    throw std::runtime_error("the pencil broke");
  }
  void close() override { seen_.closed = true; }

 private:
  Seen& seen_;
  int breaks_at_;
  bool disk_;
};

LoopResult run(Seen& seen, int breaks_at, bool switch_off, bool disk = false, std::string* fault = nullptr) {
  GuardedObserver guarded("pencil", std::make_unique<Pencil>(seen, breaks_at, disk), switch_off);
  tactus::testing::PendulumPlant plant;
  const std::atomic<bool> stop{false};
  LoopResult result = runLoop(plant, *tactus::testing::pendulumController(0.5), 0.01, {&guarded}, stop);
  guarded.close();
  if (fault) *fault = guarded.fault();
  return result;
}

TEST(GuardedObserver, LetsAGoodOneWork) {
  Seen seen;
  EXPECT_EQ(run(seen, 0, false).ending, Ending::done);
  EXPECT_EQ(seen.ticks, 10);
  EXPECT_TRUE(seen.closed);
}

TEST(GuardedObserver, EndsTheRunWithItsName) {
  Seen seen;
  const LoopResult result = run(seen, 4, false);
  EXPECT_EQ(result.ending, Ending::part_error);
  EXPECT_EQ(result.message, "recorder 'pencil' failed at t = 0.003 s: the pencil broke");
  EXPECT_EQ(result.ticks, 3);
  EXPECT_FALSE(seen.closed) << "what threw is left alone";
}

TEST(GuardedObserver, FallsSilentWhereTheStackSaysSo) {
  Seen seen;
  std::string fault;
  EXPECT_EQ(run(seen, 4, true, false, &fault).ending, Ending::done);
  EXPECT_EQ(seen.ticks, 4);
  EXPECT_EQ(fault, "recorder 'pencil' failed at t = 0.003 s: the pencil broke");
}

TEST(GuardedObserver, LetsAFullDiskBeOne) {
  Seen seen;
  EXPECT_EQ(run(seen, 4, true, true).ending, Ending::file_error);
}

}  // namespace
}  // namespace tactus::runtime
