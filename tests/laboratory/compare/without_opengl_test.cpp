// A renderer without OpenGL, and what OpenGL holds where only OpenCL draws.
#include <gtest/gtest.h>

#include "base/error.h"
#include "compare/compare.h"
#include "gl/objects.h"
#include "measures/metrics.h"
#include "plan/settings/grid.h"
#include "plan/settings/surfaces.h"
#include "run/technique_run.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

// Never closed, as those of support/devices.h.
Renderer& opencl_alone() {
  static Renderer* const devices = new Renderer("", GlBackend::none);
  return *devices;
}

Scene scene_with_glass() {
  SmallScene s = small_scene();
  for (const char* name : {"blend", "mask"}) effect(name).add(s);
  return s.scene;
}

TEST(RendererWithoutOpenGl, DrawsVisibilitysBytes) {
  const Scene scene = scene_with_glass();
  std::vector<Image> images;
  for (Renderer* devices : {&opencl_alone(), &software_devices()}) {
    TechniqueRun run(*devices, scene, small_view(71, 37), {}, find_technique("visibility"));
    run.run_frame();
    images.push_back(run.image());
  }
  EXPECT_GT(brightest_channel(images[0]), 0.1f);
  EXPECT_TRUE(compare_images(images[0], images[1]).bit_identical);
}

TEST(RendererWithoutOpenGl, RefusesTechniquesThatDrawWithIt) {
  const Scene scene = scene_with_glass();
  for (const Technique* technique : techniques()) {
    if (!technique->needs.surfaces.opengl) continue;
    EXPECT_THROW(TechniqueRun(opencl_alone(), scene, small_view(17, 9), {}, *technique), Error)
        << technique->name;
  }
}

TEST(RendererWithoutOpenGl, ComparesWithEveryLightAlongAPath) {
  Scene scene = scene_with_glass();
  const Technique& visibility = find_technique("visibility");
  CompareOptions options{.frames = 1, .warmup = 0};
  options.path = {small_view(33, 19), make_view(look_at({0.1, 0, 0}, {0, 0, -1}), 33, 19),
                  small_view(33, 19)};
  const CompareReport report =
      compare_techniques(opencl_alone(), scene, small_view(33, 19),
                         {{&visibility, {{setting::texels, TexelLayout::separate}}}}, options);
  EXPECT_EQ(report.reference, "visibility:lights=all");
  EXPECT_FALSE(report.reference_errors.has_value());
  ASSERT_EQ(report.rows.size(), 1u);
  const RunResult& row = report.rows[0];
  EXPECT_EQ(row.refused, "");
  EXPECT_TRUE(row.error->bit_identical);
  EXPECT_TRUE(light_error(row)->bit_identical) << "the reference has these surfaces";
  EXPECT_FALSE(report.own_surfaces.has_value());
  EXPECT_EQ(row.moving->max_abs, 0);
  EXPECT_GT(row.moving->pairs.lit, row.pairs->lit);
  EXPECT_EQ(row.moving->pairs.lost, 0u);
  EXPECT_EQ(&image_of(report, 0), &report.reference_image);
  EXPECT_EQ(report.reference_image.width, 33);

  options.reference = ReferencePixels::sampled;
  EXPECT_THROW(compare_techniques(opencl_alone(), scene, small_view(33, 19), {{&visibility, {}}}, options),
               Error);
}

TEST(RendererWithOpenGl, UploadsNothingOfTheSceneForVisibility) {
  const Scene scene = scene_with_glass();
  Renderer& devices = software_devices();
  const GlCounts before = gl_counts();
  GpuScene gpu(devices, scene);
  TechniqueRun run(devices, gpu, small_view(71, 37), {{setting::lights, ShadedLights::all}},
                   find_technique("visibility"));
  run.run_frame();
  for (const GlKind kind : {GlKind::buffer, GlKind::texture, GlKind::vertex_array, GlKind::framebuffer}) {
    EXPECT_EQ(gl_counts().made[int(kind)], before.made[int(kind)]) << int(kind);
  }
  TechniqueRun other(devices, gpu, small_view(71, 37), {}, find_technique("forward"));
  EXPECT_GT(gl_counts().of(GlKind::vertex_array), before.of(GlKind::vertex_array))
      << "a technique that does need it";
}

}  // namespace
}  // namespace lightgrid::lab
