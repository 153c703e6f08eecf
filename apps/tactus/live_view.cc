#include "apps/tactus/live_view.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/tactus/text.h"

namespace tactus::app {
namespace {

constexpr std::chrono::milliseconds on_terminal{200};
constexpr std::chrono::seconds in_log{30};
constexpr size_t widest = 100;                                     // characters; bars need no more
constexpr size_t name_width = 26, number_width = 9;

/// With leading blanks, or cut to that many characters.
std::string toTheRight(const std::string& text, size_t characters) {
  const size_t length = width(text);
  return length < characters ? std::string(characters - length, ' ') + text : text;
}

/// The first characters of a text, with an ellipsis where there were more; trailing blanks where there are fewer.
std::string fitted(const std::string& text, size_t characters) {
  if (width(text) <= characters) return text + std::string(characters - width(text), ' ');
  std::string cut;
  size_t count = 0;
  for (const char byte : text) {
    const bool begins = (static_cast<unsigned char>(byte) & 0xC0) != 0x80;
    if (begins && ++count >= characters) break;
    cut += byte;
  }
  return cut + "…";
}

/// A bar of up to `characters`, in eighths of one.
std::string bar(double fraction, size_t characters) {
  static const char* const eighths[] = {"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const double eighths_in_all = 8 * static_cast<double>(characters);
  const auto units = static_cast<size_t>(std::lround(eighths_in_all * std::clamp(fraction, 0.0, 1.0)));
  std::string text;
  for (size_t i = 0; i < units / 8; ++i) text += "█";
  return text + eighths[units % 8];
}

/// 1, 2 or 5 times a power of ten, not below the value nor below 0.1.
double scaleFor(double largest) {
  double power = 0.1;
  for (;; power *= 10)
    for (const double factor : {1.0, 2.0, 5.0})
      if (factor * power >= largest || power > 1e12) return factor * power;
}

std::string fixed(double value, int decimals) {
  if (!(std::abs(value) < 1e6)) return rounded(value, 3);
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string newtons(double force_N) { return fixed(force_N, force_N < 100 ? 2 : 1); }

}  // namespace

std::string liveProgress(const LiveState& state) {
  std::string text = fixed(state.time, 1) + " of " + fixed(state.duration, 1) + " s";
  if (!(state.rate > 0)) return text;
  return text + ", " + fixed(state.rate, 1) + " × real time, " +
         clockText(std::max(0.0, state.duration - state.time) / state.rate) + " left";
}

std::string liveForces(const LiveState& state) {
  return counted(static_cast<size_t>(state.now.links), "link", "links") + ", mean " + newtons(state.now.mean_N) +
         ", largest " + newtons(state.now.max_N) + ", undesired " + newtons(state.now.undesired_max_N) + " N";
}

std::vector<std::string> liveTable(const LiveState& state, size_t width, size_t height) {
  std::vector<std::string> lines{liveProgress(state), liveForces(state)};
  double largest = 0;
  for (const LiveLink& link : state.links) largest = std::max(largest, link.largest_N);
  const double scale = scaleFor(largest);
  const size_t numbers = name_width + 3 * number_width + 2;
  const size_t bar_width = width > numbers ? width - numbers : 0;
  const auto row = [&](const std::string& name, const std::vector<std::string>& cells, const std::string& last) {
    std::string line = fitted(name, name_width);
    for (const std::string& cell : cells) line += toTheRight(cell, number_width);
    lines.push_back(line + "  " + last);
  };
  // Where the rows do not fit, one of them says how many are missing.
  const size_t room = height > 3 ? height - 3 : 0;
  const size_t shown = state.links.size() <= room ? state.links.size() : room > 0 ? room - 1 : 0;
  if (shown > 0) {
    const std::string end = rounded(scale, 3) + " N";
    row("link (! undesired)", {"now (N)", "mean", "largest"},
        bar_width > end.size() + 2 ? "0" + toTheRight(end, bar_width - 1) : "");
  }
  for (size_t i = 0; i < shown; ++i) {
    const LiveLink& link = state.links[i];
    row((link.desired ? "" : "! ") + link.name,
        {link.force_N > 0 ? newtons(link.force_N) : "–", newtons(link.mean_N), newtons(link.largest_N)},
        bar(link.force_N / scale, bar_width));
  }
  if (shown > 0 && shown < state.links.size())
    lines.push_back("and " + std::to_string(state.links.size() - shown) + " more");
  if (lines.size() > height) lines.resize(height);
  for (std::string& line : lines) {
    if (app::width(line) > width) line = fitted(line, width);
    line.erase(line.find_last_not_of(' ') + 1);
  }
  return lines;
}

LiveView::LiveView(const description::Robot& robot, const runtime::ContactMetrics& contacts, double from,
                   double duration)
    : robot_(robot),
      contacts_(contacts),
      from_(from),
      duration_(duration),
      terminal_(::isatty(STDERR_FILENO) == 1),
      touches_(robot.links.size()),
      start_(Clock::now()),
      shown_(start_) {}

LiveView::~LiveView() {
  if (lines_ > 0) std::fprintf(stderr, "\r\033[%zuA\033[J", lines_);
}

void LiveView::observe(const control::ObservedTick& tick) {
  for (Touch& touch : touches_) touch.force_N = 0;
  for (const control::ContactRecord& contact : tick.truth.contacts)
    if (!contact.isOfSelf()) touches_[static_cast<size_t>(contact.link)].force_N += contact.force_N;
  for (Touch& touch : touches_) {
    if (!(touch.force_N > 0)) continue;
    ++touch.ticks;
    touch.sum_N += touch.force_N;
    touch.largest_N = std::max(touch.largest_N, touch.force_N);
  }

  const auto now = Clock::now();
  const double time = tick.truth.time;
  if (terminal_) {
    if (now - shown_ < on_terminal) return;
    shown_ = now;
    return redraw(state(time, now));
  }
  // The last tick comes a period before the end.
  const double share = (time + tick.controller.period() - from_) / (duration_ - from_);
  const int tenths = static_cast<int>(10 * share + 1e-9);
  if (tenths <= tenths_ && now - shown_ < in_log) return;
  tenths_ = std::max(tenths_, tenths);
  shown_ = now;
  const LiveState state = this->state(time + tick.controller.period(), now);
  std::fprintf(stderr, "tactus run: %s: %s\n", liveProgress(state).c_str(), liveForces(state).c_str());
}

LiveState LiveView::state(double time, Clock::time_point now) const {
  LiveState state;
  state.time = time;
  state.duration = duration_;
  const double wall = std::chrono::duration<double>(now - start_).count();
  state.rate = wall > 0 ? (time - from_) / wall : 0;
  state.now = contacts_.now();
  for (size_t link = 0; link < touches_.size(); ++link) {
    const Touch& touch = touches_[link];
    if (touch.ticks > 0)
      state.links.push_back({robot_.links[link].name, contacts_.isDesired(static_cast<int>(link)), touch.force_N,
                             touch.sum_N / static_cast<double>(touch.ticks), touch.largest_N});
  }
  return state;
}

void LiveView::redraw(const LiveState& state) {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0;
  const size_t width = known ? size.ws_col : 80, height = known ? size.ws_row : 24;
  // The last column and the last line stay free, so that nothing wraps or scrolls.
  const std::vector<std::string> lines = liveTable(state, std::min(widest, width - 1), height - 1);
  std::string text = "\r";
  if (lines_ > 0) text += "\033[" + std::to_string(std::min(lines_, height - 1)) + "A";
  for (const std::string& line : lines) text += line + "\033[K\n";
  lines_ = lines.size();
  std::fputs((text + "\033[J").c_str(), stderr);
}

}  // namespace tactus::app
