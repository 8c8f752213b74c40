// voxel_lights: its picture against forward's, and where it must hold.
// passes/voxel_cases_test.cpp checks samples against the formulas in double.
#include "passes/voxels/voxel_settings.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "techniques/voxel_volume.h"

namespace lightgrid {
namespace {

struct DrawnVoxels {
  Image image;
  LitPairs pairs;
};

DrawnVoxels drawn(const Scene& scene, const View& view, const Settings& settings) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique("voxel_lights"));
  run.run_frame();
  return {run.image(), count_listed_pairs(run, read_depth(run))};
}

// Pictures in both spaces must have no NaN and lose no light.
struct VoxelCase {
  const char* name;
  std::function<void(SmallScene&)> change;
  glm::dvec3 eye{0}, target{0, 0, -1};
};

TEST(VoxelLights, HardCasesHold) {
  const auto at = [](glm::vec3 position, float candela, float radius) {
    return [=](SmallScene& s) { add_point(s.scene, "lamp", position, {1, 0.8f, 0.6f}, candela, radius); };
  };
  const std::vector<VoxelCase> cases = {
      {"without lights", [](SmallScene&) {}},
      {"in the eye", at({0, 0, 0}, 5, 6)},
      {"on a corner of the world's lattice", at({0, 0, -4}, 5, 6)},
      {"far larger than the volume", at({0, 50, -4}, 9e4f, 1e4f)},
      {"without an end", at({1, 1, -2}, 5, std::numeric_limits<float>::infinity())},
      {"much smaller than a voxel", at({0.301f, 0.011f, -3.999f}, 0.1f, 0.01f)},
      {"of no radius", at({0, 0, -3}, 5, 0)},
      {"as bright as floats go", at({0, 0, -3}, 3e38f, 5)},
      {"a million candela on a surface", at({0.3f, -0.2f, -4}, 1e6f, 3)},
      {"100,000 in one place",
       [](SmallScene& s) {
         s.scene.lights.resize(100000,
                               add_point(s.scene, "lamp", {0.5f, 0.4f, -3.3f}, {1, 1, 1}, 1e-4f, 1.5f));
       }},
      {"a thin cone",
       [](SmallScene& s) {
         add_spot(s.scene, "ray", {0, 0, 0}, {0.3f, 0.2f, -4}, {1, 1, 1}, 50, 9, 0, 0.05f);
       }},
      {"a half space of a cone",
       [](SmallScene& s) {
         add_spot(s.scene, "wide", {0, 1, -3}, {0, 0, -3}, {1, 1, 1}, 5, 6, 20, 89.9f);
       }},
      {"the eye looks away", at({0, 0, -3}, 5, 6), {0, 0, 2}, {0, 0, 3}},
      {"a million metres from the origin",
       [](SmallScene& s) {
         add_point(s.scene, "lamp", {0.2f, 0.1f, -3}, {1, 1, 1}, 5, 3);
         for (Instance& i : s.scene.instances) i.world_from_object[3] += glm::dvec4(1e6, -2e6, 3e6, 0);
         s.scene.lights[0].position += glm::dvec3(1e6, -2e6, 3e6);
       },
       {1e6, -2e6, 3e6},
       {1e6, -2e6, 3e6 - 1}},
  };
  for (const VoxelCase& c : cases) {
    SCOPED_TRACE(c.name);
    SmallScene s = small_scene(false);
    c.change(s);
    const View view = make_view(look_at(c.eye, c.target), 40, 25);
    for (const VoxelSpace space : {VoxelSpace::world, VoxelSpace::view}) {
      TechniqueRun run(test_devices(), s.scene, view, sized(coarse, space), find_technique("voxel_lights"));
      run.run_frame();
      EXPECT_EQ(count_nan_pixels(run.image()), 0u);
      EXPECT_EQ(count_inf_pixels(run.image()), 0u);
      const LitPairs pairs = count_listed_pairs(run, read_depth(run));
      EXPECT_EQ(pairs.wrong, 0u);
      EXPECT_EQ(pairs.lost, 0u);
      const Image before = run.image();
      run.run_frame();
      EXPECT_TRUE(identical(run.image(), before)) << "the next frame";
    }
  }
}

// docs/details/voxel_lights.md#how-it-converges: one light, a diffuse wall, and the bound of the
// interpolation.
TEST(VoxelLights, ErrorFallsWithResolutionToItsBound) {
  SmallScene s = small_scene(false);
  s.scene.instances.resize(1);  // the wall alone
  s.scene.ambient = glm::vec3(0);
  const double candela = 12, radius = 6;
  const glm::dvec3 lamp(0.2, 0.3, -2.2);
  add_point(s.scene, "lamp", glm::vec3(lamp), {1, 1, 1}, float(candela), float(radius));
  const View view = make_view(look_at({1.4, 0.9, 0}, {0.2, 0, -4}), 61, 43);
  Settings settings;
  settings.set(setting::brdf, Brdf::lambert);
  const Image forward = render(s.scene, view, "forward", settings);
  double last = 1e9;
  for (const VoxelSize size : {coarse, VoxelSize::s32x32x8, VoxelSize::s64x64x16, VoxelSize::s128x128x32}) {
    settings.set(setting::voxel_size, size);
    TechniqueRun run(test_devices(), s.scene, view, settings, find_technique("voxel_lights"));
    run.run_frame();
    const Volume volume(run.view());
    const glm::dvec3 h = volume.spacing;
    // The largest second differences over the cells that the wall is in: of irradiance on a surface that
    // faces the light, and of it times the direction. The second is taken as a vector, which bounds its part
    // along the normal.
    const auto field = [&](const glm::dvec3& at) {
      const glm::dvec3 d = lamp - at;
      const double r2 = glm::dot(d, d), e = candela / r2 * std::max(1 - r2 * r2 / std::pow(radius, 4), 0.0);
      return glm::dvec4(d / std::sqrt(r2) * e, e);
    };
    double of_vector = 0, of_weight = 0, brightest = 0;
    for (double x = -1.8; x <= 2.2; x += 0.1) {
      for (double y = -2; y <= 2; y += 0.1) {
        for (const double z : {-4 - h.z, -4.0, -4 + h.z}) {
          double vector = 0, weight = 0;
          for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 step(0);
            step[axis] = 0.01;
            const glm::dvec4 second = (field({x + step.x, y + step.y, z + step.z}) - 2.0 * field({x, y, z}) +
                                       field({x - step.x, y - step.y, z - step.z})) /
                                      1e-4;
            vector += h[axis] * h[axis] / 8 * glm::length(glm::dvec3(second));
            weight += h[axis] * h[axis] / 8 * std::abs(second.w);
          }
          of_vector = std::max(of_vector, vector);
          of_weight = std::max(of_weight, weight);
          brightest = std::max(brightest, field({x, y, z}).w);
        }
      }
    }
    const double grown = glm::dot(h, h) / 4 / (radius * radius);
    const double of_reach =
        brightest * (0.5 + 2) * grown;  // dimmed by sqrt(1 + grown), and a window that ends later
    const double bound = 0.7 / voxel_pi * (of_vector + (of_vector + of_weight) / 4 + of_reach) + 1e-5;
    const double error = compare_images(run.image(), forward).max_abs;
    RecordProperty(fmt::format("error_{}", volume.size().x), fmt::format("{} of {}", error, bound));
    EXPECT_LT(error, bound) << volume.size().x;
    EXPECT_GT(error, bound / 30) << "a bound that says nothing: " << volume.size().x;
    EXPECT_LT(error, 0.5 * last) << volume.size().x;
    last = error;
  }
}

// Six lamps around a ball before a wall: the picture comes near, never there, and less leaks beyond the
// lamps' ranges.
TEST(VoxelLights, AreNearForwardAndLeakIsCounted) {
  const Scene scene = small_scene().scene;
  const View view = small_view(61, 43);
  Settings settings;
  settings.set(setting::brdf, Brdf::lambert);
  const Image forward = render(scene, view, "forward", settings);
  double last = 1e9;
  uint64_t leaked = ~uint64_t(0);
  for (const VoxelSize size : {coarse, VoxelSize::s64x64x16}) {
    settings.set(setting::voxel_size, size);
    const DrawnVoxels d = drawn(scene, view, settings);
    EXPECT_EQ(d.pairs.lost, 0u);
    EXPECT_LT(d.pairs.listed - d.pairs.lit, leaked);
    EXPECT_GT(d.pairs.listed, d.pairs.lit) << "nothing leaks";
    leaked = d.pairs.listed - d.pairs.lit;
    const double error = compare_images(d.image, forward).rmse;
    EXPECT_LT(error, 0.7 * last);
    last = error;
  }
  Scene dark = scene;
  dark.lights.clear();
  // Lamps within a voxel of the ball make most of the error: their light is spread over the voxel.
  EXPECT_LT(last, 0.6 * compare_images(render(dark, view, "forward", settings), forward).rmse)
      << "little better than no lights";
}

// Directional lights, unlit and emissive surfaces and glass are as in forward but for the light of points:
// with lights that reach nothing, the picture is forward's.
TEST(VoxelLights, EverythingElseIsForwards) {
  for (const char* name : {"blend", "unlit", "directional"}) {
    SmallScene s = small_scene();
    effect(name).add(s);
    for (Light& light : s.scene.lights) {
      if (light.type != LightType::directional) light.position.y += 1000;
    }
    const View view = small_view(31, 23);
    EXPECT_LT(
        compare_images(render(s.scene, view, "voxel_lights", sized(coarse)), render(s.scene, view, "forward"))
            .max_rel,
        1e-6)
        << name;
  }
}

// One lamp that reaches all that is seen, shaded by itself: nothing of it is left in the volume, in either
// space, as spot or point; of six lamps, more of them by themselves come nearer to forward.
TEST(VoxelLights, ExactLightsLeaveNothingOfThemselves) {
  const View view = small_view(31, 23);
  for (const bool spot : {false, true}) {
    SmallScene s = small_scene(false);
    if (spot) {
      add_spot(s.scene, "torch", {0.2f, 0.1f, 1}, {0.1f, 0, -4}, {1, 0.8f, 0.6f}, 30, 25, 50, 85);
    } else {
      add_point(s.scene, "lamp", {0.2f, 0.3f, -1}, {1, 0.8f, 0.6f}, 30, 25);
    }
    const Image forward = render(s.scene, view, "forward");
    for (const VoxelSpace space : {VoxelSpace::world, VoxelSpace::view}) {
      Settings settings = sized(coarse, space);
      EXPECT_GT(compare_images(render(s.scene, view, "voxel_lights", settings), forward).max_rel, 1e-3);
      settings.set(setting::voxel_lights_exact, 1);
      EXPECT_LT(compare_images(render(s.scene, view, "voxel_lights", settings), forward).max_rel, 1e-4)
          << spot << ' ' << int(space);
    }
  }
  const Scene six = small_scene().scene;
  const Image forward = render(six, view, "forward");
  double last = 1e9;
  for (const int exact : {0, 1, 4}) {
    Settings settings = sized(VoxelSize::s32x32x8);
    settings.set(setting::voxel_lights_exact, exact);
    const double error = compare_images(render(six, view, "voxel_lights", settings), forward).rmse;
    EXPECT_LT(error, last) << exact;
    last = error;
  }
}

// Triangles and surfaces of OpenCL, opaque and blended: the same light.
TEST(VoxelLights, RasterOfOpenClShowsTheSame) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  const View view = small_view(61, 43);
  Settings settings = sized(VoxelSize::s32x32x8, VoxelSpace::view);
  settings.set(setting::voxel_lights_exact, 1);
  const Image opengl = render(s.scene, view, "voxel_lights", settings);
  settings.set(setting::raster, RasterApi::opencl);
  const DrawnVoxels opencl = drawn(s.scene, view, settings);
  expect_near(opencl.image, opengl);
  EXPECT_EQ(opencl.pairs.lost, 0u);
}

}  // namespace
}  // namespace lightgrid
