// What the plan does not name is not built, allocated or launched; and what it leaves out changes no byte.
#include <gmock/gmock.h>

#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

struct EachEffect : testing::TestWithParam<int> {
  const Effect& effect = effects()[GetParam()];
  SmallScene with() const {
    SmallScene s = small_scene();
    effect.add(s);
    return s;
  }
};

TEST_P(EachEffect, HasTheBytesOfEverythingOn) {
  const SmallScene s = with(), without = small_scene();
  const View view = small_view(127, 73);
  for (const char* technique : {"forward", "forward_plus"}) {
    const Image planned = render(s.scene, view, technique);
    EXPECT_TRUE(identical(render(s.scene, view, technique, {.everything_on = true}), planned)) << technique;
    EXPECT_FALSE(same_bytes(planned, render(without.scene, view, technique))) << "the effect is seen";
  }
}

TEST_P(EachEffect, ForwardPlusHasTheBytesOfForward) {
  const SmallScene s = with();
  const View view = small_view(127, 73);
  expect_exact(s.scene, view, {}, render(s.scene, view, "forward"));
}

// What one frame makes and launches.
struct Work {
  int buffers, textures, programs, kernels, cl_launches, culls;
  bool operator==(const Work&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Work& w) {
  return out << fmt::format(
             "{} buffers, {} textures, {} programs, {} kernels, {} launches, {} of them culls",
             w.buffers, w.textures, w.programs, w.kernels, w.cl_launches, w.culls);
}

// In the shape and form whose kernels are the same on every device.
Work work_of(const Scene& scene, const Settings& settings = {.kernel_shape = KernelShape::lanes, .portable = true}) {
  Renderer devices("", GlBackend::automatic);  // with no program compiled yet
  const ClProfiler& profiler = devices.cl->profiler();
  const GlCounts before = gl_counts();
  const auto kernels_asked = [&] {
    const ProgramCache::Counts& counts = devices.kernels->counts();
    return counts.built + counts.from_disk + counts.from_memory;
  };
  // A staged bridge also copies; what a frame computes is the same.
  const auto launched = [&] {
    return profiler.count() - profiler.count("hand_to_gl") - profiler.count("hand_to_cl");
  };
  const int kernels = kernels_asked(), launches = launched(), culls = profiler.count("cull_lights");
  TechniqueRun run(devices, scene, small_view(127, 73), settings, find_technique("forward_plus"));
  run.run_frame();
  const auto made = [&](GlKind kind) { return gl_counts().made[int(kind)] - before.made[int(kind)]; };
  // Its objects go while its context is current.
  return {made(GlKind::buffer),      made(GlKind::texture),       made(GlKind::program),
          kernels_asked() - kernels, launched() - launches, profiler.count("cull_lights") - culls};
}

Work operator+(Work a, const Work& b) {
  return {a.buffers + b.buffers, a.textures + b.textures,       a.programs + b.programs,
          a.kernels + b.kernels, a.cl_launches + b.cl_launches, a.culls + b.culls};
}

TEST_P(EachEffect, CostsWhatItSaysAndNothingElse) {
  // The first frame of a size runs once more where a first guess of memory was too small: here none is.
  const Work plain = work_of(small_scene().scene);
  const std::map<std::string, Work> added = {
      // One more program; a grid of its own is two buffers with their textures, and three launches of the same
      // kernels.
      {"blend", {0, 2, 1, 0, 3, 1}},
      // The wall's own depth and shading programs; texture coordinates and a texture.
      {"mask", {1, 1, 2, 0, 0, 0}},
      {"base_color_map", {1, 1, 1, 0, 0, 0}},
      {"metallic_roughness_map", {1, 1, 1, 0, 0, 0}},
      {"normal_map", {2, 1, 1, 0, 0, 0}},  // tangents too
      {"occlusion_map", {1, 1, 1, 0, 0, 0}},
      {"emissive_map", {1, 1, 1, 0, 0, 0}},
      {"vertex_color", {1, 0, 1, 0, 0, 0}},
      {"uv1", {2, 1, 1, 0, 0, 0}},
      {"uv_transform", {1, 1, 1, 0, 0, 0}},
      {"unlit", {0, 0, 1, 0, 0, 0}},
      {"spot", {1, 1, 0, 0, 0, 0}},  // cones; all programs are others, none is more
      {"directional", {1, 1, 0, 0, 0, 0}},
  };
  EXPECT_EQ(work_of(with().scene), plain + added.at(effect.name));
}

INSTANTIATE_TEST_SUITE_P(Effects, EachEffect, testing::Range(0, int(effects().size())),
                         [](const auto& info) { return effects()[info.param].name; });

TEST(PlannedWork, OfThePlainScene) {
  // Positions, normals, what stands in for streams that no mesh has, indices, materials, the view, light places and
  // colours; and textures of the last two, of the grid's cells and indices, depth and colour. Depth bounds, then lights to view space, culled, compacted.
  EXPECT_EQ(work_of(small_scene().scene), (Work{8, 6, 2, 4, 4, 1}));
}

TEST(PlannedWork, WithoutALightThatHasAPlaceNothingIsCulled) {
  SmallScene s = small_scene(false);
  const Work dark = work_of(s.scene);
  EXPECT_EQ(dark, (Work{6, 2, 2, 1, 1, 0})) << "the one launch is depth bounds, which tell what is hidden";
  effects().back().add(s);  // a directional light
  EXPECT_EQ(work_of(s.scene), (Work{7, 3, 2, 1, 1, 0}));
}

TEST(PlannedWork, AnEffectOutOfViewCostsNothing) {
  const Work plain = work_of(small_scene().scene);
  for (const Effect& effect : effects()) {
    if (effect.name != "blend") continue;
    SmallScene s = small_scene();
    effect.add(s);
    s.scene.instances.back().world_from_object = placed({0, 0, 30});
    EXPECT_EQ(work_of(s.scene), plain) << effect.name;
  }
}

TEST(PlannedWork, EverythingIsGivenBack) {
  const auto live = [] { return std::vector<int>(gl_counts().live, gl_counts().live + 6); };
  SmallScene s = small_scene();
  for (const Effect& effect : effects()) effect.add(s);
  work_of(s.scene);
  const auto before = live();
  work_of(s.scene);
  EXPECT_EQ(live(), before);
}

// glTF: the alpha of an opaque material is ignored, whatever the code around it can do.
TEST(PlannedWork, AnOpaqueMaterialIgnoresItsAlpha) {
  SmallScene s = small_scene();
  const View view = small_view(127, 73);
  const Image solid = render(s.scene, view, "forward_plus");
  s.scene.materials[s.wall_material].base_color.a = 0.25f;
  EXPECT_TRUE(identical(render(s.scene, view, "forward_plus"), solid));
  EXPECT_TRUE(identical(render(s.scene, view, "forward_plus", {.everything_on = true}), solid));
}

TEST(PlannedWork, NoLightsAndNoEffectsHaveTheBytesOfEverythingOn) {
  const View view = small_view(127, 73);
  for (const bool lights : {false, true}) {
    const SmallScene s = small_scene(lights);
    for (const char* technique : {"forward", "forward_plus"}) {
      EXPECT_TRUE(identical(render(s.scene, view, technique, {.everything_on = true}),
                            render(s.scene, view, technique)));
    }
  }
}

}  // namespace
}  // namespace lightgrid
