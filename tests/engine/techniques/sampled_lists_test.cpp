// Lists that are samples of longer ones: the mean of their pictures over seeds is the picture of whole lists,
// by the oracle in double and by each technique itself, and each light of a list counts once on average.
#include <gmock/gmock.h>

#include "accuracy/oracle_sample.h"
#include "base/error.h"
#include "cl/transfer.h"
#include "scene/random.h"
#include "techniques/many_lights.h"
#include "techniques/moments.h"
#include "techniques/rendering.h"

namespace lightgrid::sampled {
using namespace lab;
namespace {

const char* const sampled = " list-cap-order=sampled list-cap=";

// From a list, and from a tree in place of lists.
std::string drawn_from(const std::string& order, int cap) {
  return fmt::format(" list-cap-order={} list-cap={}{}", order, cap,
                     order == "tree" ? " range=infinite" : "");
}

// Independent: seeds that follow one another are not.
uint32_t seed_of(int number) { return uint32_t(Random::mix(uint64_t(number))); }

View view_of(int width = 29, int height = 17) {
  return make_view(look_at({0, 0, 0}, {0, 0, -3}), width, height);
}

std::vector<uint32_t> covered_pixels(TechniqueRun& run) {
  run.run_frame();
  std::vector<uint32_t> pixels;
  const std::vector<float> depth = read_depth(run);
  for (size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] > 0) pixels.push_back(uint32_t(i));
  }
  return pixels;
}

Moments moments_of(TechniqueRun& run, const std::vector<uint32_t>& pixels, int pictures) {
  Moments moments(3 * pixels.size());
  for (int i = 0; i < pictures; ++i) {
    run.draw_random(seed_of(i));
    run.run_frame();
    moments.add(channels(run.image(), pixels));
  }
  return moments;
}

TEST(SampledLists, HaveTheMeanOfTheOracle) {
  const Scene scene = many_lights();
  TechniqueRun run(test_devices(), scene, view_of(32, 18), assigned("tile=8" + (sampled + std::string("8"))),
                   find_technique("forward_plus"));
  run.run_frame();
  const SurfaceOracle oracle(run.view(), read_depth(run));
  const std::vector<double> truth = channels(oracle.shade(oracle.pixels(), true));
  const Moments moments = moments_of(run, oracle.pixels(), 1024);
  EXPECT_GE(share_within_four_errors(moments, truth, 1e-6 * *std::ranges::max_element(truth)), 0.999);
  EXPECT_GT(share_that_varies(moments), 0.5) << "little random is tested";
}

struct Sampled {
  const char *technique, *settings;
  bool shadows = false;
  const char* order = "sampled";
};

void PrintTo(const Sampled& s, std::ostream* out) {
  *out << s.technique << " " << s.settings << " " << s.order;
}

struct SampledTechniques : testing::TestWithParam<Sampled> {};

// With glass, whose lists are others.
TEST_P(SampledTechniques, HaveTheMeanOfWholeLists) {
  Scene scene = with_glass();
  if (GetParam().shadows)
    for (size_t i = 0; i < scene.lights.size(); i += 3) scene.lights[i].casts_shadow = true;
  const std::string settings = GetParam().settings;
  const Image whole = render(scene, view_of(), GetParam().technique, assigned(settings));
  TechniqueRun run(test_devices(), scene, view_of(),
                   assigned(fmt::format("{} list-cap-order={} list-cap=8", settings, GetParam().order)),
                   find_technique(GetParam().technique));
  const std::vector<uint32_t> pixels = covered_pixels(run);
  const Moments moments = moments_of(run, pixels, 1024);
  EXPECT_GE(share_within_four_errors(moments, channels(whole, pixels), 1e-6 * brightest_channel(whole)),
            0.999);
  EXPECT_GT(share_that_varies(moments), 0.5) << "little random is tested";
}

INSTANTIATE_TEST_SUITE_P(Of, SampledTechniques,
                         testing::Values(Sampled{"visibility", "tile=8"},
                                         Sampled{"visibility", "tile=8 kernel-shape=group z-bins=16"},
                                         Sampled{"visibility", "tile=8 slices=4 samples=4"},
                                         Sampled{"visibility", "tile=8 range=infinite"},
                                         Sampled{"visibility", "tile=8", true},
                                         Sampled{"clustered", "tile=8"},
                                         Sampled{"deferred_tiled", "tile=8 kernel-shape=group", true},
                                         Sampled{"forward_plus_compute", "tile=8"},
                                         Sampled{"visibility", "tile=8 range=infinite", false, "tree"},
                                         Sampled{"visibility", "tile=8 kernel-shape=group", true, "tree"},
                                         Sampled{"clustered", "tile=8", false, "tree"},
                                         Sampled{"deferred_tiled", "tile=8 range=infinite", false, "tree"}));

// The lists of a frame with how often each light counts: by cell and light, 0 if it is not drawn.
struct Factors {
  std::vector<glm::uvec2> cells;
  std::map<std::pair<size_t, uint32_t>, float> of;
};

Factors read_factors(TechniqueRun& run) {
  ClDevice& device = *run.view().renderer.cl;
  const ViewGrid& grid = *run.frame().grid;
  Factors factors;
  factors.cells.resize(grid.cell_bytes / sizeof(glm::uvec2));
  std::vector<uint16_t> indices(grid.index_count);
  std::vector<float> values(grid.index_count, 1);
  read_buffer(device, "cells", grid.storage->cells(grid.cell_bytes), factors.cells.data(), grid.cell_bytes);
  read_buffer(device, "indices", grid.storage->indices(grid.index_bytes), indices.data(), grid.index_bytes);
  if (grid.factor_bytes)
    read_buffer(device, "factors", grid.storage->factors(grid.factor_bytes), values.data(),
                grid.factor_bytes);
  for (size_t cell = 0; cell < factors.cells.size(); ++cell) {
    const auto [first, count] = std::pair(factors.cells[cell].x, factors.cells[cell].y);
    EXPECT_TRUE(std::is_sorted(indices.begin() + first, indices.begin() + first + count));
    for (uint32_t i = first; i < first + count; ++i) factors.of[{cell, indices[i]}] = values[i];
  }
  return factors;
}

struct ListRun {
  explicit ListRun(Renderer& devices, const Scene& scene, const std::string& settings)
      : run(devices, scene, view_of(75, 53), assigned(settings), find_technique("visibility")) {
    run.run_frame();
  }
  Factors draw(uint32_t seed) {
    run.draw_random(seed);
    run.run_frame();
    return read_factors(run);
  }
  TechniqueRun run;
};

// Counts the lights of complete lists that are drawn often enough to judge, are drawn in every picture, and
// have a mean count over the pictures within four standard errors of 1. One drawn with the probability p
// counts 1 / p times.
struct Counted {
  size_t all = 0, told = 0, certain = 0, once = 0, lists_too_short = 0;
  double mean = 0;  // of the counts of those told
  // That each counts once: most are told, each is within its noise, and all together are nearer.
  bool unbiased() const {
    return double(once) >= 0.999 * double(told) && told > all / 2 && std::abs(mean - 1) < 0.02;
  }
};

void PrintTo(const Counted& c, std::ostream* out) {
  *out << c.all << " lights, " << c.told << " told, " << c.certain << " certain, " << c.once << " once, mean "
       << c.mean << ", " << c.lists_too_short << " lists too short";
}

Counted count_lights(Renderer& devices, const Scene& scene, const std::string& order, int cap) {
  constexpr int pictures = 400;
  ListRun without(devices, scene, order == "tree" ? "range=infinite" : "");
  const Factors whole = read_factors(without.run);
  ListRun run(devices, scene, drawn_from(order, cap));
  std::map<std::pair<size_t, uint32_t>, double> counts, factor_of;
  Counted counted{.all = whole.of.size()};
  for (int i = 0; i < pictures; ++i) {
    const Factors drawn = run.draw(seed_of(i));
    for (size_t cell = 0; cell < whole.cells.size(); ++cell)
      counted.lists_too_short += drawn.cells[cell].y != std::min(whole.cells[cell].y, uint32_t(cap));
    for (const auto& [light, factor] : drawn.of) {
      EXPECT_TRUE(whole.of.contains(light));
      const auto known = factor_of.emplace(light, factor).first;
      EXPECT_EQ(known->second, double(factor)) << "depends on the seed";
      counts[light] += double(factor) / pictures;
    }
  }
  for (const auto& [light, one] : whole.of) {
    const double count = counts[light], factor = count > 0 ? factor_of[light] : 0;
    counted.certain += factor == 1;
    if (count == 0 || factor > pictures / 10) continue;  // hardly ever drawn
    ++counted.told;
    counted.once += std::abs(count - 1) <= 4 * std::sqrt((factor - 1) / pictures) + 1e-6;
    counted.mean += count;
  }
  counted.mean /= double(counted.told);
  return counted;
}

TEST(SampledLists, CountEachLightOnceOnAverage) {
  for (const int cap : {4, 16}) {
    const Counted counted = count_lights(opencl_devices(), many_lights(), "sampled", cap);
    EXPECT_TRUE(counted.unbiased()) << testing::PrintToString(counted);
    EXPECT_EQ(counted.lists_too_short, 0u) << cap;
    EXPECT_GT(counted.certain, counted.all / 50) << cap;
    EXPECT_LT(counted.certain, counted.all / 2) << cap;
  }
}

TEST(SampledLists, FromATreeCountEachLightOnceOnAverage) {
  for (const int cap : {8, 32}) {
    const Counted counted = count_lights(opencl_devices(), many_lights(), "tree", cap);
    EXPECT_TRUE(counted.unbiased()) << testing::PrintToString(counted);
    EXPECT_EQ(counted.lists_too_short, 0u) << cap;
  }
}

struct Fault {
  const char *name, *order, *right, *wrong;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

struct FaultySamples : testing::TestWithParam<Fault> {};

// The check above sees a bias of a few per cent.
TEST_P(FaultySamples, AreFound) {
  Renderer devices(test_device_name(), GlBackend::none);
  int planted = 0;
  devices.kernels->alter([&](std::string text) {
    const bool tree = GetParam().order == std::string("tree");
    const size_t kernel = text.find(tree ? "kernel void sample_tree" : "kernel void sample_lists"),
                 at = text.find(GetParam().right);
    if (kernel == std::string::npos || at == std::string::npos) return text;
    ++planted;
    return text.replace(at, std::string(GetParam().right).size(), GetParam().wrong);
  });
  const Counted counted = count_lights(devices, many_lights(), GetParam().order, 8);
  EXPECT_FALSE(counted.unbiased()) << testing::PrintToString(counted);
  EXPECT_GT(planted, 0) << "the kernel has no such text";
}

INSTANTIATE_TEST_SUITE_P(
    Planted, FaultySamples,
    testing::Values(Fault{"ten_per_cent", "sampled", "return (float)rest", "return 1.1f * (float)rest"},
                    Fault{"one_slot_too_many", "sampled", "(float)slots *", "(float)(slots + 1) *"},
                    Fault{"from_the_beginning", "sampled",
                          "(rest >> 32) * random + ((rest & UINT_MAX) * random >> 32)", "rest >> 1"},
                    Fault{"half_of_the_steps", "sampled", "random >> 32)", "random >> 33)"},
                    Fault{"ten_per_cent_of_a_tree", "tree", "(float)WHOLE_RANGE /",
                          "1.1f * (float)WHOLE_RANGE /"},
                    Fault{"half_of_the_range", "tree", "(ulong)shift << 30", "(ulong)shift << 29"},
                    Fault{"other_half_is_forgotten", "tree", "if (!(seen.intensity > 0.0f)) continue;",
                          "if (node > child) continue;"},
                    Fault{"equal_halves", "tree", "range = max(range - left, 1ul)", "range = left"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(SampledLists, OfOneLightFarAboveOthersAlwaysHaveIt) {
  Scene scene = many_lights();
  scene.lights[40].intensity *= 1e6f;
  scene.lights[40].radius_m = 30;
  ListRun run(opencl_devices(), scene, sampled + std::string("2"));
  for (int i = 0; i < 8; ++i) {
    const Factors drawn = run.draw(seed_of(i));
    for (size_t cell = 0; cell < drawn.cells.size(); ++cell) {
      if (drawn.cells[cell].y > 0) {
        ASSERT_EQ(drawn.of.at({cell, 40}), 1.0f);
      }
    }
  }
}

// Seeds in a row share out what they draw: of 16 the mean varies less than that of 16 independent ones.
TEST(SampledLists, OfSeedsInARowComplementEachOther) {
  const Scene scene = many_lights();
  TechniqueRun run(opencl_devices(), scene, view_of(), assigned("tile=8" + (sampled + std::string("16"))),
                   find_technique("visibility"));
  const std::vector<uint32_t> pixels = covered_pixels(run);
  const Moments single = moments_of(run, pixels, 512);
  Moments of_16(3 * pixels.size());
  for (int i = 0; i < 64; ++i) {
    std::vector<double> mean(3 * pixels.size());
    for (uint32_t frame = 0; frame < 16; ++frame) {
      run.draw_random(seed_of(i) + frame);
      run.run_frame();
      const std::vector<double> values = channels(run.image(), pixels);
      for (size_t v = 0; v < mean.size(); ++v) mean[v] += values[v] / 16;
    }
    of_16.add(mean);
  }
  // 16 independent ones give 16, and 64 means tell a variance to 18 %.
  EXPECT_GT(mean_variance(single) / mean_variance(of_16), 25);
}

TEST(SampledLists, WithRoomForEveryLightNoByteChanges) {
  Scene scene = with_glass();
  scene.lights.resize(66);  // no list has them all, or all but one
  for (const char* technique :
       {"forward_plus", "clustered", "forward_plus_compute", "deferred_tiled", "visibility"}) {
    const Image plain = render(scene, view_of(), technique);
    for (const char* cap : {"64", "128"}) {  // longer than any list, and than all lights
      TechniqueRun run(test_devices(), scene, view_of(), assigned(sampled + std::string(cap)),
                       find_technique(technique));
      run.run_frame();
      EXPECT_EQ(run.view().plan.lists.sampled, std::string(cap) == "64");
      EXPECT_TRUE(identical(run.image(), plain)) << technique << " " << cap;
      EXPECT_EQ(count_listed_pairs(run, read_depth(run)).lost, 0u);
    }
  }
}

TEST(SampledLists, ArePictures) {
  const Scene scene = with_glass();
  for (const std::string more : {"", " slices=4", " z-bins=16", " samples=4"}) {
    const std::string settings = sampled + std::string("4") + more;
    const Image lanes =
        render(scene, view_of(75, 53), "visibility", assigned(settings + " kernel-shape=lanes"));
    EXPECT_TRUE(identical(
        render(scene, view_of(75, 53), "visibility", assigned(settings + " kernel-shape=group")), lanes));
    EXPECT_FALSE(
        identical(render(scene, view_of(75, 53), "visibility", assigned(settings + " list-seed=2")), lanes));
  }
  const std::string settings = sampled + std::string("4") + " depth-bounds=none";
  const Image drawn = render(scene, view_of(75, 53), "forward_plus", assigned(settings));
  expect_near(render(scene, view_of(75, 53), "visibility", assigned(settings)), drawn);
  EXPECT_TRUE(
      identical(render(scene, view_of(75, 53), "clustered", assigned(settings + " slices=1")), drawn));
  EXPECT_LT(
      compare_images(render(scene, view_of(75, 53), "deferred_tiled", assigned(settings)), drawn).max_rel,
      1e-5);
}

// A camera and lights that move: the tree is of the world, and of the lights as they are.
TEST(SampledLists, FromATreeFollowCameraAndLights) {
  Renderer& devices = opencl_devices();
  Scene scene = many_lights();
  const std::string settings = drawn_from("tree", 8);
  GpuScene gpu(devices, scene);
  TechniqueRun run(devices, gpu, view_of(), assigned(settings), find_technique("visibility"));
  run.run_frame();
  const View aside = make_view(look_at({0.8, 0.3, 0.2}, {0, 0, -3}), 29, 17);
  const auto expect_new = [&](const char* what) {
    run.run_frame();
    for (const char* shape : {" kernel-shape=lanes", " kernel-shape=group"})
      EXPECT_TRUE(
          identical(run.image(), render(devices, scene, aside, "visibility", assigned(settings + shape))))
          << what;
    EXPECT_FALSE(identical(run.image(),
                           render(devices, scene, aside, "visibility", assigned(settings + " list-seed=2"))));
  };
  run.look(aside);
  expect_new("camera");
  SceneChanges changes;
  for (int i = 0; i < int(scene.lights.size()); ++i) {
    scene.lights[size_t(i)].position.x += i % 2 ? 0.7 : -0.4;
    changes.lights.push_back(i);
  }
  gpu.update(changes);
  run.look(aside, changes);
  expect_new("lights");
}

TEST(SampledLists, AreRefusedWhereNothingSaysHowOftenALightCounts) {
  const Scene scene = many_lights();
  const auto refusal = [&](const char* technique, const std::string& settings) -> std::string {
    try {
      render(scene, view_of(), technique, assigned(settings));
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  for (const char* technique : {"light_prepass", "forward_multipass", "forward_zprepass"}) {
    for (const char* order : {"sampled", "tree"})
      EXPECT_THAT(refusal(technique, drawn_from(order, 4)), testing::HasSubstr("list-cap-order="))
          << technique;
  }
  EXPECT_THAT(refusal("visibility", drawn_from("tree", 4) + " z-bins=16"),
              testing::HasSubstr("set z-bins=16"));
  EXPECT_THAT(refusal("visibility", drawn_from("tree", 4) + " view-cap=8"),
              testing::HasSubstr("set view-cap=8"));
  EXPECT_THROW(
      render(scene, view_of(), "forward_plus", assigned("grid-lists=masks" + (sampled + std::string("4")))),
      Error);
}

}  // namespace
}  // namespace lightgrid::sampled
