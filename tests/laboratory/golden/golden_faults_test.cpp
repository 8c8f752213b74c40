// Faults planted into the text of kernels are found by hashes, in the stage that the kernel belongs to.
#include <gtest/gtest.h>

#include "golden/golden.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

struct KernelFault {
  const char* name;
  const char* right;  // text of kernels for CPUs
  const char* wrong;
  const char* stage;
};

std::vector<KernelFault> kernel_faults() {
  return {
      {"corners_a_16th_of_a_pixel_to_the_right", "lane_rint(live ? sx : zero)",
       "lane_rint(live ? sx + (real)(16.0f) : zero)", "triangles"},
      {"depth_bias", "out->zx = zx;", "out->zx = zx; out->z0 *= (real)(0.99999f);", "depth"},
      {"last_light_of_a_list_lost", "(uint2)(first, n)", "(uint2)(first, max(n, 1u) - 1)", "lists"},
      {"brighter_by_a_thousandth", "real falloff = inverse_distance * inverse_distance;",
       "real falloff = inverse_distance * inverse_distance * REAL(1.001f);", "radiance"},
  };
}

GoldenView view_of(const Scene& scene, const ProgramCache::Alter& alter) {
  Renderer renderer(test_device_name(), GlBackend::none);
  renderer.kernels->alter(alter);
  TechniqueRun run(renderer, scene, small_view(97, 71), {}, find_technique("visibility"));
  run.run_frame();
  return golden_view(golden_pixels(run));
}

TEST(GoldenFaults, InKernelsNameTheirStage) {
  if (!opencl_devices().cl->info().cpu) GTEST_SKIP() << "the faults are of kernels for CPUs";
  const Scene scene = small_scene().scene;
  const GoldenView right = view_of(scene, {});
  EXPECT_FALSE(first_difference(right, view_of(scene, [](std::string text) { return text; })));
  for (const KernelFault& fault : kernel_faults()) {
    int planted = 0;
    const auto found =
        first_difference(right, view_of(scene, [&](std::string text) {
                           const size_t at = text.find(fault.right);
                           if (at == std::string::npos) return text;
                           ++planted;
                           return text.replace(at, std::string(fault.right).size(), fault.wrong);
                         }));
    EXPECT_GT(planted, 0) << fault.name << ": no kernel has this text";
    ASSERT_TRUE(found) << fault.name;
    EXPECT_STREQ(golden_stages[found->stage], fault.stage) << fault.name;
  }
}

}  // namespace
}  // namespace lightgrid::lab
