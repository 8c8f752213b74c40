// lidr's own ways of shadows (docs/techniques/lidr.md#shadows): their pairs by the oracle, and pictures that
// differ from one with exact shadows only where a pair is wrong.
#include <map>

#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "plan/settings/shadows.h"
#include "support/error_of.h"
#include "techniques/shadow_stage.h"

namespace lightgrid::lab {
namespace {

constexpr double other_order = 1e-5;  // sums of a few lights

ShadowStage& stage() {
  static ShadowStage* const made = new ShadowStage{shadowed_scene(), small_view(131, 77)};
  return *made;
}

struct Way {
  explicit Way(const std::vector<std::string>& assignments, ShadowStage& on = stage()) {
    Settings settings;
    for (const std::string& assignment : assignments) apply_setting(settings, assignment);
    run.emplace(test_devices(), on.gpu, on.view, settings, find_technique("lidr"));
    run->run_frame();
    pairs = on.pairs(*run);
  }
  mutable std::optional<TechniqueRun> run;
  LitPairs pairs;
  uint64_t wrong() const { return pairs.leaked + pairs.acned; }
  HostShadows shadows() const { return run->frame().shadows(); }

  static const Way& exact() {
    static const Way* const made = new Way({});
    return *made;
  }
};

// At pixels without a leaked, acned or lost pair, the picture is that of exact shadows.
testing::AssertionResult explained_by_pairs(const Way& way) {
  const Image &image = way.run->image(), &exact = Way::exact().run->image();
  const float brightest = brightest_channel(exact);
  size_t right = 0, wrong = 0;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    if (way.pairs.leaked_of_pixel[i] + way.pairs.acned_of_pixel[i] + way.pairs.lost_of_pixel[i] > 0) continue;
    double apart = 0;
    for (int c = 0; c < 3; ++c)
      apart = std::max(apart, std::abs(double(image.pixels[i][c]) - double(exact.pixels[i][c])));
    ++(apart <= other_order * brightest ? right : wrong);
  }
  if (wrong == 0 && right > image.pixels.size() / 2) return testing::AssertionSuccess();
  return testing::AssertionFailure() << fmt::format("{} pixels are another picture's, {} are not", wrong,
                                                    right);
}

// Pairs that a light may reach, of which OpenGL and OpenCL find another share.
struct Agreement {
  size_t pairs = 0, other = 0, hidden = 0;
};
Agreement agreement(const HostShadows& in_gl, const HostShadows& in_cl, double step) {
  Agreement a;
  const View& view = stage().view;
  const std::vector<float> depth = read_depth(*Way::exact().run);
  const std::vector<ViewLight> lights = local_lights(Way::exact().run->view());
  for (uint32_t pixel = 0; pixel < depth.size(); ++pixel) {
    if (depth[pixel] == 0) continue;
    const int x = int(pixel) % view.width, y = int(pixel) / view.width;
    const glm::dvec3 at = position_from_depth(view, x, y, depth[pixel]);
    for (const uint32_t light : lit_lights(lights, at)) {
      const double gl = hidden_share_at(in_gl, x, y, light), cl = hidden_share_at(in_cl, x, y, light);
      ++a.pairs;
      a.other += std::abs(gl - cl) > step;
      a.hidden += cl > 0.5;
    }
  }
  return a;
}

// But for rounding: a few pairs lie so near a texel's edge, or its distance, that either answer is right.
TEST(LidrShadows, MapsAnswerInOpenGlAsInOpenCl) {
  for (const auto& [bits, filter] : std::map<std::string, std::string>{{"16", "pcf3"}, {"32", "none"}}) {
    const std::string of_bits = "shadow-bits=" + bits, of_filter = "shadow-filter=" + filter;
    const HostShadows in_cl = Way({"shadows=map", of_bits, of_filter}).shadows();
    const HostShadows in_gl = Way({"lidr-shadows=final", "lidr-maps=256", of_bits, of_filter}).shadows();
    const Agreement a = agreement(in_gl, in_cl, 0.5 / 255);
    EXPECT_GT(a.hidden, 500u);
    EXPECT_LT(double(a.other), 1e-3 * double(a.pairs)) << bits << " " << a.other << " of " << a.pairs;
  }
}

TEST(LidrShadows, OfMapsInThePrepassAreFewWrongAndFewerInLargerMaps) {
  for (const char* volumes : {"lidr-volumes=stencil", "lidr-volumes=front-faces"}) {
    uint64_t last = Way::exact().pairs.lit / 5;
    for (const char* size : {"shadow-size=16", "shadow-size=64", "shadow-size=256"}) {
      const Way way({"lidr-shadows=prepass", size, volumes});
      EXPECT_GT(way.wrong(), 0u) << size;
      EXPECT_LT(way.wrong(), last) << size << volumes;
      last = way.wrong();
      EXPECT_EQ(way.pairs.lost + way.pairs.wrong, 0u);
      EXPECT_TRUE(explained_by_pairs(way)) << size << volumes;
      if (volumes[13] == 's') {
        EXPECT_LT(way.pairs.listed, Way::exact().pairs.listed) << "hidden lights take no slot";
      }
    }
  }
}

// The masked fence hides light whole. Other pairs are wrong only by the rounding of grazing rays: less than
// one in a thousand.
TEST(LidrShadows, OfVolumesAreExactButForMasks) {
  const Way way({"lidr-shadows=volumes"});
  EXPECT_EQ(way.pairs.lost + way.pairs.wrong, 0u);
  EXPECT_LT(double(way.pairs.leaked), 1e-3 * double(way.pairs.lit));
  EXPECT_TRUE(explained_by_pairs(way));
  static ShadowStage* const unmasked = [] {
    Scene scene = shadowed_scene();
    for (Material& material : scene.materials)
      if (material.alpha_mode == AlphaMode::mask) material.alpha_mode = AlphaMode::opaque;
    return new ShadowStage{scene, stage().view};
  }();
  const Way whole({"lidr-shadows=volumes"}, *unmasked);
  EXPECT_LT(double(whole.wrong()), 1e-3 * double(whole.pairs.lit))
      << whole.pairs.leaked << " " << whole.pairs.acned;
  EXPECT_LT(whole.wrong(), way.wrong());
  Camera camera = look_at({0.3, 0.2, 0}, {0, 0, -4});
  camera.orthographic = true;
  camera.half_width_m = 2;
  camera.half_height_m = 1.2;
  camera.far_m = 20;
  static ShadowStage* const parallel = new ShadowStage{unmasked->scene, make_view(camera, 131, 77)};
  const Way from_afar({"lidr-shadows=volumes"}, *parallel);
  EXPECT_LT(double(from_afar.wrong()), 1e-3 * double(from_afar.pairs.lit));
  const Way by_maps({"lidr-shadows=prepass"}, *parallel);
  EXPECT_LT(double(by_maps.wrong()), 0.05 * double(by_maps.pairs.lit));
  EXPECT_GT(by_maps.wrong(), from_afar.wrong());
}

TEST(LidrShadows, OfVolumesAreRefusedWithFrontFaces) {
  EXPECT_EQ(
      std::string(error_of([&] {
        Way({"lidr-shadows=volumes", "lidr-volumes=front-faces"});
      })),
      "lidr: shadow volumes mark opaque surfaces, but lidr-volumes=front-faces lists lights for all that "
      "lies before them; use lidr-volumes=stencil, or lidr-shadows=prepass");
}

// None: every hidden pair is lit, and each light is told.
TEST(LidrShadows, AreToldWhereTheyAreLeftOut) {
  const auto left_out = [](const Way& way) {
    size_t count = 0;
    const FrameFigures result = way.run->result();
    for (const auto& light : result.shadows->skipped)
      count += light.why == "has a shadow that this setting leaves out";
    return count;
  };
  const Way none({"lidr-shadows=none"}), one({"lidr-shadows=final", "lidr-maps=1"}),
      four({"lidr-shadows=final", "lidr-maps=4"}), all({"lidr-shadows=final", "lidr-maps=16"});
  const size_t casting = Way::exact().run->frame().shadow_figures().lights - 1;  // without the sun
  EXPECT_EQ(left_out(none), casting);
  EXPECT_EQ(left_out(one), casting - 1);
  EXPECT_EQ(left_out(four), casting - 4);
  EXPECT_EQ(left_out(all), 0u);
  EXPECT_GT(none.pairs.leaked, one.pairs.leaked);
  EXPECT_GT(one.pairs.leaked, four.pairs.leaked);
  EXPECT_GT(four.pairs.leaked, all.pairs.leaked);
  EXPECT_EQ(none.pairs.acned, 0u);
  for (const Way* way : {&none, &one, &four, &all}) {
    EXPECT_TRUE(explained_by_pairs(*way));
    EXPECT_EQ(way->pairs.lost + way->pairs.wrong, 0u);
    EXPECT_TRUE(way->run->approximate());
  }
}

// A share of 15 steps is off by half of one: each light by 1/30 of what it adds.
TEST(LidrShadows, SharesBesideIndicesAreThoseOfMapsToHalfAStep) {
  const std::string filter = "shadow-filter=pcf3";
  const std::string of_sun = "shadows=map";  // by its maps in all of them
  const Way in_pass({of_sun, filter}), unhidden({of_sun, filter, "lidr-shadows=none"});
  for (const char* packing : {"lidr-packing=bitshift", "lidr-packing=sort"}) {
    for (const char* volumes : {"lidr-volumes=stencil", "lidr-volumes=front-faces"}) {
      if (packing[13] == 's' && volumes[13] == 'f') continue;  // too few groups
      SCOPED_TRACE(std::string(packing) + volumes);
      const Way soft({of_sun, "lidr-shadows=prepass-soft", filter, packing, volumes});
      EXPECT_EQ(soft.pairs.wrong, 0u);
      if (packing[13] == 'b') {
        EXPECT_EQ(soft.pairs.lost, 0u);
      }
      const Agreement a = agreement(soft.shadows(), in_pass.shadows(), 1.0 / 30 + 1.0 / 255);
      EXPECT_LT(double(a.other), 1e-3 * double(a.pairs));
      const Image &image = soft.run->image(), &expected = in_pass.run->image(), &lit = unhidden.run->image();
      size_t apart = 0, between = 0;
      for (size_t i = 0; i < image.pixels.size(); ++i) {
        const double g = image.pixels[i].g, e = expected.pixels[i].g, l = lit.pixels[i].g;
        apart += std::abs(g - e) > l / 30 + 1e-5;
        between += e < 0.95 * l && std::abs(g - e) > 1e-4 * l;
      }
      EXPECT_LT(apart, image.pixels.size() / 200);
      EXPECT_GT(between, 50u) << "shares are rounded somewhere";
    }
  }
}

TEST(LidrShadows, SharesNeedRoom) {
  for (const auto& [settings, message] : std::map<std::vector<std::string>, std::string>{
           {{"lidr-packing=maxblend", "lidr-lights=255"},
            "lidr: no images hold maxblend, 1 overlap of 255 lights with 4 bits of shadow: the greatest and "
            "least index of two lights leave no bits for shares; use lidr-packing=bitshift"},
           {{"lidr-overlap=16", "lidr-lights=255"},
            "lidr: no images hold bitshift, 16 overlaps of 255 lights with 4 bits of shadow: it takes 6 "
            "targets of 4 channels, and 4 is the most; use lidr-overlap=8"}}) {
    std::vector<std::string> all = settings;
    all.push_back("lidr-shadows=prepass-soft");
    EXPECT_EQ(std::string(error_of([&] { Way{all}; })), message);
  }
}

// A run after a change shows the same as a run that begins with it, and a camera that moves builds
// nothing.
TEST(LidrShadows, FollowEveryChange) {
  for (const LidrShadows way : {LidrShadows::volumes, LidrShadows::final_pass}) {
    SCOPED_TRACE(int(way));
    const Settings settings{{setting::lidr_shadows, way}};
    ShadowStage moving{shadowed_scene(), small_view(61, 37)};
    TechniqueRun run(test_devices(), moving.gpu, moving.view, settings, find_technique("lidr"));
    run.prepare();
    run.run_frame();
    Image before = run.image();
    const auto expect_new = [&](const char* change) {
      run.run_frame();
      TechniqueRun own(test_devices(), moving.scene, run.view().view, settings, find_technique("lidr"));
      own.run_frame();
      EXPECT_TRUE(identical(run.image(), own.image())) << change;
      EXPECT_FALSE(same_bytes(run.image(), before)) << change;
      before = run.image();
    };
    const RendererCounts counts = test_devices().counts();
    run.look(make_view(look_at({0.5, 0.3, 0.2}, {0, 0, -4}), 61, 37));
    run.run_frame();
    EXPECT_EQ(test_devices().counts().gl_programs, counts.gl_programs);
    EXPECT_EQ(test_devices().counts().cl_programs, counts.cl_programs);
    expect_new("the camera moved");
    const auto changed = [&](const SceneChanges& changes) {
      moving.gpu.update(changes);
      run.look(run.view().view, changes);
    };
    moving.scene.lights[2].position += glm::dvec3(0.2, 0.1, 0);
    changed({.lights = {2}});
    expect_new("a light moved");
    moving.scene.instances[1].world_from_object = placed({-0.4, 0.3, -3.1});
    changed({.instances = {1}});
    expect_new("an instance moved");
  }
}

// Where the sun's shadows are those of the frame before, other views have drawn into the shared images since.
TEST(LidrShadows, AreThoseOfTheirViewWhereTheSunsAreReused) {
  Settings settings{{setting::lidr_shadows, LidrShadows::final_pass}};
  apply_setting(settings, "lidr-maps=256");
  apply_setting(settings, "shadow-reuse=on");
  const auto pool = std::make_shared<TargetPool>();
  const View elsewhere = make_view(look_at({0.5, 0.3, 0.2}, {0, 0, -4}), 131, 77);
  TechniqueRun run(test_devices(), stage().gpu, stage().view, settings, find_technique("lidr"), pool),
      other(test_devices(), stage().gpu, elsewhere, settings, find_technique("lidr"), pool);
  run.run_frame();
  const Image first = run.image();
  other.run_frame();
  run.run_frame();
  EXPECT_TRUE(identical(run.image(), first));
}

// Blended casters are in maps whole, or not at all.
TEST(LidrShadows, MapsHaveBlendedCastersOnlyIfTheyAreOpaque) {
  static ShadowStage* const blended_fence = [] {
    Scene scene = shadowed_scene();
    for (Material& material : scene.materials)
      if (material.alpha_mode == AlphaMode::mask) material.alpha_mode = AlphaMode::blend;
    return new ShadowStage{scene, stage().view};
  }();
  const auto shadows = [](const char* blended) {
    const std::string of_blended = std::string("shadow-blended=") + blended;
    return Way({"lidr-shadows=final", "lidr-maps=256", of_blended}, *blended_fence).shadows();
  };
  const HostShadows none = shadows("none");
  const Agreement alpha = agreement(shadows("alpha"), none, 0),
                  opaque = agreement(shadows("opaque"), none, 0);
  EXPECT_EQ(alpha.other, 0u) << alpha.pairs;
  EXPECT_GT(opaque.other, 0u);
}

// A scene whose lights cast nothing has nothing of it.
TEST(LidrShadows, CostNothingWhereNoLightCasts) {
  Scene scene = shadowed_scene();
  for (Light& light : scene.lights) light.casts_shadow = false;
  TechniqueRun plain(test_devices(), scene, stage().view, {}, find_technique("lidr"));
  plain.run_frame();
  for (const LidrShadows way : {LidrShadows::volumes, LidrShadows::prepass, LidrShadows::prepass_soft,
                                LidrShadows::final_pass, LidrShadows::none}) {
    TechniqueRun run(test_devices(), scene, stage().view, {{setting::lidr_shadows, way}},
                     find_technique("lidr"));
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), plain.image()));
    EXPECT_EQ(run.result().memory_total, plain.result().memory_total);
    EXPECT_FALSE(run.frame().shadow_figures);
  }
}

}  // namespace
}  // namespace lightgrid::lab
