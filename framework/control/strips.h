#pragma once

#include <Eigen/Core>
#include <type_traits>

namespace tactus::control {

/// `width` neighbouring numbers of a row, in registers.
template <int width>
using Strip = Eigen::Array<double, width, 1>;

/// Cuts `count` columns of a row-major matrix into strips whose widths the compiler knows, 16 and then what is left in
/// powers of two: calls f(std::integral_constant<int, width>, first column).
template <typename F>
void forEachStrip(int count, const F& f) {
  int first = 0;
  for (; first + 16 <= count; first += 16) f(std::integral_constant<int, 16>(), first);
  const auto rest = [&](auto width) {
    if ((count & width) == 0) return;
    f(width, first);
    first += width;
  };
  rest(std::integral_constant<int, 8>());
  rest(std::integral_constant<int, 4>());
  rest(std::integral_constant<int, 2>());
  rest(std::integral_constant<int, 1>());
}

}  // namespace tactus::control
