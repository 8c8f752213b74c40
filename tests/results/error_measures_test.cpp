#include "results/error_measures.h"

#include <gmock/gmock.h>

#include <set>

#include <nlohmann/json.hpp>

#include "report/results_csv.h"
#include "results/metrics.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

// Two pixels against black and 4: errors 3 and 4, 0 elsewhere.
ImageError known_error() {
  Image image(2, 1), reference(2, 1);
  image.pixels = {{3, 0, 0, 1}, {0, 0, 0, 1}};
  reference.pixels = {{0, 0, 0, 1}, {0, 4, 0, 1}};
  return compare_images(image, reference);
}

TEST(ErrorMeasures, AreThoseWorkedOutByHand) {
  const std::map<std::string, double> by_hand = {
      {"max_abs", 4}, {"max_rel", 1}, {"rmse", std::sqrt(25.0 / 6)}, {"p99", 4}};
  const ImageError error = known_error();
  std::set<std::string> keys;
  for (const ErrorMeasure& measure : error_measures()) {
    ASSERT_TRUE(by_hand.contains(measure.key)) << "no value worked out for " << measure.key;
    EXPECT_DOUBLE_EQ(error.*measure.value, by_hand.at(measure.key)) << measure.key;
    EXPECT_TRUE(keys.insert(measure.key).second) << measure.key << " is there twice";
  }
  EXPECT_EQ(keys.size(), by_hand.size());
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
