// Effects that the plan does not name are not built, allocated or launched; omitting them changes no byte.
#include <gmock/gmock.h>

#include "plan/settings/kernels.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

struct EachEffect : testing::TestWithParam<std::string> {
  const SceneEffect& effect = lightgrid::effect(GetParam());
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
    EXPECT_TRUE(identical(render(s.scene, view, technique, {{setting::everything_on, true}}), planned))
        << technique;
    EXPECT_FALSE(same_bytes(planned, render(without.scene, view, technique))) << "the effect is seen";
  }
}

TEST_P(EachEffect, ForwardPlusHasTheBytesOfForward) {
  const SmallScene s = with();
  const View view = small_view(127, 73);
  expect_exact(s.scene, view, {}, render(s.scene, view, "forward"));
}

// Objects created and launches made by one frame.
struct WorkCounts {
  int buffers = 0, textures = 0, programs = 0, kernels = 0, cl_launches = 0, culls = 0;
  bool operator==(const WorkCounts&) const = default;
};

std::ostream& operator<<(std::ostream& out, const WorkCounts& w) {
  return out << fmt::format("{} buffers, {} textures, {} programs, {} kernels, {} launches, {} of them culls",
                            w.buffers, w.textures, w.programs, w.kernels, w.cl_launches, w.culls);
}

// In the shape and form whose kernels are the same on every device.
WorkCounts work_of(const Scene& scene,
                   const Settings& settings = {{setting::kernel_shape, KernelShape::lanes},
                                               {setting::portable, true}}) {
  Renderer devices("", GlBackend::automatic);  // with no program compiled yet
  const ClProfiler& profiler = devices.cl->profiler();
  const GlCounts before = gl_counts();
  const auto kernels_asked = [&] {
    const ProgramCache::Counts& counts = devices.kernels->counts();
    return counts.built + counts.from_disk + counts.from_memory;
  };
  // A staged bridge also copies; the computation of a frame is the same.
  const auto launched = [&] {
    return profiler.count() - profiler.count("hand_to_gl") - profiler.count("hand_to_cl");
  };
  const int kernels = kernels_asked(), launches = launched(), culls = profiler.count("cull_lights");
  TechniqueRun run(devices, scene, small_view(127, 73), settings, find_technique("forward_plus"));
  run.run_frame();
  const auto made = [&](GlKind kind) { return gl_counts().made[int(kind)] - before.made[int(kind)]; };
  // Its objects are destroyed while its context is current.
  return {made(GlKind::buffer),      made(GlKind::texture), made(GlKind::program),
          kernels_asked() - kernels, launched() - launches, profiler.count("cull_lights") - culls};
}

constexpr WorkCounts operator+(WorkCounts a, const WorkCounts& b) {
  return {a.buffers + b.buffers, a.textures + b.textures,       a.programs + b.programs,
          a.kernels + b.kernels, a.cl_launches + b.cl_launches, a.culls + b.culls};
}

// Objects and launches of each part of a frame.
constexpr WorkCounts geometry{.buffers = 4};  // positions, normals, indices, a stand-in for absent streams
constexpr WorkCounts vertex_array{.buffers = 1};
constexpr WorkCounts materials{.buffers = 1};
constexpr WorkCounts view_parameters{.buffers = 1};
constexpr WorkCounts targets{.textures = 2};  // depth, colour
constexpr WorkCounts material_map{.textures = 1};
constexpr WorkCounts program{.programs = 1};
constexpr WorkCounts depth_bounds{.kernels = 1, .cl_launches = 1};
constexpr WorkCounts light_array{.buffers = 1, .textures = 1};  // positions, colours, cones or directions
// Lights to view space, culled, lists written. The bridge's buffers of cells and indices are read as
// textures.
constexpr WorkCounts grid{.textures = 2, .cl_launches = 3, .culls = 1};
constexpr WorkCounts grid_kernels{.kernels = 3};  // built once, however many grids there are

// One opaque surface without a light: a program for depth and one for shading.
const WorkCounts dark_frame =
    geometry + materials + view_parameters + targets + program + program + depth_bounds;
const WorkCounts plain_frame = dark_frame + light_array + light_array + grid + grid_kernels;
const WorkCounts mapped_material = program + vertex_array + material_map;  // texture coordinates

// The first frame of a size runs once more if the first estimate of memory was too small: not here.
TEST_P(EachEffect, CostsWhatItSaysAndNothingElse) {
  const std::map<std::string, WorkCounts> added = {
      {"blend", program + grid},
      {"mask", mapped_material + program},  // depth has a program of its own too
      {"base_color_map", mapped_material},
      {"metallic_roughness_map", mapped_material},
      {"normal_map", mapped_material + vertex_array},  // tangents
      {"occlusion_map", mapped_material},
      {"emissive_map", mapped_material},
      {"clearcoat", program},
      {"clearcoat_maps", mapped_material + vertex_array + material_map + material_map},
      {"skin", program},
      {"minnaert", program},
      {"specular", program},
      {"specular_maps", mapped_material + material_map},
      {"vertex_color", program + vertex_array},
      {"uv1", mapped_material + vertex_array},
      {"uv_transform", mapped_material},
      {"unlit", program},
      {"spot", light_array},  // cones; all programs are others, none is more
      {"directional", light_array},
      {"area", light_array + light_array},      // cones and rectangles
      {"cookies", light_array + light_array},   // axes and texels
      {"profiles", light_array + light_array},  // axes and shares
      // Groups of lights and of surfaces; surfaces' numbers, drawn with the depth, and masks of tiles. No
      // program is one more.
      {"groups", light_array + light_array + WorkCounts{.textures = 1, .kernels = 1, .cl_launches = 1}},
  };
  EXPECT_EQ(work_of(with().scene), plain_frame + added.at(effect.name));
}

INSTANTIATE_TEST_SUITE_P(Effects, EachEffect, testing::ValuesIn(effect_names()),
                         [](const auto& info) { return info.param; });

TEST(PlannedWork, OfThePlainScene) { EXPECT_EQ(work_of(small_scene().scene), plain_frame); }

TEST(PlannedWork, WithoutALightThatHasAPlaceNothingIsCulled) {
  SmallScene s = small_scene(false);
  EXPECT_EQ(work_of(s.scene), dark_frame);
  effect("directional").add(s);
  EXPECT_EQ(work_of(s.scene), dark_frame + light_array);
}

TEST(PlannedWork, AnEffectOutOfViewCostsNothing) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  s.scene.instances.back().world_from_object = placed({0, 0, 30});
  EXPECT_EQ(work_of(s.scene), plain_frame);
}

TEST(PlannedWork, EverythingIsGivenBack) {
  const auto live = [] { return std::vector<int>(gl_counts().live, gl_counts().live + 6); };
  SmallScene s = small_scene();
  for (const SceneEffect& effect : effects()) effect.add(s);
  work_of(s.scene);
  const auto before = live();
  work_of(s.scene);
  EXPECT_EQ(live(), before);
}

// glTF: the alpha of an opaque material is ignored, even with code for alpha compiled in.
TEST(PlannedWork, AnOpaqueMaterialIgnoresItsAlpha) {
  SmallScene s = small_scene();
  const View view = small_view(127, 73);
  const Image solid = render(s.scene, view, "forward_plus");
  s.scene.materials[s.wall_material].base_color.a = 0.25f;
  EXPECT_TRUE(identical(render(s.scene, view, "forward_plus"), solid));
  EXPECT_TRUE(identical(render(s.scene, view, "forward_plus", {{setting::everything_on, true}}), solid));
}

TEST(PlannedWork, NoLightsAndNoEffectsHaveTheBytesOfEverythingOn) {
  const View view = small_view(127, 73);
  for (const bool lights : {false, true}) {
    const SmallScene s = small_scene(lights);
    for (const char* technique : {"forward", "forward_plus"}) {
      EXPECT_TRUE(identical(render(s.scene, view, technique, {{setting::everything_on, true}}),
                            render(s.scene, view, technique)));
    }
  }
}

}  // namespace
}  // namespace lightgrid
