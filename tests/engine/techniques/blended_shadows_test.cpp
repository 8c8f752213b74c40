// Shadows on blended surfaces, in every technique: each pair of a fragment and a light against the oracle,
// and the picture in double.
#include "plan/settings/kernels.h"
#include "plan/settings/surfaces.h"
#include "techniques/blended_in_double.h"
#include "techniques/glazed_stage.h"

namespace lightgrid {
namespace {

constexpr double own_bound =
    5e-3;  // of pictures of OpenCL's surfaces, as opaque ones have it (shadow_test.cpp)

struct Glazed : ShadowStage {
  Glazed() : ShadowStage{glazed_scene(), small_view(glazed_width, glazed_height)} {}
};
Glazed& glazed() {
  static auto* made = new Glazed;  // support/devices.h
  return *made;
}

// Pairs of all layers by the oracle, and how many of them are hidden.
struct BlendedPairs {
  LitPairs pairs;
  uint64_t hidden = 0;
  size_t layers = 0;
};

BlendedPairs blended_pairs(Glazed& stage, TechniqueRun& run) {
  BlendedPairs all{.pairs = count_blended_pairs(run, stage.truth).value()};
  for (const HostShadowLayer& layer : run.frame().blended_shadows()) {
    const auto seen = stage.truth.of_layer(run.view(), layer);
    ++all.layers;
    for (uint32_t pixel = 0; pixel < layer.depth.size(); ++pixel) {
      for (uint32_t light = 0; light < run.view().plan.lights.local.size(); ++light)
        all.hidden += seen->at(pixel, light) == Sight::hidden;
    }
  }
  return all;
}

struct BlendedShadows : testing::TestWithParam<ShadowWay> {};

// Errors of pictures are those of the same techniques on opaque surfaces (shadow_test.cpp).
TEST_P(BlendedShadows, AreTheOraclesInEachPairAndInThePicture) {
  const auto [technique, raster] = GetParam();
  Glazed& stage = glazed();
  const Settings settings{{setting::raster, raster}};
  TechniqueRun run(test_devices(), stage.gpu, stage.view, settings, *technique);
  run.run_frame();
  const BlendedPairs found = blended_pairs(stage, run);
  EXPECT_GE(found.layers, 4u);
  EXPECT_TRUE(exact(found.pairs));
  EXPECT_GT(found.hidden, 1000u);
  EXPECT_LT(double(found.pairs.either), 0.02 * double(found.pairs.lit));
  if (technique->approximate) return;  // another picture
  const BlendedInDouble in_double = blended_in_double(run, stage.truth);
  EXPECT_GT(in_double.pixels.size(), glazed_width * glazed_height / 10);
  EXPECT_LT(in_double.left_out, in_double.pixels.size() / 5);
  EXPECT_LT(worst_error(run.image(), in_double), own_surfaces(*technique, settings) ? own_bound : 2e-4);
}

INSTANTIATE_TEST_SUITE_P(Techniques, BlendedShadows, testing::ValuesIn(shadow_ways()), [](const auto& info) {
  return info.param.technique->name + std::string(info.param.raster == RasterApi::opencl ? "_opencl" : "");
});

// settings: KEY=VALUE each.
std::unique_ptr<TechniqueRun> glazed_run(const char* technique, const std::vector<std::string>& settings) {
  Glazed& stage = glazed();
  Settings chosen;
  for (const std::string& setting : settings) apply_setting(chosen, setting);
  auto run = std::make_unique<TechniqueRun>(test_devices(), stage.gpu, stage.view, chosen,
                                            find_technique(technique));
  run->run_frame();
  return run;
}

// Kernels for GPUs, everything's code.
TEST(BlendedShadowBits, AreTheSameUnderEverySetting) {
  const auto run = glazed_run("visibility", {});
  const std::vector<HostShadowLayer> layers = run->frame().blended_shadows();
  for (const std::vector<std::string>& settings : std::vector<std::vector<std::string>>{
           {"kernel-shape=group"}, {"everything-on=on"}, {"shadow-reuse=on"}}) {
    SCOPED_TRACE(settings[0]);
    const auto other = glazed_run("visibility", settings);
    EXPECT_TRUE(identical(other->image(), run->image()));
    const std::vector<HostShadowLayer> others = other->frame().blended_shadows();
    ASSERT_EQ(others.size(), layers.size());
    for (size_t i = 0; i < layers.size(); ++i) {
      EXPECT_TRUE(same_bits(others[i].shadows, layers[i].shadows));
      EXPECT_EQ(others[i].depth, layers[i].depth);
    }
  }
}

// A view shows the same after the camera and the glass moved as a new one does.
TEST(BlendedShadowBits, FollowTheSceneAndTheCamera) {
  for (const char* technique : {"forward_plus", "visibility"}) {
    SCOPED_TRACE(technique);
    Glazed stage;
    TechniqueRun run(test_devices(), stage.gpu, stage.view, {}, find_technique(technique));
    run.run_frame();
    stage.scene.instances.back().world_from_object = placed({-0.5, -0.1, -3.0});
    const SceneChanges changes{.instances = {int(stage.scene.instances.size()) - 1}};
    stage.gpu.update(changes);
    run.look(make_view(look_at({0.4, 0.2, 0.1}, {0, 0, -4}), 49, 70), changes);
    run.run_frame();
    TechniqueRun own(test_devices(), stage.scene, run.view().view, {}, find_technique(technique));
    own.run_frame();
    EXPECT_TRUE(identical(run.image(), own.image()));
    EXPECT_EQ(run.frame().shadow_figures().rays, own.frame().shadow_figures().rays);
  }
}

// Layers are cleared only where the last frame wrote to them: cameras that see the glass elsewhere,
// everywhere and not at all, with a size that changes between.
TEST(BlendedShadowBits, HoldNothingOfEarlierFrames) {
  Glazed& stage = glazed();
  for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
    SCOPED_TRACE(int(shape));
    const Settings settings{{setting::kernel_shape, shape}};
    TechniqueRun run(test_devices(), stage.gpu, stage.view, settings, find_technique("visibility"));
    size_t fragments = 0;
    for (const auto& [eye, target, width] :
         std::initializer_list<std::tuple<glm::dvec3, glm::dvec3, int>>{{{0, 0, 0}, {0, 0, -4}, 150},
                                                                        {{0.8, 0, 0}, {1.6, 0, -4}, 150},
                                                                        {{-0.8, 0, -1}, {-0.4, 0, -4}, 150},
                                                                        {{0, 0, 0}, {0, 3, -1}, 150},
                                                                        {{0, 0, 0}, {0, 0, -4}, 70},
                                                                        {{0.8, 0, 0}, {1.6, 0, -4}, 70},
                                                                        {{0, 0, 2}, {0, 0, -4}, 150}}) {
      run.look(make_view(look_at(eye, target), width, 90), {});
      run.run_frame();
      TechniqueRun own(test_devices(), stage.gpu, run.view().view, settings, find_technique("visibility"));
      own.run_frame();
      EXPECT_TRUE(identical(run.image(), own.image()));
      const auto layers = run.frame().blended_shadows(), others = own.frame().blended_shadows();
      for (size_t i = 0; i < others.size(); ++i) {
        ASSERT_LT(i, layers.size());
        EXPECT_EQ(layers[i].depth, others[i].depth) << i;
        fragments += size_t(std::ranges::count_if(others[i].depth, [](float d) { return d > 0; }));
      }
    }
    EXPECT_GT(fragments, 10000u);
  }
}

// Without a blended surface in view no layer is looked for, and nothing is kept for one.
TEST(BlendedShadowBits, CostNothingWithoutBlendedSurfacesInView) {
  for (const char* technique : {"forward_plus", "visibility"}) {
    SCOPED_TRACE(technique);
    Scene scene = glazed_scene();
    for (Material& m : scene.materials)
      if (m.alpha_mode == AlphaMode::blend) m.alpha_mode = AlphaMode::opaque;
    TechniqueRun run(test_devices(), scene, small_view(glazed_width, glazed_height), {},
                     find_technique(technique));
    run.view().timer.enabled = true;
    run.run_frame();
    for (const PassRecord& pass : run.view().timer.records()) EXPECT_NE(pass.name, "blended_layers");
    EXPECT_EQ(run.view().shadows.layers.bytes(), 0u);
    EXPECT_TRUE(run.frame().blended_shadows().empty());
  }
}

// Faults planted into the kernels' text are found, in pairs or in the picture.
struct LayerFault {
  const char *name, *right, *wrong;
  bool in_pairs;
};

struct FaultyLayers : testing::TestWithParam<LayerFault> {};

TEST_P(FaultyLayers, AreFound) {
  const LayerFault& fault = GetParam();
  int planted = 0;
  const auto renderer = faulty_renderer(fault.right, fault.wrong, planted);
  Glazed& stage = glazed();
  GpuScene gpu(*renderer, stage.scene);
  TechniqueRun run(*renderer, gpu, stage.view, {}, find_technique("visibility"));
  run.run_frame();
  EXPECT_GT(planted, 0) << "no kernel has this text";
  const LitPairs pairs = count_blended_pairs(run, stage.truth).value();
  EXPECT_EQ(pairs.leaked + pairs.acned > 0, fault.in_pairs);
  EXPECT_GT(worst_error(run.image(), blended_in_double(run, stage.truth)), own_bound);
}

INSTANTIATE_TEST_SUITE_P(
    Planted, FaultyLayers,
    testing::Values(LayerFault{"own_triangle_is_opaque", "if (!r->own_hides) return (mask_t)(0);", "", true},
                    LayerFault{"first_layer_for_all", "(size_t)(layer + 1) * here->layer_words",
                               "here->layer_words", false},
                    LayerFault{"fragments_uncounted",
                               "vstore16(convert_ushort16(layer - shown), block, counts->of);", "", false},
                    LayerFault{"entries_of_opaque_surfaces", "here->y = number", "here->y = i", false}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lightgrid
