#include "tests/renderer/golden/golden_compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "tests/support/statistics.h"

namespace gatelight::testing {
namespace {

/// The blocks of pixels that are summed before the comparison. Single pixels show sharp differences, larger
/// blocks small ones.
struct Scale {
  const char* name;
  int side;  ///< pixels; 0: the whole picture
};
constexpr std::array<Scale, 4> kScales{
    {{"pixels", 1}, {"blocks of 4", 4}, {"blocks of 12", 12}, {"picture", 0}}};

/// Relative: instruction sets and compilers round differently, and stored numbers are floats.
constexpr double kRounding = 1e-5;

/// A sum of independent estimates with the variance of each, and what is needed for its degrees of freedom.
struct Sum {
  double value = 0.0;
  double variance = 0.0;
  double weighted = 0.0;  ///< sum of variance^2 / degrees of freedom

  void add(double v, double its_variance, double freedom) {
    value += v;
    variance += its_variance;
    weighted += its_variance * its_variance / freedom;
  }
};

/// Welch's test of two sums. The test's variance is estimated twice: from its own samples and from the
/// reference's. The greater counts. The first by itself is too small when rare bright samples are missing.
/// The second by itself takes a rare sample of the test, which the reference has met less often than it
/// should, for a difference.
class Score {
 public:
  void add(double test, double own_variance, double test_spp, double reference, double reference_variance,
           double reference_spp) {
    own_.add(test, own_variance, test_spp - 1.0);
    reference_.add(reference, reference_variance, reference_spp - 1.0);
    predicted_.add(test, reference_variance * reference_spp / test_spp, reference_spp - 1.0);
  }

  /// Standard normal score of the difference under the hypothesis; p is its two-sided p-value.
  struct Result {
    double score = 0.0;
    double p = 1.0;
  };
  Result result() const {
    const Sum& test = own_.variance >= predicted_.variance ? own_ : predicted_;
    const double rounding = kRounding * std::max(std::abs(own_.value), std::abs(reference_.value));
    const double difference = own_.value - reference_.value;
    if (std::abs(difference) <= rounding) return {};
    const double variance = test.variance + reference_.variance;
    const double t = difference / std::sqrt(variance + rounding * rounding);
    if (!std::isfinite(t)) return {t, 0.0};
    const double weighted = test.weighted + reference_.weighted;
    const double freedom = weighted > 0.0 ? variance * variance / weighted : 1e9;
    return {t, student_two_sided(t, freedom)};
  }

 private:
  Sum own_;
  Sum predicted_;
  Sum reference_;
};

/// The scores of one kind of test.
class Family {
 public:
  explicit Family(const char* name) : name_(name) {}

  void add(const Score::Result& r, std::size_t channel, int x, int y) {
    ++count_;
    squares_[channel] += r.score * r.score;
    if (r.p < smallest_ || count_ == 1) {
      smallest_ = r.p;
      std::ostringstream where;
      where << "x " << x << ", y " << y << ", "
            << "RGB"[channel] << ", score " << r.score;
      where_ = where.str();
    }
  }
  void judge(double significance, GoldenVerdict& verdict, std::ostream& report) const {
    const double limit = sidak(significance, count_);
    report << "  " << name_ << ": smallest p " << smallest_ << " at " << where_ << " (limit " << limit << ")";
    verdict.agrees &= note(smallest_, limit, report);
  }
  /// The sum of squared scores against chi-square; each channel for itself, because they are correlated. As
  /// the greater variance counts, the sum is smaller rather than greater.
  void judge_spread(double significance, GoldenVerdict& verdict, std::ostream& report) const {
    const double freedom = static_cast<double>(count_) / 3.0;
    const double greatest = *std::max_element(squares_.begin(), squares_.end());
    const double p = chi_square_tail(greatest, freedom);
    const double limit = sidak(significance, 3);
    report << "  spread of " << name_ << ": mean square " << greatest / freedom << ", p " << p << " (limit "
           << limit << ")";
    verdict.agrees &= note(p, limit, report);
  }

 private:
  /// NaN is a rejection.
  static bool note(double p, double limit, std::ostream& report) {
    const bool accepted = p >= limit;
    report << (accepted ? "\n" : " REJECTED\n");
    return accepted;
  }

  std::string name_;
  std::string where_;
  std::size_t count_ = 0;
  std::array<double, 3> squares_{};
  double smallest_ = 1.0;
};

const renderer::Layer& variance_of(const renderer::Picture& picture) {
  const renderer::Layer* layer = picture.find("variance");
  if (layer == nullptr) throw std::invalid_argument("a picture without a variance layer");
  return *layer;
}

}  // namespace

GoldenVerdict compare_with_reference(const Rendered& test, const Rendered& reference, double significance) {
  const int width = test.picture.width;
  const int height = test.picture.height;
  if (reference.picture.width != width || reference.picture.height != height) {
    throw std::invalid_argument("the pictures differ in size");
  }
  const std::vector<float>& values = test.picture.layers.at(0).values;
  const std::vector<float>& variances = variance_of(test.picture).values;
  const std::vector<float>& reference_values = reference.picture.layers.at(0).values;
  const std::vector<float>& reference_variances = variance_of(reference.picture).values;

  GoldenVerdict verdict;
  verdict.pixel_p_values.resize(values.size());
  const double each = sidak(significance, 2 * kScales.size());
  std::ostringstream report;
  report.precision(3);
  for (const Scale& scale : kScales) {
    const int side = scale.side > 0 ? scale.side : std::max(width, height);
    Family family(scale.name);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      for (int y0 = 0; y0 < height; y0 += side) {
        for (int x0 = 0; x0 < width; x0 += side) {
          Score score;
          std::size_t i = 0;
          for (int y = y0; y < std::min(y0 + side, height); ++y) {
            for (int x = x0; x < std::min(x0 + side, width); ++x) {
              i = static_cast<std::size_t>(3 * (y * width + x)) + channel;
              score.add(values[i], variances[i], test.spp, reference_values[i], reference_variances[i],
                        reference.spp);
            }
          }
          const Score::Result result = score.result();
          family.add(result, channel, x0, y0);
          if (side == 1) verdict.pixel_p_values[i] = static_cast<float>(result.p);
        }
      }
    }
    family.judge(each, verdict, report);
    family.judge_spread(each, verdict, report);
  }
  verdict.report = report.str();
  return verdict;
}

renderer::Picture p_value_picture(const GoldenVerdict& verdict, int width, int height) {
  renderer::Picture picture;
  picture.width = width;
  picture.height = height;
  picture.layers.push_back({"", {"R", "G", "B"}, verdict.pixel_p_values, true});
  return picture;
}

}  // namespace gatelight::testing
