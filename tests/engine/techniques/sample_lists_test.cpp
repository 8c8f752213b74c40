// Tiles' lists at pixels with edges, against rays in double at the samples: there a pixel has no depth of its
// own, and comparisons take it for background.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <set>

#include "base/error.h"
#include "oracle/position.h"
#include "oracle/primary_rays.h"
#include "plan/settings/grid.h"
#include "plan/settings/samples.h"
#include "raster/raster_samples.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

using glm::dvec2, glm::dvec3, glm::ivec2;

constexpr int units = 256;  // a pixel's side

View in_units(View view) {
  view.width *= units;
  view.height *= units;
  return view;
}

class SampleRays {
 public:
  // Both outlive it.
  SampleRays(const Scene& scene, const View& view)
      : scene_(scene), view_(view), large_(in_units(view)), rays_(scene, large_), surfaces_(scene, view) {}

  // The surface that a sample certainly sees: an instance, and places around it there. Empty near a
  // silhouette, where a rasteriser, whose corners are snapped to a unit, may see another one.
  struct Seen {
    int instance = -1;
    std::vector<dvec3> positions;
  };
  Seen at(int pixel, ivec2 sample) {
    Seen seen;
    const ivec2 place = ivec2(pixel % view_.width, pixel / view_.width) * units + units / 2 + sample;
    for (const ivec2 off : {ivec2(0, 0), ivec2(-3, -3), ivec2(3, -3), ivec2(-3, 3), ivec2(3, 3)}) {
      const ivec2 p = place + off;
      const auto hit = rays_.at(surfaces_, dvec2(p) + 0.5);
      if (!hit || (off != ivec2(0) && hit->triangle.instance != seen.instance)) return {};
      seen.instance = hit->triangle.instance;
      seen.positions.push_back(position_from_depth(large_, p.x, p.y, hit->depth));
    }
    return seen;
  }

 private:
  const Scene& scene_;
  const View& view_;
  const View large_;
  PrimaryRays rays_;
  SceneSurfaces surfaces_;
};

// Lights that certainly reach a surface of a pixel whose samples see several instances.
struct EdgePairs {
  uint64_t pixels = 0;
  std::vector<std::pair<int, uint32_t>> pairs;  // pixel and light, by its number in lists
};
EdgePairs pairs_at_edges(const Scene& scene, const View& view, std::vector<ViewLight> lights,
                         std::span<const ivec2> places) {
  for (ViewLight& light : lights) light.radius_m *= 1 - 1e-4;
  SampleRays rays(scene, view);
  EdgePairs found;
  for (int pixel = 0; pixel < view.width * view.height; ++pixel) {
    std::set<int> instances;
    std::set<uint32_t> reaching;
    for (const ivec2& place : places) {
      const SampleRays::Seen seen = rays.at(pixel, place);
      if (seen.instance < 0) continue;
      instances.insert(seen.instance);
      for (uint32_t i = 0; i < lights.size(); ++i) {
        if (std::ranges::all_of(seen.positions, [&](const dvec3& p) { return is_lit(lights[i], p); }))
          reaching.insert(i);
      }
    }
    if (instances.size() < 2) continue;
    ++found.pixels;
    for (const uint32_t light : reaching) found.pairs.emplace_back(pixel, light);
  }
  return found;
}

// Counts those of these pairs that are missing in the tiles' lists of the run's last frame.
size_t count_lost(TechniqueRun& run, const EdgePairs& edges) {
  const int width = run.view().view.width, tile = run.view().plan.settings[setting::tile];
  const ListedLights lists = listed_lights(run, read_depth(run));
  return size_t(std::ranges::count_if(edges.pairs, [&](const auto& pair) {
    const auto [pixel, light] = pair;
    const size_t cell =
        size_t(pixel / width / tile) * size_t((width + tile - 1) / tile) + size_t(pixel % width / tile);
    const auto first = lists.indices.begin() + std::ptrdiff_t(lists.first.at(cell));
    return std::find(first, first + lists.count.at(cell), light) == first + lists.count.at(cell);
  }));
}

struct EdgeLists : testing::TestWithParam<const char*> {};

TEST_P(EdgeLists, HoldEveryLightOfEachSurface) {
  Scene scene = find_builtin_scene(GetParam())->make();
  for (Light& light : scene.lights) light.casts_shadow = false;
  const View view = default_view(scene, 64, 36);
  const auto drawn = [&](const char* technique, int samples, int tile) {
    Settings settings;
    settings.set(setting::samples, samples);
    settings.set(setting::tile, tile);
    auto run =
        std::make_unique<TechniqueRun>(test_devices(), scene, view, settings, find_technique(technique));
    run->run_frame();
    return run;
  };
  for (const int samples : {2, 4, 8}) {
    const auto centres = drawn("visibility", 1, 8);
    const EdgePairs edges =
        pairs_at_edges(scene, view, local_lights(centres->view()), raster_samples(samples));
    EXPECT_GT(edges.pixels, 100u);
    for (const int tile : {8, 16})
      EXPECT_EQ(count_lost(*drawn("visibility", samples, tile), edges), 0u) << samples << " " << tile;
    // Lists of pixels' centres would lack some.
    EXPECT_GT(count_lost(*centres, edges), 0u) << samples;
  }
  for (const char* technique : {"forward_plus", "deferred_tiled"}) {
    try {
      const auto run = drawn(technique, 4, 8);
      const EdgePairs edges =
          pairs_at_edges(scene, view, local_lights(run->view()), run->view().sample_places());
      EXPECT_EQ(count_lost(*run, edges), 0u) << technique;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::machine) throw;  // OpenGL may have other numbers
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EdgeLists, testing::Values("hall", "street"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace lightgrid
