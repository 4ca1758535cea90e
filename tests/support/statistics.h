#pragma once
// Statistics for tests: tail probabilities, the correction for many tests, and the chi-square test of a
// histogram. All in double precision; nothing here depends on the code under test.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace gatelight::testing {

/// Upper regularised incomplete gamma function Q(a, x): series for small x, continued fraction (modified
/// Lentz) otherwise. Abramowitz and Stegun 6.5.29 and 6.5.31.
inline double gamma_q(double a, double x) {
  if (!(x > 0.0)) return 1.0;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (double n = a + 1.0; term > sum * 1e-16; n += 1.0) sum += term *= x / n;
    return std::clamp(1.0 - sum * scale, 0.0, 1.0);
  }
  constexpr double kTiny = 1e-300;
  double b = x + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double h = d;
  for (int i = 1; i < 100000; ++i) {
    const double numerator = -i * (i - a);
    b += 2.0;
    d = numerator * d + b;
    d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
    c = b + numerator / c;
    if (std::abs(c) < kTiny) c = kTiny;
    h *= d * c;
    if (std::abs(d * c - 1.0) < 1e-15) break;
  }
  return std::clamp(scale * h, 0.0, 1.0);
}

/// Probability that a chi-square variable exceeds `value`.
inline double chi_square_tail(double value, double degrees_of_freedom) {
  return gamma_q(0.5 * degrees_of_freedom, 0.5 * value);
}

/// Probability that |Z| of a standard normal variable exceeds |z|.
inline double normal_two_sided(double z) {
  return std::erfc(std::abs(z) / std::sqrt(2.0));
}

/// Regularised incomplete beta function I_x(a, b): continued fraction 26.5.8 of Abramowitz and Stegun.
inline double beta_i(double a, double b, double x) {
  if (!(x > 0.0)) return 0.0;
  if (x >= 1.0) return 1.0;
  if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - beta_i(b, a, 1.0 - x);
  constexpr double kTiny = 1e-300;
  const auto guarded = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
  double c = 1.0;
  double d = 1.0 / guarded(1.0 - (a + b) * x / (a + 1.0));
  double h = d;
  for (int m = 1; m < 100000; ++m) {
    const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    d = 1.0 / guarded(1.0 + even * d);
    c = guarded(1.0 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    d = 1.0 / guarded(1.0 + odd * d);
    c = guarded(1.0 + odd / c);
    h *= d * c;
    if (std::abs(d * c - 1.0) < 1e-15) break;
  }
  const double front =
      std::exp(a * std::log(x) + b * std::log1p(-x) + std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b));
  return std::clamp(front * h / a, 0.0, 1.0);
}

/// Probability that |T| of Student's distribution exceeds |t|.
inline double student_two_sided(double t, double degrees_of_freedom) {
  return beta_i(0.5 * degrees_of_freedom, 0.5, degrees_of_freedom / (degrees_of_freedom + t * t));
}

/// Significance of all comparisons of a test together, for sidak().
inline constexpr double kFamilySignificance = 1e-5;

/// The significance each of `tests` independent tests must use for the family to have `family` (Sidak 1967).
inline double sidak(double family, std::size_t tests) {
  return -std::expm1(std::log1p(-family) / static_cast<double>(tests));
}

/// Mean and variance in one pass (Welford).
class Moments {
 public:
  void add(double value) {
    ++count_;
    const double delta = value - mean_;
    mean_ += delta / static_cast<double>(count_);
    squares_ += delta * (value - mean_);
  }
  std::size_t count() const { return count_; }
  double mean() const { return mean_; }
  double variance() const { return count_ > 1 ? squares_ / static_cast<double>(count_ - 1) : 0.0; }
  double standard_error() const {
    return count_ > 0 ? std::sqrt(variance() / static_cast<double>(count_)) : 0.0;
  }

 private:
  std::size_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;
};

/// p-value that the samples in `moments` have the mean `expected`, two-sided. Samples without any variance
/// agree only if they are equal to `expected` within `rounding` (relative).
inline double mean_p_value(const Moments& moments, double expected, double rounding = 1e-6) {
  const double error = moments.standard_error();
  const double difference = std::abs(moments.mean() - expected);
  if (difference <= rounding * std::abs(expected)) return 1.0;
  if (!(error > 0.0)) return 0.0;
  return student_two_sided(difference / error, static_cast<double>(moments.count() - 1));
}

/// The relative error of something learned, measured over a number of seeds: its mean (the bias) and the
/// standard deviation of one seed.
struct MeasuredError {
  double bias = 0.0;
  double deviation = 0.0;
  int seeds = 0;
};

/// Tests values against the measured errors of other seeds, one by one and all together: by the prediction
/// interval of normal errors, which includes the uncertainty of the measurement. The seeds must differ.
class MeasuredErrors {
 public:
  /// p-value that `value` has the error of yet another seed, two-sided.
  double p_value(double value, double exact, const MeasuredError& error) {
    const double freedom = error.seeds - 1.0;
    const double deviation = error.deviation * std::sqrt(1.0 + 1.0 / error.seeds);
    const double score = (value / exact - 1.0 - error.bias) / deviation;
    sum_ += score;
    variance_ += freedom / (freedom - 2.0);
    return student_two_sided(score, freedom);
  }
  /// The same of all values: a small error of the same sign in each of them.
  double common_p_value() const { return normal_two_sided(sum_ / std::sqrt(variance_)); }

 private:
  double sum_ = 0.0;
  double variance_ = 0.0;
};

struct ChiSquareResult {
  double p_value = 0.0;
  double statistic = 0.0;
  double degrees_of_freedom = 0.0;
};

/// Pearson's test of counts against expected counts. Cells with a low expectation are pooled until it reaches
/// `minimum_expected`. The expectations must sum up to the number of samples (cells for "no sample"
/// included); a sample in a cell where nothing can fall gives p = 0.
inline ChiSquareResult chi_square_test(std::span<const double> observed, std::span<const double> expected,
                                       double minimum_expected = 5.0) {
  std::vector<std::pair<double, double>> cells;  // expected, observed
  cells.reserve(expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!(expected[i] > 0.0)) {
      if (observed[i] > 0.0 || std::isnan(expected[i]))
        return {0.0, std::numeric_limits<double>::infinity(), 0.0};
      continue;
    }
    cells.emplace_back(expected[i], observed[i]);
  }
  std::sort(cells.begin(), cells.end());
  ChiSquareResult result;
  double pooled_expected = 0.0;
  double pooled_observed = 0.0;
  std::size_t used = 0;
  const auto close = [&] {
    const double difference = pooled_observed - pooled_expected;
    result.statistic += difference * difference / pooled_expected;
    ++used;
    pooled_expected = pooled_observed = 0.0;
  };
  double remaining = 0.0;
  for (const auto& cell : cells) remaining += cell.first;
  for (const auto& [cell_expected, cell_observed] : cells) {
    pooled_expected += cell_expected;
    pooled_observed += cell_observed;
    remaining -= cell_expected;
    // The cells that are left must be able to fill one of their own; otherwise they join this one.
    if (pooled_expected >= minimum_expected && remaining >= minimum_expected) close();
  }
  if (pooled_expected > 0.0) close();
  if (used < 2) {
    // One cell holds everything, so its count is the number of samples: nothing is left to test.
    result.p_value = result.statistic < 1e-6 ? 1.0 : 0.0;
    return result;
  }
  result.degrees_of_freedom = static_cast<double>(used - 1);
  result.p_value = chi_square_tail(result.statistic, result.degrees_of_freedom);
  return result;
}

/// For EXPECT_TRUE: reports the statistic when the hypothesis is rejected.
inline ::testing::AssertionResult accepts(const ChiSquareResult& result, double significance) {
  if (result.p_value >= significance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << "chi-square " << result.statistic << " with " << result.degrees_of_freedom
         << " degrees of freedom: p " << result.p_value << " is below " << significance;
}

/// Composite Gauss-Legendre quadrature with 4 nodes per interval of f over [a, b].
template <class F>
double integrate(F&& f, double a, double b, int intervals = 1) {
  constexpr double kNodes[2] = {0.3399810435848563, 0.8611363115940526};
  constexpr double kWeights[2] = {0.6521451548625461, 0.3478548451374538};
  const double half = 0.5 * (b - a) / intervals;
  double sum = 0.0;
  for (int i = 0; i < intervals; ++i) {
    const double middle = a + (2 * i + 1) * half;
    for (int k = 0; k < 2; ++k) {
      sum += kWeights[k] * (f(middle - kNodes[k] * half) + f(middle + kNodes[k] * half));
    }
  }
  return sum * half;
}

/// A small generator for tests (Steele, Lea and Flood's SplitMix64), independent of the renderer's samplers.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  float uniform_float() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  std::uint64_t state_;
};

}  // namespace gatelight::testing
