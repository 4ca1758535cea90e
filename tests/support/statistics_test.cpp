#include "tests/support/statistics.h"

#include <gmock/gmock.h>

namespace gatelight::testing {
namespace {

TEST(StatisticsHelpers, TailsMatchTabulatedQuantiles) {
  // Quantiles as printed in any statistics handbook.
  EXPECT_NEAR(chi_square_tail(3.841459, 1), 0.05, 1e-7);
  EXPECT_NEAR(chi_square_tail(18.307038, 10), 0.05, 1e-7);
  EXPECT_NEAR(chi_square_tail(149.449253, 100), 0.001, 1e-8);
  EXPECT_NEAR(chi_square_tail(2.0 * 7.0, 2), std::exp(-7.0), 1e-12);
  EXPECT_NEAR(normal_two_sided(1.959964), 0.05, 1e-7);
  EXPECT_NEAR(student_two_sided(12.706205, 1), 0.05, 1e-8);
  EXPECT_NEAR(student_two_sided(2.228139, 10), 0.05, 1e-7);
  EXPECT_NEAR(student_two_sided(1.0, 1), 0.5, 1e-12);
}

TEST(StatisticsHelpers, SidakKeepsTheFamilySignificance) {
  EXPECT_NEAR(1.0 - std::pow(1.0 - sidak(0.01, 37), 37), 0.01, 1e-12);
  EXPECT_DOUBLE_EQ(sidak(1e-4, 1), 1e-4);
}

TEST(StatisticsHelpers, MomentsMatchTheDefinition) {
  Moments moments;
  for (const double v : {1.0, 2.0, 4.0, 9.0}) moments.add(v);
  EXPECT_DOUBLE_EQ(moments.mean(), 4.0);
  EXPECT_NEAR(moments.variance(), (9.0 + 4.0 + 0.0 + 25.0) / 3.0, 1e-12);
  EXPECT_GT(mean_p_value(moments, 4.1), 0.9);
  EXPECT_LT(mean_p_value(moments, 40.0), 0.01);
}

TEST(StatisticsHelpers, MeasuredErrorsAreUniformWhenTheHypothesisHoldsAndSeeACommonShift) {
  // Errors with a bias of 0.01 and a deviation of 0.02: sums of twelve uniform numbers are nearly normal.
  Random random(3);
  const auto value = [&] {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += random.uniform();
    return 7.0 * (1.01 + 0.02 * sum);
  };
  constexpr int kRepetitions = 4000;
  int single_below = 0, common_below = 0;
  double shifted = 0.0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    Moments measured;
    for (int seed = 0; seed < 32; ++seed) measured.add(value() / 7.0 - 1.0);
    const MeasuredError error = {measured.mean(), std::sqrt(measured.variance()), 32};
    MeasuredErrors errors, shifted_errors;
    for (int i = 0; i < 3; ++i) {
      const double drawn = value();
      if (errors.p_value(drawn, 7.0, error) < 0.1) ++single_below;
      shifted_errors.p_value(1.06 * drawn, 7.0, error);
    }
    if (errors.common_p_value() < 0.1) ++common_below;
    shifted += shifted_errors.common_p_value() < 1e-3 ? 1.0 : 0.0;
  }
  // 0.1 within five standard errors; those of the same measurement depend on each other a little.
  EXPECT_NEAR(single_below / (3.0 * kRepetitions), 0.1, 0.016);
  EXPECT_NEAR(static_cast<double>(common_below) / kRepetitions, 0.1, 0.03);
  EXPECT_GT(shifted / kRepetitions, 0.9);
}

TEST(StatisticsHelpers, ChiSquarePValuesAreUniformWhenTheHypothesisHolds) {
  Random random(1);
  constexpr int kRepetitions = 2000;
  int below_tenth = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    std::vector<double> observed(20), expected(20, 50.0);
    for (int i = 0; i < 1000; ++i) observed[static_cast<std::size_t>(random.uniform() * 20)] += 1.0;
    below_tenth += chi_square_test(observed, expected).p_value < 0.1;
  }
  // Binomial with mean 200 and deviation 13.4; four deviations.
  EXPECT_NEAR(below_tenth, 200, 54);
}

TEST(StatisticsHelpers, ChiSquareRejectsATwoPercentBias) {
  std::vector<double> observed, expected;
  for (int i = 0; i < 50; ++i) {
    expected.push_back(2000.0);
    observed.push_back(i % 2 ? 2040.0 : 1960.0);
  }
  EXPECT_TRUE(accepts(chi_square_test(expected, expected), 0.5));
  EXPECT_LT(chi_square_test(observed, expected).p_value, 0.95);
  for (double& count : observed) count = 2000.0 + 5.0 * (count - 2000.0);
  EXPECT_FALSE(accepts(chi_square_test(observed, expected), 1e-6));
}

TEST(StatisticsHelpers, ChiSquareRejectsASampleWhereNoneCanFall) {
  const std::vector<double> expected{100.0, 0.0, 100.0};
  EXPECT_EQ(chi_square_test(std::vector<double>{100.0, 1.0, 99.0}, expected).p_value, 0.0);
}

TEST(StatisticsHelpers, ChiSquarePoolsCellsWithLowExpectation) {
  std::vector<double> expected(1000, 0.0125), observed(1000, 0.0);
  // Two pools of 5 expected samples; the last 2.5 join the large cell.
  expected.push_back(990.0);
  observed[3] = 12.5;
  observed.push_back(990.0);
  const ChiSquareResult result = chi_square_test(observed, expected);
  EXPECT_EQ(result.degrees_of_freedom, 2.0);
}

TEST(StatisticsHelpers, QuadratureIsExactForPolynomialsOfDegreeSeven) {
  EXPECT_NEAR(integrate([](double x) { return 8.0 * std::pow(x, 7); }, 0.0, 2.0), 256.0, 1e-10);
  EXPECT_NEAR(integrate([](double x) { return std::sin(x); }, 0.0, 3.14159265358979323846, 8), 2.0, 1e-9);
}

}  // namespace
}  // namespace gatelight::testing
