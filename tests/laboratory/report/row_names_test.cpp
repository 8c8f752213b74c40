#include <gmock/gmock.h>

#include "report/report.h"

namespace lightgrid::lab {
namespace {

using testing::ElementsAre;

CompareReport rows_of(std::vector<std::pair<std::string, std::map<std::string, std::string>>> rows) {
  CompareReport report;
  for (const auto& [technique, settings] : rows) {
    report.rows.emplace_back().technique = technique;
    report.rows.back().settings = settings;
  }
  return report;
}

TEST(RowNames, AreTechniquesWhereEachIsThereOnce) {
  EXPECT_THAT(row_names(rows_of({{"forward", {{"tile", "16"}}}, {"lidr", {{"tile", "8"}}}})),
              ElementsAre("forward", "lidr"));
}

TEST(RowNames, SayWhatDiffersBetweenRowsOfOneTechnique) {
  EXPECT_THAT(
      row_names(rows_of({{"lidr", {{"tile", "16"}, {"lidr_packing", "sort"}, {"lidr_overlap", "4"}}},
                         {"lidr", {{"tile", "16"}, {"lidr_packing", "sort"}, {"lidr_overlap", "2"}}},
                         {"lidr", {{"tile", "16"}, {"lidr_packing", "bitshift"}, {"lidr_overlap", "4"}}},
                         {"forward", {{"tile", "8"}}}})),
      ElementsAre("lidr:lidr-overlap=4,lidr-packing=sort", "lidr:lidr-overlap=2,lidr-packing=sort",
                  "lidr:lidr-overlap=4,lidr-packing=bitshift", "forward"));
}

TEST(RowNames, NumberRowsThatDifferInNothing) {
  EXPECT_THAT(row_names(rows_of({{"forward", {}}, {"forward", {}}, {"forward", {}}})),
              ElementsAre("forward", "forward-2", "forward-3"));
}

TEST(FileStems, HoldNothingThatAFileSystemTripsOver) {
  EXPECT_THAT(file_stems({"lidr:tile=8,cull-test=planes+aabb", "../a b\\c*?\"<>|", "caf\xc3\xa9"}),
              ElementsAre("lidr-tile=8-cull-test=planes+aabb", "..-a-b-c------", "caf--"));
}

TEST(FileStems, StayDistinct) {
  EXPECT_THAT(file_stems({"a:b", "a,b", "a-b"}), ElementsAre("a-b", "a-b-2", "a-b-3"));
}

}  // namespace
}  // namespace lightgrid::lab
