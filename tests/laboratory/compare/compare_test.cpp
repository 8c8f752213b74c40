#include "compare/compare.h"

#include <gmock/gmock.h>

#include <memory>
#include <new>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "measures/metrics.h"
#include "measures/results.h"
#include "passes/light_index/lidr_settings.h"
#include "passes/surfaces.h"
#include "run/technique_run.h"
#include "support/error_of.h"
#include "support/render.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

using testing::HasSubstr;

Frame refuse(RenderView&) { throw machine_error("8 bits of blending are not exact here"); }
const Technique refuses{
    .name = "refuses", .summary = "refuses", .source = "none", .needs = {}, .settings = {}, .render = refuse};

CompareReport compared(const std::vector<Contestant>& contestants) {
  const Scene scene = small_scene().scene;
  const View view = small_view(17, 9);
  CompareOptions options{.frames = 2, .warmup = 1, .shaded_samples = 10};
  return compare_techniques(software_devices(), scene, view, contestants, options);
}

TEST(TechniqueRun, SharesItsBuffersWithRunsOfItsPoolAndGivesTheRestBack) {
  const Scene scene = small_scene().scene;
  const View view = small_view(48, 32);
  GpuScene gpu(software_devices(), scene);
  const auto pool = std::make_shared<TargetPool>();
  TechniqueRun alone(software_devices(), gpu, view, {}, find_technique("deferred_tiled"));
  TechniqueRun first(software_devices(), gpu, view, {}, find_technique("deferred_tiled"), pool);
  TechniqueRun second(software_devices(), gpu, view, {}, find_technique("forward_plus_compute"), pool);
  alone.run_frame();
  for (int frame = 0; frame < 2; ++frame) {
    first.run_frame();
    second.run_frame();
    EXPECT_EQ(first.frame().image.in_cl, second.frame().image.in_cl);
    EXPECT_TRUE(compare_images(first.image(), alone.image()).bit_identical) << "frame " << frame;
    EXPECT_EQ(first.result().memory_total, alone.result().memory_total) << "as if it had its own";
  }
  EXPECT_NE(first.frame().image.in_cl, alone.frame().image.in_cl);
  const size_t held = first.view().memory_bytes();
  first.release();
  EXPECT_LT(first.view().memory_bytes(), held);
  first.run_frame();
  EXPECT_EQ(first.view().memory_bytes(), held);
  EXPECT_TRUE(compare_images(first.image(), alone.image()).bit_identical) << "after its release";
}

// Lists every light, and shades none of those with a position.
const Technique lists_alone{.name = "lists_alone",
                            .summary = "lists_alone",
                            .source = "none",
                            .needs = {},
                            .settings = {},
                            .render = [](RenderView& v) {
                              const Surfaces surfaces = find_surfaces(v);
                              Frame frame = frame_of(v, surfaces);
                              frame.image =
                                  shade(v, surfaces, LightSource([&v] { return base_lighting(v); }));
                              return frame;
                            }};

TEST(CompareTechniques, TellsWhoseLoopShadesLessThanItsListsHold) {
  const CompareReport report = compared(
      {{&lists_alone, {}}, {&find_technique("forward_plus"), {}}, {&find_technique("visibility"), {}}});
  ASSERT_EQ(report.rows.size(), 3u);
  EXPECT_EQ(report.rows[0].pairs->lost, 0u);
  EXPECT_GT(report.rows[0].unshaded.value(), max_unshaded);
  EXPECT_EQ(report.rows[1].unshaded.value(), 0);
  EXPECT_EQ(report.rows[2].unshaded.value(), 0) << "against every light on its own surfaces";
}

// Lights that capped lists lack count as overflow, apart from the light of a broken loop.
TEST(CompareTechniques, TellsWhatCappedListsLeaveOut) {
  Settings one, none;
  apply_setting(one, "list-cap=1");
  const CompareReport report =
      compared({{&find_technique("forward_plus"), one}, {&find_technique("forward_plus"), none}});
  EXPECT_GT(report.rows[0].pairs->lost, 0u);
  EXPECT_EQ(report.rows[0].overflow, report.rows[0].pairs->lost);
  EXPECT_FALSE(report.rows[0].unshaded);
  ASSERT_TRUE(report.rows[0].limited);
  EXPECT_GT(report.rows[0].limited->lost_light, 0.01);
  EXPECT_LT(report.rows[0].limited->lost_light, 1);
  EXPECT_FALSE(report.rows[1].limited);
  EXPECT_EQ(report.rows[1].overflow, 0u);
}

TEST(CompareTechniques, MakesARowOfWhatIsRefusedAndGoesOn) {
  const CompareReport report = compared({{&refuses, {}}, {&find_technique("forward_plus"), {}}});
  ASSERT_EQ(report.rows.size(), 2u);
  EXPECT_EQ(report.rows[0].refused, "8 bits of blending are not exact here");
  EXPECT_EQ(report.rows[0].lights_total, 6);
  EXPECT_EQ(report.rows[1].frame_ms.runs, 2);
  EXPECT_EQ(report.rows[1].pairs->lost, 0u);

  const auto row = to_json(report.rows[0]);
  EXPECT_EQ(row["refused"], report.rows[0].refused);
  EXPECT_TRUE(row["frame_ms"]["median"].is_null());
  EXPECT_EQ(row["frame_ms"]["runs"], 0);
  EXPECT_TRUE(row["memory_bytes"]["total"].is_null());
  EXPECT_TRUE(row["pairs"].is_null());
  EXPECT_FALSE(to_json(report.rows[1]).contains("refused"));
}

// The picture is rendered, then memory runs out while its lists are read.
Frame without_memory_for_lists(RenderView& v) {
  Frame frame = find_technique("forward").render(v);
  frame.listed = [](auto&) -> ListedLights { throw std::bad_alloc(); };
  return frame;
}

TEST(CompareTechniques, MakesARefusedRowOfListsThatMemoryDoesNotHold) {
  Technique many = find_technique("forward");  // the reference, too
  many.render = without_memory_for_lists;
  const CompareReport report = compared({{&many, {}}, {&find_technique("forward_plus"), {}}});
  ASSERT_EQ(report.rows.size(), 2u);
  EXPECT_EQ(report.rows[0].refused, "out of memory");
  EXPECT_EQ(report.rows[1].refused, "");
  EXPECT_EQ(report.rows[1].pairs->lost, 0u);
  EXPECT_EQ(report.images.size(), 2u);
  EXPECT_EQ(report.listed.size(), 2u);
}

// 40 lights in one place, where lidr can store 4: the omitted ones are counted as overflow, and there is none
// elsewhere.
TEST(CompareTechniques, CountsLightsThatATechniqueHasNoPlaceFor) {
  SmallScene s = small_scene();
  for (int i = 0; i < 40; ++i) add_point(s.scene, "lamp", {0.01f * i, 0.4f, -3.5f}, {1, 1, 1}, 1, 2);
  const CompareOptions options{.frames = 1, .warmup = 0, .shaded_samples = 10};
  const Technique& lidr = find_technique("lidr");
  const CompareReport report = compare_techniques(
      software_devices(), s.scene, small_view(17, 9),
      {{&lidr, {{setting::lidr_overlap, 4}}}, {&find_technique("forward_plus"), {}}}, options);
  ASSERT_EQ(report.rows.size(), 2u);
  EXPECT_GT(report.rows[0].overflow, 0u);
  EXPECT_EQ(report.rows[0].overflow, report.rows[0].pairs->lost);
  EXPECT_EQ(to_json(report.rows[0])["overflow"], report.rows[0].overflow);
  EXPECT_EQ(report.rows[1].overflow, 0u);
  // Few enough lights: none is omitted.
  EXPECT_EQ(compared({{&lidr, {}}}).rows[0].overflow, 0u);
}

TEST(CompareTechniques, KeepTheReferencesPictureWhereItIsNoRow) {
  const CompareReport report = compared({{&find_technique("forward_plus"), {}}});
  ASSERT_EQ(report.reference_image.width, 17);
  EXPECT_TRUE(report.rows[0].error->bit_identical);
  EXPECT_TRUE(report.images[0].pixels.empty()) << "a copy";
  EXPECT_EQ(&image_of(report, 0), &report.reference_image);
  EXPECT_TRUE(compared({{&find_technique("forward"), {}}}).reference_image.pixels.empty());
}

TEST(CompareTechniques, ThrowsTheReasonWhereNoneIsLeft) {
  EXPECT_THAT(error_of(
                  [&] {
                    compared({{&refuses, {}}, {&refuses, {}}});
                  },
                  ErrorKind::machine),
              HasSubstr("not exact here"));
}

}  // namespace
}  // namespace lightgrid::lab
