// voxel_lights: what its volume holds: one light by hand, the same bytes of both kernel shapes, memory,
// reuse.
#include "passes/voxels/voxel_settings.h"
#include "plan/settings/kernels.h"
#include "plan/settings/surfaces.h"
#include "scene/random.h"
#include "techniques/voxel_volume.h"

namespace lightgrid {
namespace {

// A lamp of 10 cd and 8 m on a sample, seen from the next one: 10 / spacing^2 (1 - (spacing / 8)^4), but for
// the growth of its reach; at its own sample the mean of 1 / distance^2 over a ball as large as a voxel.
TEST(VoxelLights, EnergyOfOneLightByHand) {
  SmallScene s = small_scene(false);
  s.scene.ambient = glm::vec3(0);
  const View view = small_view(33, 21);
  TechniqueRun run(test_devices(), s.scene, view, sized(coarse), find_technique("voxel_lights"));
  add_point(s.scene, "lamp", {0, 0, -3}, {1, 1, 1}, 10, 8);
  TechniqueRun first(test_devices(), s.scene, view, sized(coarse), find_technique("voxel_lights"));
  first.run_frame();
  const Volume placed(first.view());
  s.scene.lights[0].position = placed.position({8, 8, 2});  // the box does not depend on lights
  TechniqueRun second(test_devices(), s.scene, view, sized(coarse), find_technique("voxel_lights"));
  second.run_frame();
  const Volume volume(second.view());
  ASSERT_EQ(volume.first, placed.first);
  const double h = volume.spacing.x, voxel = volume.spacing.x * volume.spacing.y * volume.spacing.z;
  const double reach_squared = 64 + glm::dot(volume.spacing, volume.spacing) / 4,
               dimmed = 8 / std::sqrt(reach_squared);
  const double beside = 10 * dimmed / (h * h) * (1 - std::pow(h * h / reach_squared, 2));
  EXPECT_NEAR(volume.read.irradiance[volume.index({9, 8, 2})].r, beside, 1e-5 * beside);
  EXPECT_NEAR(volume.directions(volume.index({9, 8, 2})).x, -beside, 1e-5 * beside);
  const double own = 10 * dimmed * 3 / std::pow(voxel * 3 / (4 * voxel_pi), 2.0 / 3);
  EXPECT_NEAR(volume.read.irradiance[volume.index({8, 8, 2})].r, own, 1e-5 * own);
  EXPECT_EQ(volume.directions(volume.index({8, 8, 2})), glm::dvec3(0));
  EXPECT_NEAR(volume.read.directions[volume.index({8, 8, 2})].w, own, 1e-5 * own);
  EXPECT_EQ(volume.read.irradiance[volume.index({8, 8, 2})].w, 1);
}

Scene fuzzed(uint64_t seed) {
  Random random(seed);
  SmallScene s = small_scene(false);
  for (int i = 0; i < 150; ++i) {
    const glm::vec3 at(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-6, 0));
    const float radius = 0.05f * std::exp2(random.uniform(0, 7));
    const glm::vec3 color(random.uniform(), random.uniform(), random.uniform());
    if (i % 4 != 0) {
      add_point(s.scene, "lamp", at, color, radius * radius, radius);
      continue;
    }
    const glm::vec3 target = at + glm::vec3(any_direction(random));
    const float outer = random.uniform(2, 80);
    add_spot(s.scene, "torch", at, target, color, radius * radius, radius, random.uniform(0, outer), outer);
  }
  return s.scene;
}

// Kernels for CPUs and GPUs, and fewer bits.
TEST(VoxelLights, BothShapesFillTheSameBytes) {
  Scene scene = fuzzed(4);
  std::erase_if(scene.lights, [](const Light& light) { return light.type == LightType::spot; });
  const View view = small_view(31, 23);
  Settings settings = sized(VoxelSize::s32x32x8);
  const auto volume = [&](KernelShape shape, int bits) {
    settings.set(setting::kernel_shape, shape);
    apply_setting(settings, "voxel-bits=" + std::to_string(bits));
    TechniqueRun run(test_devices(), scene, view, settings, find_technique("voxel_lights"));
    run.run_frame();
    return read_voxels(run.view(), run.view().caches.voxels);
  };
  const ReadVoxels lanes = volume(KernelShape::lanes, 32), group = volume(KernelShape::group, 32),
                   half = volume(KernelShape::lanes, 16);
  float brightest = 0;
  size_t differ = 0;
  double apart = 0;
  for (size_t i = 0; i < lanes.irradiance.size(); ++i) {
    differ += lanes.irradiance[i] != group.irradiance[i] || lanes.directions[i] != group.directions[i];
    brightest = std::max(brightest, lanes.irradiance[i].r);
    apart = std::max(apart, std::abs(double(lanes.irradiance[i].r) - half.irradiance[i].r) /
                                std::max(double(lanes.irradiance[i].r), 1e-3));
  }
  EXPECT_EQ(differ, 0u);
  EXPECT_GT(brightest, 1);
  EXPECT_GT(apart, 0);
  EXPECT_LE(apart, 0x1p-11 * 1.01);
}

// More groups of lights than a work-group tests at once, and more lights at a sample than it keeps at once.
TEST(VoxelLights, BothShapesFillTheSameBytesUnderThousandsOfLights) {
  Random random(9);
  SmallScene s = small_scene(false);
  for (int i = 0; i < 9000; ++i) {
    const glm::vec3 at(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-5, -1));
    const glm::vec3 color(random.uniform(), random.uniform(), random.uniform());
    const float radius = i % 3 == 0 ? 1.5f : 0.1f;
    if (i % 5 > 0) {
      add_point(s.scene, "lamp", at, color, radius * radius, radius);
    } else {
      add_spot(s.scene, "torch", at, at + glm::vec3(any_direction(random)), color, radius, radius, 20, 40);
    }
  }
  for (const VoxelSpace space : {VoxelSpace::world, VoxelSpace::view}) {
    Settings settings = sized(coarse, space);
    const auto volume = [&](KernelShape shape) {
      settings.set(setting::kernel_shape, shape);
      TechniqueRun run(test_devices(), s.scene, small_view(31, 23), settings, find_technique("voxel_lights"));
      run.run_frame();
      return read_voxels(run.view(), run.view().caches.voxels);
    };
    const ReadVoxels lanes = volume(KernelShape::lanes), group = volume(KernelShape::group);
    float most = 0;
    size_t differ = 0;
    for (size_t i = 0; i < lanes.irradiance.size(); ++i) {
      differ += lanes.irradiance[i] != group.irradiance[i] || lanes.directions[i] != group.directions[i];
      most = std::max(most, lanes.irradiance[i].w / lanes.placed.lookup.inverse_scale);
    }
    EXPECT_EQ(differ, 0u);
    EXPECT_GT(most, 2.0f * VOXEL_GROUP_ITEMS) << "lights at a sample";
  }
}

// docs/techniques/voxel_lights.md#what-it-costs: 32 bytes per sample, 16 in 16 bits, and as much in OpenGL if
// that draws; a slice has a record of 16 bytes.
TEST(VoxelLights, TakesTheMemoryThatItsPageSays) {
  const Scene scene = small_scene().scene;
  const View view = small_view(31, 23);
  const size_t samples = 32 * 32 * 8 - 16 * 16 * 4, slices = 8 - 4;
  for (const RasterApi raster : {RasterApi::opengl, RasterApi::opencl}) {
    for (const int bits : {32, 16}) {
      const auto bytes = [&](VoxelSize size) {
        Settings settings = sized(size);
        settings.set(setting::raster, raster);
        apply_setting(settings, "voxel-bits=" + std::to_string(bits));
        TechniqueRun run(test_devices(), scene, view, settings, find_technique("voxel_lights"));
        run.run_frame();
        return run.result().memory_total;
      };
      const size_t copies = raster == RasterApi::opengl ? 2 : 1;
      EXPECT_EQ(bytes(VoxelSize::s32x32x8) - bytes(coarse), samples * size_t(bits) * copies + slices * 16)
          << bits;
    }
  }
}

TEST(VoxelLights, ReuseShowsTheSameAndFillsAfterAChange) {
  SmallScene s = small_scene();
  Settings settings = sized(coarse), keeping = settings;
  apply_setting(keeping, "voxel-reuse=on");
  GpuScene gpu(test_devices(), s.scene);
  TechniqueRun run(test_devices(), gpu, small_view(31, 23), keeping, find_technique("voxel_lights"));
  const auto fills = [&] {
    run.view().timer.clear();
    run.view().timer.enabled = true;
    run.run_frame();
    run.view().timer.enabled = false;
    return std::ranges::count(run.view().timer.records(), std::string("build_voxels"), &PassRecord::name);
  };
  EXPECT_EQ(fills(), 1);
  EXPECT_EQ(fills(), 0);
  EXPECT_TRUE(identical(run.image(), render(s.scene, small_view(31, 23), "voxel_lights", settings)));
  s.scene.lights[2].position.x += 0.25;
  run.look(small_view(31, 23), {.lights = {2}});
  EXPECT_EQ(fills(), 1);
  EXPECT_TRUE(identical(run.image(), render(s.scene, small_view(31, 23), "voxel_lights", settings)));
}

}  // namespace
}  // namespace lightgrid
