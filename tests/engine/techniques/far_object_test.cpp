// An object far away changes no shadow near the lights. The oracle here knows nothing of it, so that its
// bounds on rounding are those of the near scene.
#include "plan/settings/surfaces.h"
#include "techniques/shadow_stage.h"

namespace lightgrid {
namespace {

constexpr int far_width = 69, far_height = 41;

struct Near : ShadowStage {
  Near() : ShadowStage{shadowed_scene(), small_view(far_width, far_height)} {}
};
Near& near_stage() {
  static auto* made = new Near;  // support/devices.h
  return *made;
}

// A wall behind the eye, so that no pixel shows it.
Scene with_far_wall(const glm::dvec3& towards, double metres) {
  Scene scene = shadowed_scene();
  const int mesh = add_mesh(scene, wall_mesh({0, 0, 0}, 5, 0, "far"));
  add_instance(scene, "far", mesh, placed(towards * metres));
  return scene;
}

class FarObject : public testing::TestWithParam<RasterApi> {};

TEST_P(FarObject, ChangesNoShadowNearTheLights) {
  const Technique& technique = find_technique("forward_plus");
  const Settings settings{{setting::raster, GetParam()}};
  Near& stage = near_stage();
  TechniqueRun alone(test_devices(), stage.gpu, stage.view, settings, technique);
  alone.run_frame();
  const LitPairs alone_pairs = stage.pairs(alone);
  for (const double metres : {1e5, 1e6, 1e7}) {
    for (const glm::dvec3& towards : {glm::dvec3(0, 0, 1), glm::dvec3(-0.7, 0.4, 1)}) {
      SCOPED_TRACE(fmt::format("{} m, {}", metres, towards.x));
      const Scene scene = with_far_wall(towards, metres);
      GpuScene gpu(test_devices(), scene);
      TechniqueRun run(test_devices(), gpu, stage.view, settings, technique);
      run.run_frame();
      EXPECT_TRUE(same_bits(shadows_of(alone), shadows_of(run)));
      EXPECT_TRUE(identical(alone.image(), run.image()));
      const LitPairs pairs = stage.pairs(run);
      EXPECT_TRUE(exact(pairs));
      EXPECT_LE(pairs.either, alone_pairs.either) << "the far object excuses nothing";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, FarObject, testing::Values(RasterApi::opengl, RasterApi::opencl),
                         [](const auto& info) {
                           return info.param == RasterApi::opengl ? "OpenGL" : "OpenCL";
                         });

}  // namespace
}  // namespace lightgrid
