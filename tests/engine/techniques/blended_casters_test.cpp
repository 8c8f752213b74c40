// Blended surfaces that cast, with the setting shadow-blended: as opaque ones, or by their alpha, whose
// product along each ray is compared with that in double.
#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "techniques/glazed_stage.h"

namespace lightgrid {
using namespace lab;
namespace {

// Glass whose alpha comes from a texture, before a lamp.
Scene veiled_scene() {
  Scene scene = glazed_scene();
  const int lace = add_material(scene, "speckled", {0.9f, 0.9f, 0.8f}, 0, 0.6f);
  Material& m = scene.materials[size_t(lace)];
  m.base_color.a = 0.8f;
  m.alpha_mode = AlphaMode::blend;
  m.double_sided = true;
  m.base_color_map.texture = add_speckles(scene, true);
  add_instance(scene, "speckled", add_mesh(scene, wall_mesh({0.2f, 0, -3.75f}, 1.2f, lace, "speckled")));
  add_instance(scene, "clear", int(scene.meshes.size()) - 1, placed({0.3, 0.1, 0.2}));
  scene.instances.back().casts_shadow = false;
  return scene;
}

struct Veiled : ShadowStage {
  Veiled() : ShadowStage{veiled_scene(), small_view(glazed_width, glazed_height)} {}
  Occlusion by_alpha{scene, BlendedCasters::alpha}, without{scene, BlendedCasters::none};
};
Veiled& veiled() {
  static auto* made = new Veiled;  // support/devices.h
  return *made;
}

std::unique_ptr<TechniqueRun> veiled_run(const char* technique, const std::string& settings) {
  Settings chosen;
  for (const std::string& setting : {std::string("shadow-blended=alpha"), settings})
    if (!setting.empty()) apply_setting(chosen, setting);
  auto run = std::make_unique<TechniqueRun>(test_devices(), veiled().gpu, veiled().view, chosen,
                                            find_technique(technique));
  run->run_frame();
  return run;
}

// How pairs' shares compare with those in double.
struct Shares {
  size_t right = 0, wrong = 0, partial = 0, undecided = 0;
};

void add_shares(TechniqueRun& run, const HostShadowLayer& layer, Shares& sum) {
  Veiled& stage = veiled();
  const RenderView& v = run.view();
  const std::vector<ViewLight> lights = local_lights(v);
  for (uint32_t p = 0; p < layer.depth.size(); ++p) {
    const glm::ivec2 own = layer.triangles[p];
    if (own.x < 0) continue;
    const int x = int(p) % v.view.width, y = int(p) / v.view.width;
    const Receiver receiver =
        stage.by_alpha.receiver(v.view, x, y, double(layer.depth[p]), {own.x, uint32_t(own.y)});
    for (uint32_t i = 0; i < lights.size(); ++i) {
      const Light& light = v.scene.lights[size_t(v.plan.lights.local[i])];
      if (!light.casts_shadow || !is_lit(lights[i], position_from_depth(v.view, x, y, layer.depth[p])))
        continue;
      const Sight sight = stage.without.sight(light, receiver).sight;
      const Veil veil = sight == Sight::hidden ? Veil{1, 1} : stage.by_alpha.veil(light, receiver);
      if (sight == Sight::either || veil.most - veil.least > 0.5 / 255) {
        ++sum.undecided;
        continue;
      }
      const double share = hidden_share_at(layer.shadows, x, y, i),
                   slack = 0.51 / 255;  // half a step of a byte
      const bool right = share >= veil.least - slack && share <= veil.most + slack;
      sum.right += right;
      sum.wrong += !right;
      sum.partial += right && share > 0.02 && share < 0.98;
    }
  }
}

// The shares of opaque surfaces and of all layers.
Shares shares_of(TechniqueRun& run) {
  HostShadowLayer opaque{run.frame().shadows(), read_depth(run), {}};
  for (const CastingTriangle& t : casting_triangles(run.view().scene, shown_triangles(run)))
    opaque.triangles.emplace_back(t.instance, int(t.triangle));
  Shares sum;
  add_shares(run, opaque, sum);
  for (const HostShadowLayer& layer : run.frame().blended_shadows()) add_shares(run, layer, sum);
  return sum;
}

TEST(BlendedCasters, HideWhatTheProductOfTheirAlphasSays) {
  for (const char* technique : {"visibility", "forward_plus"}) {
    SCOPED_TRACE(technique);
    const auto run = veiled_run(technique, "");
    const Shares shares = shares_of(*run);
    EXPECT_EQ(shares.wrong, 0u);
    EXPECT_GT(shares.partial, 1000u);
    EXPECT_LT(shares.undecided, shares.right / 10);
  }
}

// A product does not depend on the order of triangles, hence not on kernels, trees or packets.
TEST(BlendedCasters, HideTheSameInEachFormOfTheKernels) {
  for (const char* settings : {"", "shadow-rays=4", "shadow-pick=4"}) {
    SCOPED_TRACE(settings);
    const auto run = veiled_run("visibility", settings);
    Settings group = run->view().plan.settings;
    apply_setting(group, "kernel-shape=group");
    TechniqueRun other(test_devices(), veiled().gpu, veiled().view, group, find_technique("visibility"));
    other.run_frame();
    EXPECT_TRUE(identical(other.image(), run->image()));
    EXPECT_EQ(other.frame().shadows().shares, run->frame().shadows().shares);
  }
}

TEST(BlendedCasters, HideAllWhereTheyCountAsOpaque) {
  Veiled& stage = veiled();
  Settings opaque;
  apply_setting(opaque, "shadow-blended=opaque");
  for (const char* technique : {"visibility", "forward_plus"}) {
    SCOPED_TRACE(technique);
    TechniqueRun run(test_devices(), stage.gpu, stage.view, opaque, find_technique(technique));
    run.run_frame();
    EXPECT_TRUE(run.frame().shadows().shares.empty()) << "bits suffice";
    EXPECT_TRUE(exact(stage.pairs(run)));
    EXPECT_TRUE(exact(count_blended_pairs(run, stage.truth).value()));
    EXPECT_LT(stage.pairs(run).lit, stage.pairs(*veiled_run(technique, "")).lit);
  }
}

// Nothing blended casts: not a byte differs from shadow-blended=none.
TEST(BlendedCasters, CostNothingWhereNothingBlendedCasts) {
  Scene scene = glazed_scene();
  for (Instance& i : scene.instances)
    if (scene.materials[size_t(scene.meshes[size_t(i.mesh)].material)].alpha_mode == AlphaMode::blend)
      i.casts_shadow = false;
  const View view = small_view(glazed_width, glazed_height);
  Settings by_alpha;
  apply_setting(by_alpha, "shadow-blended=alpha");
  TechniqueRun none(test_devices(), scene, view, {}, find_technique("visibility")),
      alpha(test_devices(), scene, view, by_alpha, find_technique("visibility"));
  none.run_frame();
  alpha.run_frame();
  EXPECT_TRUE(identical(none.image(), alpha.image()));
  EXPECT_FALSE(alpha.view().plan.shadows.bytes);
  EXPECT_EQ(alpha.view().shadows.bytes(), none.view().shadows.bytes());
}

struct VeilFault {
  const char *name, *right, *wrong;
};

struct FaultyVeils : testing::TestWithParam<VeilFault> {};

TEST_P(FaultyVeils, AreFound) {
  const VeilFault& fault = GetParam();
  int planted = 0;
  const auto renderer = faulty_renderer(fault.right, fault.wrong, planted);
  GpuScene gpu(*renderer, veiled().scene);
  Settings settings;
  apply_setting(settings, "shadow-blended=alpha");
  TechniqueRun run(*renderer, gpu, veiled().view, settings, find_technique("visibility"));
  run.run_frame();
  EXPECT_GT(planted, 0) << "no kernel has this text";
  EXPECT_GT(shares_of(run).wrong, 20u);
}

INSTANTIATE_TEST_SUITE_P(
    Planted, FaultyVeils,
    testing::Values(VeilFault{"of_lanes_that_miss", "(met ? veil : (whole)(0))", "veil"},
                    VeilFault{"of_the_greatest", "p->veil + (met ? veil : (whole)(0))",
                              "max(p->veil, met ? veil : (whole)(0))"},
                    VeilFault{
                        "without_texture",
                        "return alpha * bilinear_alpha(s->alphas + m->alpha_base, f) * (1.0f / 255.0f);",
                        "return alpha;"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lightgrid
