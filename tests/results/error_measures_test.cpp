#include "results/error_measures.h"

#include <gmock/gmock.h>

#include <set>

#include <nlohmann/json.hpp>

#include "report/report.h"
#include "results/metrics.h"

namespace lightgrid {
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
  const std::map<std::string, double> by_hand = {
      {"max_abs", 4},
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

// Over a brightest channel of 8, which is not that of this reference: black counts as 0.008.
TEST(ErrorMeasures, OfTheFrontierAreThoseWorkedOutByHand) {
  const std::map<std::string, double> by_hand = {{"max_rel", 0.5},
                                                 {"rmse_rel", std::sqrt(25.0 / 6) / 8},
                                                 {"relative_rmse", std::sqrt((375.0 * 375.0 + 1) / 6)},
                                                 {"p99_rel", 0.5}};
  const Known known;
  const std::vector<glm::dvec3> in_double = {{0, 0, 0}, {0, 4, 0}};
  for (const ImageError& error :
       {frontier_error(known.image, known.reference, 8), frontier_error(known.image, in_double, 8)}) {
    for (const ErrorMeasure& measure : frontier_error_measures())
      EXPECT_DOUBLE_EQ(error.*measure.value, by_hand.at(measure.key)) << measure.key;
  }
  EXPECT_EQ(frontier_error_measures().size(), by_hand.size());
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
}  // namespace lightgrid
