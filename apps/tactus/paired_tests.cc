#include "apps/tactus/paired_tests.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "apps/tactus/sample.h"

namespace tactus::app {
namespace {

constexpr double alpha = 0.05;                                     // of the confidence interval

/// The continued fraction of the incomplete beta function by Lentz's method (Abramowitz & Stegun 26.5.8).
double betaFraction(double a, double b, double x) {
  constexpr double tiny = 1e-300, accuracy = 1e-16;
  const auto kept = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1, d = 1 / kept(1 - (a + b) * x / (a + 1)), fraction = d;
  for (int m = 1; m < 100000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / kept(1 + even * d);
    c = kept(1 + even / c);
    fraction *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / kept(1 + odd * d);
    c = kept(1 + odd / c);
    fraction *= d * c;
    if (std::abs(d * c - 1) < accuracy) break;
  }
  return fraction;
}

/// I_x(a, b), where y = 1 − x is given too, so that neither loses digits.
double incompleteBeta(double a, double b, double x, double y) {
  if (x <= 0) return 0;
  if (y <= 0) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log(y));
  if (x < (a + 1) / (a + b + 2)) return front * betaFraction(a, b, x) / a;
  return 1 - front * betaFraction(b, a, y) / b;
}

/// The t that |T| passes with probability p: by bisection, to the last bit.
double studentQuantile(double p, double degrees) {
  double lower = 0, upper = 1;
  while (studentTwoSided(upper, degrees) > p) upper *= 2;
  for (;;) {
    const double middle = lower + (upper - lower) / 2;
    if (middle == lower || middle == upper) return middle;
    (studentTwoSided(middle, degrees) > p ? lower : upper) = middle;
  }
}

/// Twice the ranks of rising sizes, whole numbers even where equal sizes share theirs.
std::vector<long> doubledRanks(const std::vector<double>& rising) {
  std::vector<long> ranks;
  for (size_t from = 0; from < rising.size();) {
    size_t to = from;
    while (to < rising.size() && rising[to] == rising[from]) ++to;
    ranks.insert(ranks.end(), to - from, static_cast<long>(from + 1 + to));
    from = to;
  }
  return ranks;
}

/// P(W ≤ w) and P(W ≥ w) of all signs; the counts are whole numbers below 2⁵³.
double exactTwoSided(const std::vector<long>& ranks, long w) {
  std::vector<double> ways{1};
  for (const long rank : ranks) {
    std::vector<double> next(ways.size() + static_cast<size_t>(rank), 0);
    for (size_t sum = 0; sum < ways.size(); ++sum) {
      next[sum] += ways[sum];
      next[sum + static_cast<size_t>(rank)] += ways[sum];
    }
    ways = std::move(next);
  }
  const auto at = ways.begin() + w;
  const double below = std::accumulate(ways.begin(), at + 1, 0.0), above = std::accumulate(at, ways.end(), 0.0);
  return std::min(1.0, 2 * std::min(below, above) / std::exp2(static_cast<double>(ranks.size())));
}

/// Variance of W⁺ is Σ r²/4, which is what the usual correction for ties amounts to.
double normalTwoSided(const std::vector<long>& ranks, double w) {
  double mean = 0, variance = 0;
  for (const long doubled : ranks) {
    const double rank = static_cast<double>(doubled) / 2;
    mean += rank / 2;
    variance += rank * rank / 4;
  }
  const double z = std::max(0.0, std::abs(w - mean) - 0.5) / std::sqrt(variance);
  return std::erfc(z / std::sqrt(2.0));
}

}  // namespace

double studentTwoSided(double t, double degrees) {
  const double square = t * t, all = degrees + square;
  return incompleteBeta(degrees / 2, 0.5, degrees / all, square / all);
}

StudentTest studentTest(const std::vector<double>& differences) {
  const SampleFigures figures = figuresOf(differences);
  if (figures.n < 2 || figures.minimum == figures.maximum) return {NAN, NAN, NAN, NAN, NAN, NAN};
  StudentTest test;
  const double error = figures.sd / std::sqrt(static_cast<double>(figures.n));
  test.t = figures.mean / error;
  test.degrees = static_cast<double>(figures.n - 1);
  test.p = studentTwoSided(test.t, test.degrees);
  test.effect = figures.mean / figures.sd;
  const double reach = studentQuantile(alpha, test.degrees) * error;
  test.lower = figures.mean - reach;
  test.upper = figures.mean + reach;
  return test;
}

WilcoxonTest wilcoxonTest(const std::vector<double>& differences) {
  constexpr long most_exact = 50;
  std::vector<double> nonzero;
  for (const double difference : differences)
    if (difference != 0) nonzero.push_back(difference);
  std::sort(nonzero.begin(), nonzero.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  std::vector<double> sizes;
  for (const double difference : nonzero) sizes.push_back(std::abs(difference));
  const std::vector<long> ranks = doubledRanks(sizes);
  long doubled = 0;
  for (size_t i = 0; i < ranks.size(); ++i)
    if (nonzero[i] > 0) doubled += ranks[i];
  WilcoxonTest test;
  test.n = static_cast<long>(ranks.size());
  test.positive = static_cast<double>(doubled) / 2;
  test.exact = test.n <= most_exact;
  test.p = test.n == 0 ? NAN : test.exact ? exactTwoSided(ranks, doubled) : normalTwoSided(ranks, test.positive);
  return test;
}

std::vector<double> holm(const std::vector<double>& p) {
  std::vector<size_t> order;
  for (size_t i = 0; i < p.size(); ++i)
    if (!std::isnan(p[i])) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return p[a] != p[b] ? p[a] < p[b] : a < b; });
  std::vector<double> corrected(p.size(), NAN);
  double largest = 0;
  for (size_t rank = 0; rank < order.size(); ++rank) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - rank) * p[order[rank]]));
    corrected[order[rank]] = largest;
  }
  return corrected;
}

}  // namespace tactus::app
