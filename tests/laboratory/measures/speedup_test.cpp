#include "measures/speedup.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace lightgrid::lab {
namespace {

RunResult row(const char* technique, double ms, uint64_t listed, std::vector<PassResult> passes) {
  RunResult r;
  r.technique = technique;
  r.frame_ms = {ms, ms, ms, ms, 5};
  r.pairs = PairCounts{listed, 100, 0, 0};
  r.error = ImageError{};
  r.passes = std::move(passes);
  return r;
}

const std::vector<PassResult> gl_passes = {{"depth_prepass", "gl"}, {"shade_forward", "gl"}};
const std::vector<PassResult> gl_with_lists = {
    {"depth_prepass", "gl"}, {"cull_lights", "cl"}, {"shade_forward", "gl"}};
const std::vector<PassResult> cl_passes = {{"rasterize", "cl"}, {"resolve", "cl"}};
const std::vector<PassResult> cl_with_lists = {{"rasterize", "cl"}, {"cull_lights", "cl"}, {"resolve", "cl"}};

// Lists make OpenGL 7.5 times faster; OpenCL with the same lists is 6 times faster than that.
CompareReport hall() {
  CompareReport report;
  report.reference = "forward";
  report.rows = {row("forward", 900, 23700, gl_passes), row("forward_plus", 120, 1180, gl_with_lists),
                 row("visibility", 20, 1180, cl_with_lists)};
  return report;
}

double product(const Speedup& s) { return s.lists.value_or(1) * s.api.value_or(1) * s.other; }

TEST(Speedup, SplitsIntoFactorsThatRowsOfTheRunIsolate) {
  const CompareReport report = hall();
  const auto s = speedup_of(report, report.rows[2]);
  ASSERT_TRUE(s);
  EXPECT_DOUBLE_EQ(s->total, 45);
  EXPECT_DOUBLE_EQ(*s->lists, 7.5);
  EXPECT_DOUBLE_EQ(*s->api, 6);
  EXPECT_EQ(s->other, 1);
  EXPECT_EQ(s->by, &report.rows[1]);
}

TEST(Speedup, DoesNotCreditListsThatMakeOpenGlSlower) {
  CompareReport report = hall();
  report.rows[0] = row("forward", 92, 30000, gl_passes);
  report.rows[1] = row("forward_plus", 100, 25300, gl_with_lists);
  report.rows[2] = row("visibility", 20, 25300, cl_with_lists);
  const auto s = speedup_of(report, report.rows[2]);
  EXPECT_DOUBLE_EQ(*s->lists, 0.92);
  EXPECT_DOUBLE_EQ(*s->api, 5);
}

TEST(Speedup, WithoutAnIsolatingRowUsesEveryLightInOpenClOrClaimsNothing) {
  CompareReport report = hall();
  report.rows.erase(report.rows.begin() + 1);
  const auto unknown = speedup_of(report, report.rows[1]);
  EXPECT_FALSE(unknown->lists);
  EXPECT_FALSE(unknown->api);
  EXPECT_DOUBLE_EQ(unknown->other, 45);
  report.own_surfaces = OwnSurfaces{"", ImageError{}, row("visibility", 180, 23700, cl_passes)};
  const auto s = speedup_of(report, report.rows[1]);
  EXPECT_DOUBLE_EQ(*s->lists, 9);
  EXPECT_DOUBLE_EQ(*s->api, 5);
  EXPECT_EQ(s->other, 1);
}

// Lists that make OpenGL 7.5 times faster make kernels, which take 30 ms for every light, 1.5 times faster.
TEST(Speedup, HasWhatListsGiveInOpenClNextToWhatTheyGiveInOpenGl) {
  CompareReport report = hall();
  report.own_surfaces = OwnSurfaces{"", ImageError{}, row("visibility", 30, 23700, cl_passes)};
  const auto s = speedup_of(report, report.rows[2]);
  EXPECT_DOUBLE_EQ(*s->lists, 7.5);
  EXPECT_DOUBLE_EQ(s->lists_in_opencl.value(), 1.5);
  EXPECT_DOUBLE_EQ(product(*s), s->total) << "it is not one of the factors";
  EXPECT_FALSE(speedup_of(report, report.rows[1])->lists_in_opencl) << "forward_plus draws with OpenGL";
}

TEST(Speedup, LeavesOtherListsAndOtherSettingsOut) {
  CompareReport report = hall();
  report.rows[1].pairs->listed = 3000;
  EXPECT_FALSE(speedup_of(report, report.rows[2])->lists) << "lists of another length isolate nothing";
  report = hall();
  for (RunResult& r : report.rows) r.settings["samples"] = "1";
  report.rows[2].settings["samples"] = "4";
  const auto s = speedup_of(report, report.rows[2]);
  EXPECT_FALSE(s->lists);
  EXPECT_DOUBLE_EQ(s->other, 45) << "more samples per pixel are another picture";
}

TEST(Speedup, OfAnotherTechniqueInOpenGlKeepsWhatListsAreWorthApart) {
  CompareReport report = hall();
  report.rows.push_back(row("deferred", 60, 1180, {{"fill_gbuffer", "gl"}, {"shade_light_volumes", "gl"}}));
  const auto s = speedup_of(report, report.rows[3]);
  EXPECT_DOUBLE_EQ(*s->lists, 7.5);
  EXPECT_EQ(*s->api, 1);
  EXPECT_DOUBLE_EQ(s->other, 2);
}

TEST(Speedup, IsTheProductOfItsFactorsInResultsJson) {
  const CompareReport report = hall();
  for (const RunResult& r : report.rows) {
    const auto s = speedup_of(report, r);
    EXPECT_NEAR(product(*s), s->total, 1e-12 * s->total);
  }
  const auto json = to_json(report);
  EXPECT_EQ(json["rows"][2]["speedup"], nlohmann::json({{"total", 45.0},
                                                        {"lists", 7.5},
                                                        {"api", 6.0},
                                                        {"other", 1.0},
                                                        {"lists_in_opencl", nullptr},
                                                        {"by", "forward_plus"}}));
  EXPECT_EQ(json["rows"][0]["speedup"]["total"], 1.0);
  CompareReport untimed = hall();
  untimed.rows[0].frame_ms = {};
  EXPECT_TRUE(to_json(untimed)["rows"][2]["speedup"].is_null());
}

TEST(SoftwareOpenGl, IsKnownByItsDriver) {
  EXPECT_EQ(software_opengl("llvmpipe (LLVM 15.0.6, 256 bits)"), "llvmpipe");
  EXPECT_EQ(software_opengl("NVIDIA H100"), "");
}

}  // namespace
}  // namespace lightgrid::lab
