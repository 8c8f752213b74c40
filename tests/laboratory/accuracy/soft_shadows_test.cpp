// Soft shadows of the pass against 1,024 rays a pair in double.
#include "scene/light_groups.h"
#include "support/soft_occlusion.h"

#include <gtest/gtest.h>

#include "accuracy/oracle.h"
#include "accuracy/oracle_sample.h"
#include "accuracy/shadow_truth.h"
#include "accuracy/surfaces_in_double.h"
#include "base/parallel.h"
#include "compare/compare.h"
#include "oracle/position.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

constexpr double source_m = 0.2;

// The ball stands between most lamps and a part of the wall.
Scene soft_scene() {
  SmallScene s = small_scene();
  for (Light& light : s.scene.lights) {
    light.casts_shadow = true;
    light.radius_m = 4;
  }
  return s.scene;
}

Settings settings_of(const std::vector<std::string>& assignments) {
  Settings settings;
  apply_setting(settings, "shadow-source=0.2");
  for (const std::string& assignment : assignments) apply_setting(settings, assignment);
  return settings;
}

struct Shaded {
  Shaded(const Scene& scene, const char* technique, const std::vector<std::string>& settings)
      : run(software_devices(), scene, small_view(131, 77), settings_of(settings),
            find_technique(technique)) {
    run.run_frame();
    shadows = run.frame().shadows();
  }
  TechniqueRun run;
  HostShadows shadows;
};

struct Pair {
  int x = 0, y = 0;
  uint32_t light = 0;
  Receiver receiver{};
  double truth = 0;
};

// The pairs of a light in range, at an even sample of the pixels.
std::vector<Pair> sampled_pairs(TechniqueRun& run, const Scene& scene, size_t pixels) {
  const View& view = run.view().view;
  const std::vector<float> depth = read_depth(run);
  const std::vector<CastingTriangle> shown = casting_triangles(scene, shown_triangles(run));
  const std::vector<ViewLight> lights = local_lights(run.view());
  const Occlusion occlusion(scene);
  std::vector<Pair> pairs;
  for (const uint32_t pixel : sample_pixels(covered_pixels(depth), pixels)) {
    const int x = int(pixel) % view.width, y = int(pixel) / view.width;
    if (shown[pixel].instance < 0) continue;
    const glm::dvec3 position = position_from_depth(view, x, y, double(depth[pixel]));
    const Receiver receiver = occlusion.receiver(view, x, y, double(depth[pixel]), shown[pixel]);
    for (uint32_t light = 0; light < lights.size(); ++light) {
      if (is_lit(lights[light], position)) pairs.push_back({x, y, light, receiver});
    }
  }
  parallel_for(int(pairs.size()), [&](int i) {
    Random random{uint64_t(i)};
    Pair& pair = pairs[size_t(i)];
    pair.truth = hidden_share(occlusion, scene.lights[pair.light], pair.receiver, source_m, 32, random).share;
  });
  return pairs;
}

struct Errors {
  double mean = 0, rms = 0;
  size_t count = 0;
  double standard_error() const { return rms / std::sqrt(double(count)); }
};

// The errors of penumbrae.
Errors errors_of(const HostShadows& shadows, const std::vector<Pair>& pairs) {
  Errors e;
  for (const Pair& pair : pairs) {
    if (!(pair.truth > 0 && pair.truth < 1)) continue;
    const double error = hidden_share_at(shadows, pair.x, pair.y, pair.light) - pair.truth;
    e.mean += error;
    e.rms += error * error;
    ++e.count;
  }
  e.mean /= double(e.count);
  e.rms = std::sqrt(e.rms / double(e.count));
  return e;
}

TEST(SoftShadows, ErrorFallsWithTheRaysAndHasNoBias) {
  const Scene scene = soft_scene();
  std::vector<Pair> pairs;
  double last_rms = 1;
  for (const char* rays : {"4", "16", "64", "256"}) {
    Shaded shaded(scene, "visibility", {std::string("shadow-rays=") + rays});
    if (pairs.empty()) pairs = sampled_pairs(shaded.run, scene, 600);
    const Errors e = errors_of(shaded.shadows, pairs);
    ASSERT_GT(e.count, 700u);
    std::printf("%s rays: %zu pairs in penumbrae of %zu, mean %.5f (standard error %.5f), RMS %.5f\n", rays,
                e.count, pairs.size(), e.mean, e.standard_error(), e.rms);
    EXPECT_LT(std::abs(e.mean), 3 * e.standard_error()) << rays;
    // For random samples the quotient of two rows is a half.
    EXPECT_LT(e.rms, 0.5 * last_rms) << rays;
    last_rms = e.rms;
    size_t wrong = 0;
    for (const Pair& pair : pairs) {
      const double share = hidden_share_at(shaded.shadows, pair.x, pair.y, pair.light);
      wrong += (pair.truth == 0 && share > 0.25) || (pair.truth == 1 && share < 0.75);
    }
    EXPECT_EQ(wrong, 0u) << "of pairs that are wholly seen or hidden";
  }
}

TEST(SoftShadows, AllKernelShapesGiveTheSameBytes) {
  const Scene scene = soft_scene();
  for (const auto& [rays, pick] : {std::pair{"shadow-rays=4", "shadow-pick=off"},
                                   {"shadow-rays=64", "shadow-pick=off"},
                                   {"shadow-rays=1", "shadow-pick=4"},
                                   {"shadow-rays=4", "shadow-pick=16"}}) {
    const Shaded lanes(scene, "visibility", {rays, pick, "kernel-shape=lanes"}),
        group(scene, "visibility", {rays, pick, "kernel-shape=group"}),
        portable(scene, "visibility", {rays, pick, "kernel-shape=lanes", "portable=on"});
    EXPECT_GT(std::ranges::count_if(lanes.shadows.shares, [](uint8_t s) { return s > 0 && s < 255; }), 1000);
    EXPECT_EQ(lanes.shadows.shares, group.shadows.shares) << rays << " " << pick;
    EXPECT_EQ(lanes.shadows.shares, portable.shadows.shares) << rays << " " << pick;
  }
}

TEST(SoftShadows, LoopsOfOpenGlReadTheSameShares) {
  const Scene scene = soft_scene();
  const Shaded forward(scene, "forward", {"shadow-rays=16"}), plus(scene, "forward_plus", {"shadow-rays=16"}),
      hard(scene, "forward", {});
  EXPECT_EQ(forward.shadows.shares, plus.shadows.shares);
  EXPECT_EQ(forward.run.image().pixels, plus.run.image().pixels);
  EXPECT_NE(forward.run.image().pixels, hard.run.image().pixels);
}

TEST(SoftShadows, APointHasHardShadows) {
  const Scene scene = soft_scene();
  for (const char* technique : {"forward", "visibility"}) {
    const Shaded hard(scene, technique, {"shadow-rays=1"}),
        point(scene, technique, {"shadow-rays=16", "shadow-source=0"});
    EXPECT_TRUE(hard.shadows.shares.empty());
    EXPECT_TRUE(point.shadows.shares.empty());
    EXPECT_EQ(hard.shadows.bits, point.shadows.bits);
    EXPECT_EQ(hard.run.image().pixels, point.run.image().pixels);
  }
}

// shadow-source is of lights without a radius of their own.
TEST(SoftShadows, LightsMayHaveARadiusOfTheirOwn) {
  const Scene scene = soft_scene();
  Scene own = scene;
  for (Light& light : own.lights) light.source_m = float(source_m);
  const Shaded by_setting(scene, "visibility", {"shadow-rays=16"}),
      by_light(own, "visibility", {"shadow-rays=16", "shadow-source=0.5"}),
      wider(scene, "visibility", {"shadow-rays=16", "shadow-source=0.5"});
  EXPECT_EQ(by_light.shadows.shares, by_setting.shadows.shares);
  EXPECT_NE(by_light.shadows.shares, wider.shadows.shares);
  for (Light& light : own.lights) light.source_m = 0;
  const Shaded points(own, "visibility", {"shadow-rays=16"});
  EXPECT_GT(std::ranges::count(points.shadows.shares, 255), 100);
  EXPECT_TRUE(
      std::ranges::all_of(points.shadows.shares, [](int share) { return share == 0 || share == 255; }));
}

// The reference has the contestants' rays only if all have the same.
TEST(SoftShadows, DoNotMakeErrorsDependOnTheOrderOfRows) {
  const Scene scene = soft_scene();
  const Settings soft = settings_of({"shadow-rays=16"}), picked = settings_of({"shadow-pick=4"});
  const Technique &forward = find_technique("forward"), &visibility = find_technique("visibility");
  const auto rows_of = [&](const std::vector<Contestant>& contestants) {
    const CompareOptions options{.frames = 1, .warmup = 0, .shaded_samples = 10};
    return compare_techniques(software_devices(), scene, small_view(71, 37), contestants, options).rows;
  };
  const auto rows = rows_of({{&forward, soft}, {&visibility, picked}, {&forward, {}}, {&visibility, {}}});
  const auto turned = rows_of({{&visibility, {}}, {&forward, {}}, {&visibility, picked}, {&forward, soft}});
  ASSERT_EQ(rows.size(), 4u);
  ASSERT_EQ(turned.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    const RunResult &one = rows[i], &other = turned[3 - i];
    EXPECT_EQ(one.error->rmse_rel, other.error->rmse_rel) << i;
    EXPECT_EQ(one.same_surfaces.has_value(), other.same_surfaces.has_value()) << i;
    if (one.same_surfaces && other.same_surfaces) {
      EXPECT_EQ(one.same_surfaces->rmse_rel, other.same_surfaces->rmse_rel) << i;
    }
  }
  EXPECT_GT(rows[0].error->rmse_rel, 1e-4);
  ASSERT_TRUE(rows[1].same_surfaces && rows[3].same_surfaces);
  EXPECT_GT(rows[1].same_surfaces->rmse_rel, 1e-4);
  EXPECT_EQ(rows[2].error->rmse_rel, 0);
  EXPECT_LT(rows[3].same_surfaces->rmse_rel, 1e-5);

  const auto all_soft = rows_of({{&find_technique("forward_plus"), soft}, {&visibility, soft}});
  EXPECT_EQ(all_soft[0].error->rmse_rel, 0);
  ASSERT_TRUE(all_soft[1].same_surfaces);
  EXPECT_LT(all_soft[1].same_surfaces->rmse_rel, 1e-5);
}

// A pixel's lights by what they add to a Lambert surface.
struct PickedPixel {
  int x = 0, y = 0;
  uint32_t brightest = 0;
  double ratio = 0;  // hidden share of their sum
};

glm::dvec3 normal_towards_the_eye(const Scene& scene, const Receiver& receiver) {
  const Instance& instance = scene.instances[size_t(receiver.own.instance)];
  const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
  glm::dvec3 c[3];
  for (size_t k = 0; k < 3; ++k) {
    const glm::vec3 p = mesh.positions[mesh.indices[3 * size_t(receiver.own.triangle) + k]];
    c[k] = glm::dvec3(instance.world_from_object * glm::dvec4(p, 1));
  }
  const glm::dvec3 normal = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
  return glm::dot(normal, receiver.eye.place - receiver.place.place) < 0 ? -normal : normal;
}

// `soft`: the lights are spheres. Pixels whose lights are neither all hidden nor all seen.
std::vector<PickedPixel> picked_pixels(TechniqueRun& run, const Scene& scene, size_t pixels, bool soft) {
  const View& view = run.view().view;
  const std::vector<float> depth = read_depth(run);
  const std::vector<CastingTriangle> shown = casting_triangles(scene, shown_triangles(run));
  const Occlusion occlusion(scene);
  std::vector<uint32_t> sampled = sample_pixels(covered_pixels(depth), pixels);
  std::vector<PickedPixel> found(sampled.size());
  parallel_for(int(sampled.size()), [&](int n) {
    const uint32_t pixel = sampled[size_t(n)];
    const int x = int(pixel) % view.width, y = int(pixel) / view.width;
    if (shown[pixel].instance < 0) return;
    const Receiver receiver = occlusion.receiver(view, x, y, double(depth[pixel]), shown[pixel]);
    const glm::dvec3 normal = normal_towards_the_eye(scene, receiver);
    Random random{uint64_t(n)};
    double sum = 0, hidden = 0, most = 0;
    PickedPixel p{x, y};
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
      const Light& light = scene.lights[i];
      const glm::dvec3 to = light.position - receiver.place.place;
      const double d = glm::length(to), part = std::pow(d / double(light.radius_m), 4);
      const double luminance = glm::dot(glm::dvec3(light.color), glm::dvec3(0.2126, 0.7152, 0.0722));
      const double adds = luminance * double(light.intensity) * std::max(0.0, glm::dot(to, normal)) /
                          (d * d * d) * std::max(0.0, 1 - part);
      if (adds == 0) continue;
      const double share =
          hidden_share(occlusion, light, receiver, soft ? source_m : 0, soft ? 16 : 1, random).share;
      sum += adds;
      hidden += adds * share;
      if (adds > most) {
        most = adds;
        p.brightest = i;
      }
    }
    p.ratio = sum > 0 ? hidden / sum : 0;
    found[size_t(n)] = p;
  });
  std::erase_if(found, [](const PickedPixel& p) { return !(p.ratio > 0.001 && p.ratio < 0.999); });
  return found;
}

Errors errors_of(const Shaded& shaded, const std::vector<PickedPixel>& pixels) {
  Errors e;
  for (const PickedPixel& p : pixels) {
    const double error = hidden_share_at(shaded.shadows, p.x, p.y, p.brightest) - p.ratio;
    e.mean += error;
    e.rms += error * error;
    ++e.count;
  }
  e.mean /= double(e.count);
  e.rms = std::sqrt(e.rms / double(e.count));
  return e;
}

// Each pixel draws by its own hash, so that the mean over pixels is that over many draws.
TEST(PickedShadows, MeanIsTheHiddenRatioAndNoiseFallsWithTheRays) {
  const Scene scene = soft_scene();
  for (const char* sphere : {"shadow-rays=1", "shadow-rays=16"}) {
    std::vector<PickedPixel> pixels;
    double last_rms = 1;
    for (const char* rays : {"1", "4", "16"}) {
      Shaded shaded(scene, "visibility", {sphere, std::string("shadow-pick=") + rays});
      if (pixels.empty())
        pixels = picked_pixels(shaded.run, scene, 4000, sphere[12] == '1' && sphere[13] == '6');
      const Errors e = errors_of(shaded, pixels);
      ASSERT_GT(e.count, 1000u);
      std::printf("%s, %s rays a pixel: %zu pixels, mean %.5f (standard error %.5f), RMS %.5f\n", sphere,
                  rays, e.count, e.mean, e.standard_error(), e.rms);
      EXPECT_LT(std::abs(e.mean), 3 * e.standard_error()) << rays;
      EXPECT_LT(e.rms, 0.55 * last_rms) << rays;
      last_rms = e.rms;
    }
  }
}

// A ray to the only lamp is its exact shadow's.
TEST(PickedShadows, OfOneLightAreExact) {
  Scene scene = soft_scene();
  scene.lights.resize(1);
  const Shaded picked(scene, "visibility", {"shadow-pick=4"}), exact(scene, "visibility", {});
  ASSERT_EQ(picked.shadows.cells, exact.shadows.cells);
  EXPECT_EQ(picked.shadows.bits, exact.shadows.bits);
  const auto is_whole = [](uint8_t share) { return share == 0 || share == 255; };
  EXPECT_TRUE(std::ranges::all_of(picked.shadows.shares, is_whole));
  EXPECT_GT(std::ranges::count(picked.shadows.shares, 255), 300);
}

// Lamps of another group, which are ten times as bright and stand elsewhere, shine on nothing here.
TEST(PickedShadows, LightsOfOtherGroupsTakeNoPart) {
  Scene scene = soft_scene();
  Shaded alone(scene, "visibility", {"shadow-rays=1", "shadow-pick=16"});
  const std::vector<PickedPixel> pixels = picked_pixels(alone.run, scene, 4000, false);
  for (Instance& instance : scene.instances) set_groups(instance, 1);
  const size_t count = scene.lights.size();
  for (size_t i = 0; i < count; ++i) {
    set_groups(scene.lights[i], 1);
    Light other = scene.lights[i];
    set_groups(other, 2);
    other.intensity *= 10;
    other.position = scene.lights[(i + 1) % count].position + glm::dvec3(0.3, 0.5, 0);
    scene.lights.push_back(other);
  }
  for (const char* shape : {"kernel-shape=lanes", "kernel-shape=group"}) {
    Shaded shaded(scene, "visibility", {"shadow-rays=1", "shadow-pick=16", shape});
    const Errors e = errors_of(shaded, pixels);
    ASSERT_GT(e.count, 1000u);
    EXPECT_LT(std::abs(e.mean), 3 * e.standard_error()) << shape;
  }
}

}  // namespace
}  // namespace lightgrid::lab
