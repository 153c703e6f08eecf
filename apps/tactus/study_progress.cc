#include "apps/tactus/study_progress.h"

#include <unistd.h>

#include <cstdio>

#include "apps/tactus/text.h"

namespace tactus::app {
namespace {

constexpr std::chrono::milliseconds on_terminal{200};
constexpr std::chrono::seconds in_log{30};

}  // namespace

std::string progressText(const StudyState& state, double elapsed_s) {
  std::string text = std::to_string(state.finished) + " of " + std::to_string(state.all) + " trials";
  if (state.failed > 0) text += ", " + std::to_string(state.failed) + " failed";
  if (state.running > 0) text += ", " + std::to_string(state.running) + " running";
  if (state.finished_now > 0 && state.finished < state.all)
    text += ", " + clockText(elapsed_s / static_cast<double>(state.finished_now) *
                             static_cast<double>(state.all - state.finished)) + " left";
  return text;
}

StudyProgress::StudyProgress() : terminal_(::isatty(STDERR_FILENO) == 1), start_(Clock::now()), shown_(start_) {}

StudyProgress::~StudyProgress() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void StudyProgress::show(const StudyState& state) {
  const auto now = Clock::now();
  if (terminal_ ? now - shown_ < on_terminal : now - shown_ < in_log) return;
  shown_ = now;
  const std::string text = progressText(state, std::chrono::duration<double>(now - start_).count());
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "tactus study: %s\n", text.c_str());
}

}  // namespace tactus::app
