#include "framework/dynamics/sine_cosine.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace tactus::dynamics {
namespace {

using Pair = double __attribute__((vector_size(16)));
using Bits = std::int64_t __attribute__((vector_size(16)));

constexpr double reducible = 1e5;                                  // rad
constexpr double quarters_per_radian = 0x1.45f306dc9c883p-1;       // 2/π
// π/2 in three parts; the first two have so few bits that their products with the number of quarters are exact.
constexpr double quarter_1 = 0x1.921fb544p+0;
constexpr double quarter_2 = 0x1.0b4611a6p-34;
constexpr double quarter_3 = 0x1.3198a2e037073p-69;
// Adding it rounds to an integer, which then stands in the lowest bits.
constexpr double rounding = 0x1.8p52;

Pair all(double value) { return Pair{value, value}; }

/// Of x in [−π/4, π/4].
Pair sine(Pair x) {
  const Pair z = x * x;
  Pair series = all(1.58962301576546568060e-10);
  series = series * z + -2.50507477628578072866e-8;
  series = series * z + 2.75573136213857245213e-6;
  series = series * z + -1.98412698295895385996e-4;
  series = series * z + 8.33333333332211858878e-3;
  series = series * z + -1.66666666666666307295e-1;
  return x + x * z * series;
}

Pair cosine(Pair x) {
  const Pair z = x * x;
  Pair series = all(-1.13585365213876817300e-11);
  series = series * z + 2.08757008419747316778e-9;
  series = series * z + -2.75573141792967388112e-7;
  series = series * z + 2.48015872888517045348e-5;
  series = series * z + -1.38888888888730564116e-3;
  series = series * z + 4.16666666666665929218e-2;
  return 1 - 0.5 * z + z * z * series;
}

Pair choose(Bits mask, Pair yes, Pair no) {
  return (Pair)(((Bits)yes & mask) | ((Bits)no & ~mask));
}

}  // namespace

void sinesAndCosines(const double* angles, int count, double* sines, double* cosines) {
  for (int i = 0; i < count; i += 2) {
    Pair angle;
    std::memcpy(&angle, angles + i, sizeof angle);
    const Pair shifted = angle * quarters_per_radian + rounding;
    const Pair quarters = shifted - rounding;
    const Pair x = ((angle - quarters * quarter_1) - quarters * quarter_2) - quarters * quarter_3;
    const Pair s = sine(x), c = cosine(x);
    // Quarter by quarter (s, c), (c, −s), (−s, −c), (−c, s).
    const Bits quarter = (Bits)shifted;
    const Bits swap = -(quarter & 1);
    const Bits sine_sign = (quarter & 2) << 62, cosine_sign = ((quarter + 1) & 2) << 62;
    const Pair sine_pair = (Pair)((Bits)choose(swap, c, s) ^ sine_sign);
    const Pair cosine_pair = (Pair)((Bits)choose(swap, s, c) ^ cosine_sign);
    std::memcpy(sines + i, &sine_pair, sizeof sine_pair);
    std::memcpy(cosines + i, &cosine_pair, sizeof cosine_pair);
    for (int k = i; k < i + 2; ++k) {
      if (std::abs(angles[k]) <= reducible) continue;
      sines[k] = std::sin(angles[k]);
      cosines[k] = std::cos(angles[k]);
    }
  }
}

}  // namespace tactus::dynamics
