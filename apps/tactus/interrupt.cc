#include "apps/tactus/interrupt.h"

#include <csignal>

namespace tactus::app {
namespace {

// A signal handler can reach nothing but a static; it is written by the handler alone and read through stop().
std::atomic<bool> raised{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void raise(int signal) {
  raised.store(true, std::memory_order_relaxed);
  std::signal(signal, SIG_DFL);
}

}  // namespace

Interrupt::Interrupt() {
  raised = false;
  std::signal(SIGINT, raise);
  std::signal(SIGTERM, raise);
}

Interrupt::~Interrupt() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

const std::atomic<bool>& Interrupt::stop() const { return raised; }

}  // namespace tactus::app
