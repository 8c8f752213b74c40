#include "measures/error_measures.h"

#include <gmock/gmock.h>

#include <set>

#include <nlohmann/json.hpp>

#include "measures/metrics.h"
#include "report/report.h"

namespace lightgrid::lab {
namespace {

using testing::HasSubstr;

// Two pixels against black and 4: errors 3 and 4, 0 elsewhere. Relative to the channels, of which black
// counts as a thousandth of the brightest, 750 and 1.
struct Known {
  Image image{2, 1}, reference{2, 1};
  Known() {
    image.pixels = {{3, 0, 0, 1}, {0, 0, 0, 1}};
    reference.pixels = {{0, 0, 0, 1}, {0, 4, 0, 1}};
  }
};

ImageError known_error() { return compare_images(Known().image, Known().reference); }

TEST(ErrorMeasures, AreThoseWorkedOutByHand) {
  const std::map<std::string, double> by_hand = {{"max_abs", 4},
                                                 {"max_rel", 1},
                                                 {"rmse", std::sqrt(25.0 / 6)},
                                                 {"p99", 4},
                                                 {"rmse_rel", std::sqrt(25.0 / 6) / 4},
                                                 {"p99_rel", 1}};
  const ImageError error = known_error();
  std::set<std::string> keys;
  for (const ErrorMeasure& measure : error_measures()) {
    ASSERT_TRUE(by_hand.contains(measure.key)) << "no value worked out for " << measure.key;
    EXPECT_DOUBLE_EQ(error.*measure.value, by_hand.at(measure.key)) << measure.key;
    EXPECT_TRUE(keys.insert(measure.key).second) << measure.key << " is there twice";
  }
  EXPECT_EQ(keys.size(), by_hand.size());
}

// Over a brightest channel of 8, which is not that of this reference: black counts as 0.008. Of the light,
// the mean luminance is 4 x 0.7152 / 2. The square of the low pass is the whole picture: errors of 3 / 2 and
// -4 / 2.
TEST(ErrorMeasures, OfTheFrontierAreThoseWorkedOutByHand) {
  constexpr double mean = 1.4304, e = 0.014304;
  constexpr double rel_mse = (9 / (e * e) + 16 / (16 + e * e)) / 6, smape = (3 / (3 + e) + 4 / (4 + e)) / 6;
  const std::map<std::string, double> by_hand = {{"max_rel", 0.5},
                                                 {"rmse_rel", std::sqrt(25.0 / 6) / 8},
                                                 {"relative_rmse", std::sqrt((375.0 * 375.0 + 1) / 6)},
                                                 {"p99_rel", 0.5},
                                                 {"rel_mse", rel_mse},
                                                 {"rel_mse_trimmed", rel_mse},
                                                 {"smape", smape},
                                                 {"smape_trimmed", smape},
                                                 {"energy_rel", -0.25},
                                                 {"rmse_of_mean", std::sqrt(25.0 / 6) / mean},
                                                 {"low_pass_rmse_of_mean", std::sqrt(6.25 / 3) / mean}};
  const Known known;
  const std::vector<glm::dvec3> in_double = {{0, 0, 0}, {0, 4, 0}};
  const ImageError of_picture = frontier_error(known.image, known.reference, 8),
                   of_sample = frontier_error(known.image, in_double, 8);
  for (const ErrorMeasure& measure : frontier_error_measures()) {
    const double expected = by_hand.at(measure.key);
    EXPECT_NEAR(of_picture.*measure.value, expected, 1e-14 * std::abs(expected)) << measure.key;
    if (measure.key == std::string("low_pass_rmse_of_mean")) continue;
    EXPECT_NEAR(of_sample.*measure.value, expected, 1e-14 * std::abs(expected)) << measure.key;
  }
  EXPECT_TRUE(std::isnan(of_sample.low_pass_rmse_of_mean)) << "a sample has no neighbours";
  EXPECT_EQ(frontier_error_measures().size(), by_hand.size());
}

Image gray(int width, int height, float value) {
  Image image(width, height);
  for (glm::vec4& pixel : image.pixels) pixel = glm::vec4(value, value, value, 1);
  return image;
}

// 2,999 pixels: two of the three that are a hundred times too bright are left out.
TEST(ErrorMeasures, OfTheFrontierLeaveOutTheWorstThousandth) {
  const Image truth = gray(2999, 1, 1);
  Image image = gray(2999, 1, 1.25f);
  for (const int fly : {5, 800, 2998}) image.pixels[size_t(fly)] = glm::vec4(100, 100, 100, 1);
  const double e = 0.01, square = 1 + e * e;
  const double near = 0.0625 / square, far = 99.0 * 99 / square;
  const ImageError error = frontier_error(image, truth, 1);
  EXPECT_NEAR(error.rel_mse, (2996 * near + 3 * far) / 2999, 1e-9);
  EXPECT_NEAR(error.rel_mse_trimmed, (2996 * near + far) / 2997, 1e-9);
  EXPECT_NEAR(error.smape, (2996 * 0.25 / (2.25 + e) + 3 * 99 / (101 + e)) / 2999, 1e-12);
  EXPECT_NEAR(error.smape_trimmed, (2996 * 0.25 / (2.25 + e) + 99 / (101 + e)) / 2997, 1e-12);
  EXPECT_NEAR(error.energy_rel, (2996 * 0.25 + 3 * 99) / 2999, 1e-9);
}

// One pixel is in as many squares of 16 x 16 as there are places for them over it: in the corner 1 of 5 x 9,
// in the middle of 20 x 24 all 5 across and all 9 up.
TEST(ErrorMeasures, OfTheFrontierKnowErrorThatIsCorrelatedInSpace) {
  const Image truth = gray(20, 24, 1);
  const auto low_pass_of_one = [&](int x, int y) {
    Image image = truth;
    image.pixels[size_t(y * 20 + x)] += glm::vec4(256, 0, 0, 0);
    return frontier_error(image, truth, 1).low_pass_rmse_of_mean;
  };
  EXPECT_NEAR(low_pass_of_one(0, 0), std::sqrt(1.0 / 45 / 3), 1e-12);
  EXPECT_NEAR(low_pass_of_one(19, 1), std::sqrt(2.0 / 45 / 3), 1e-12);
  EXPECT_NEAR(low_pass_of_one(10, 12), std::sqrt(1.0 / 3), 1e-12);
  const ImageError even = frontier_error(gray(20, 24, 1.5f), truth, 1);
  EXPECT_NEAR(even.low_pass_rmse_of_mean, 0.5, 1e-12) << "a level is all low pass";
  Image noise = truth;
  uint32_t state = 7;
  for (glm::vec4& pixel : noise.pixels) {
    state = state * 1664525u + 1013904223u;
    pixel += glm::vec4(state >> 31 ? 1 : -1, 0, 0, 0);
  }
  const ImageError noisy = frontier_error(noise, truth, 1);
  EXPECT_NEAR(noisy.rmse_of_mean, std::sqrt(1.0 / 3), 1e-12);
  EXPECT_LT(noisy.low_pass_rmse_of_mean, noisy.rmse_of_mean / 5) << "noise of single pixels is hardly left";
}

TEST(ErrorMeasures, OfTheFrontierAreInfiniteWithNaNAndZeroOfEqualPictures) {
  const Image truth = gray(17, 9, 0.5f);
  Image image = truth;
  for (const ErrorMeasure& measure : frontier_error_measures())
    EXPECT_EQ(frontier_error(image, truth, 1).*measure.value, 0) << measure.key;
  image.pixels[3].g = std::nanf("");
  for (const ErrorMeasure& measure : frontier_error_measures()) {
    if (measure.key == std::string("p99_rel")) continue;
    EXPECT_TRUE(std::isinf(frontier_error(image, truth, 1).*measure.value)) << measure.key;
  }
  const Image black = gray(17, 9, 0);
  EXPECT_EQ(frontier_error(black, black, 0).smape, 0);
  EXPECT_EQ(frontier_error(black, black, 0).energy_rel, 0);
  EXPECT_EQ(frontier_error(truth, black, 0).smape, 1);
  EXPECT_TRUE(std::isinf(frontier_error(truth, black, 0).rel_mse_trimmed));
}

// At least 99 of 100 do not exceed it, and no smaller value is such.
TEST(Percentile99, IsTheSmallestValueThatLeavesAHundredthAbove) {
  for (const size_t count : {1, 2, 99, 100, 101, 150, 199, 200, 201, 1000}) {
    std::vector<int> values(count);
    for (size_t i = 0; i < count; ++i) values[i] = int((i * 7919 + 5) % count);
    const auto above = [&](int value) {
      return std::ranges::count_if(values, [&](int v) { return v > value; });
    };
    const int found = percentile_99(values);
    EXPECT_LE(100 * size_t(above(found)), count) << count;
    EXPECT_GT(100 * size_t(above(found - 1)), count) << count;
  }
}

TEST(ErrorMeasures, AreInJsonAndInCsv) {
  RunResult row;
  row.error = known_error();
  const nlohmann::json json = to_json(row);
  ReportView view;
  view.report.rows = {row};
  const std::string csv = results_csv({view}), heading = csv.substr(0, csv.find('\n'));
  for (const ErrorMeasure& measure : error_measures()) {
    EXPECT_EQ(json["error"].value(measure.key, -1.0), (*row.error).*measure.value) << measure.key;
    EXPECT_THAT("," + heading + ",", HasSubstr(std::string(",") + measure.key + ","));
  }
}

}  // namespace
}  // namespace lightgrid::lab
