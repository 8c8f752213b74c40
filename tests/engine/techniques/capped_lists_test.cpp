// Lists that end at a number of lights hold those that their order says: chosen again here, in double, from
// the lists without a limit.
#include <gmock/gmock.h>

#include <numeric>

#include "base/error.h"
#include "oracle/position.h"
#include "plan/settings/grid.h"
#include "support/small_scene.h"
#include "techniques/many_lights.h"
#include "techniques/rendering.h"

namespace lightgrid::capped {
using namespace lab;
namespace {

using glm::dvec3;
constexpr int width = 75, height = 53;

View from(double x) { return make_view(look_at({x, 0, 0}, {0, 0, -3}), width, height); }

double intensity(const ViewLight& light) {
  return light.radiant_intensity.r + light.radiant_intensity.g + light.radiant_intensity.b;
}

std::vector<uint32_t> list_of(const ListedLights& lists, uint32_t cell) {
  const auto first = lists.indices.begin() + std::ptrdiff_t(lists.first[cell]);
  return {first, first + lists.count[cell]};
}

// A run, what it lists, and the depth there.
struct Listed {
  explicit Listed(const Scene& scene, const View& view, const char* technique, const std::string& settings)
      : run(test_devices(), scene, view, assigned(settings), find_technique(technique)) {
    read();
  }
  void look(const View& view) {
    run.look(view);
    read();
  }
  std::vector<uint32_t> at(size_t pixel) const {
    return list_of(lists, lists.cell_of_pixel.empty() ? 0 : lists.cell_of_pixel[pixel]);
  }
  const FramePlan& plan() const { return run.view().plan; }

  TechniqueRun run;
  ListedLights lists;
  std::vector<float> depth;

 private:
  void read() {
    run.run_frame();
    depth = read_depth(run);
    lists = listed_lights(run, depth);
  }
};

// The distances from `near` to `far` of a pixel's cell, from the depth of the tile's pixels alone.
std::pair<double, double> interval_at(const Listed& listed, const View& view, int x, int y) {
  const FramePlan& plan = listed.plan();
  const int tile = plan.settings[setting::tile], x0 = x / tile * tile, y0 = y / tile * tile;
  const auto distance = [&](int px, int py) {
    return -position_from_depth(view, px, py, listed.depth[size_t(py) * width + size_t(px)]).z;
  };
  double near = 1e18, far = -1e18;
  for (int py = y0; py < std::min(y0 + tile, height); ++py) {
    for (int px = x0; px < std::min(x0 + tile, width); ++px) {
      if (!(listed.depth[size_t(py) * width + size_t(px)] > 0)) continue;
      near = std::min(near, distance(px, py));
      far = std::max(far, distance(px, py));
    }
  }
  const double here = distance(x, y), ratio = plan.lists.far_m / plan.lists.near_m;
  for (int i = 1; i < plan.lists.slices; ++i) {
    const double edge = plan.lists.near_m * std::pow(ratio, double(i) / plan.lists.slices);
    if (edge <= here) near = std::max(near, edge);
    if (edge > here) far = std::min(far, edge);
  }
  return {near, far};
}

// The keys by which lights are sorted, least first.
std::vector<double> keys_at(const Listed& listed, const View& view, const std::vector<ViewLight>& lights,
                            const std::string& order, int x, int y) {
  std::vector<double> keys;
  if (order == "index") {
    keys.resize(lights.size());
    std::iota(keys.begin(), keys.end(), 0.0);
    return keys;
  }
  if (order == "distance") {
    for (const ViewLight& light : lights) keys.push_back(glm::length(light.position));
    return keys;
  }
  const int tile = listed.plan().settings[setting::tile];
  const auto [near, far] = interval_at(listed, view, x, y);
  // The pixels' middle: between the centres of the tile's first and last.
  const double mx = 0.5 * (x / tile * tile + std::min(x / tile * tile + tile, width)),
               my = 0.5 * (y / tile * tile + std::min(y / tile * tile + tile, height));
  const double half = std::tan(glm::radians(60.0) / 2);
  const dvec3 ray((2 * mx / width - 1) * half * width / height, (2 * my / height - 1) * half, -1);
  for (const ViewLight& light : lights) {
    const dvec3 away = light.position - ray * std::clamp(-light.position.z, near, far);
    keys.push_back(glm::dot(away, away) / intensity(light));
  }
  return keys;
}

struct Capped {
  const char *technique, *settings;
};

void PrintTo(const Capped& c, std::ostream* out) { *out << c.technique << " " << c.settings; }

struct CappedGrids : testing::TestWithParam<Capped> {};

TEST_P(CappedGrids, KeepTheLightsOfTheirOrder) {
  const Scene scene = many_lights();
  const std::string common = GetParam().settings;
  for (const std::string order : {"index", "distance", "brightest"}) {
    Listed whole(scene, from(0), GetParam().technique, common);
    Listed capped(scene, from(0), GetParam().technique, common + " list-cap=4 list-cap-order=" + order);
    for (const double eye : {0.0, 0.7}) {  // a camera that moves
      const View view = from(eye);
      if (eye > 0) {
        whole.look(view);
        capped.look(view);
      }
      const std::vector<ViewLight> lights = lights_in_view(scene, view);
      size_t shortened = 0, wrong = 0;
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          const size_t pixel = size_t(y) * width + size_t(x);
          if (!(whole.depth[pixel] > 0)) continue;
          const std::vector<uint32_t> all = whole.at(pixel), kept = capped.at(pixel);
          ASSERT_EQ(kept.size(), std::min<size_t>(all.size(), 4));
          ASSERT_TRUE(std::ranges::is_sorted(kept));
          ASSERT_TRUE(std::ranges::includes(all, kept));
          if (kept.size() == all.size()) continue;
          ++shortened;
          const std::vector<double> keys = keys_at(whole, view, lights, order, x, y);
          double max_kept = 0, min_left = 1e18;
          for (const uint32_t light : all) {
            if (std::ranges::binary_search(kept, light))
              max_kept = std::max(max_kept, keys[light]);
            else
              min_left = std::min(min_left, keys[light]);
          }
          // Kernels round to float, and widen intervals by rounding and by a step of the depth.
          wrong += max_kept > min_left * (order == "brightest" ? 1.001 : 1);
        }
      }
      EXPECT_GT(shortened, size_t(width * height / 2)) << order;
      EXPECT_EQ(wrong, 0u) << order << " from " << eye;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfTechniques, CappedGrids,
    testing::Values(Capped{"forward_plus", ""}, Capped{"forward_plus", "kernel-shape=group tile=8"},
                    Capped{"forward_plus", "depth-bounds=mask32"}, Capped{"clustered", ""},
                    Capped{"clustered", "slices=4 tile=32"}, Capped{"visibility", "kernel-shape=group"},
                    Capped{"visibility", "depth-bounds=halfz-modified"},
                    Capped{"deferred_tiled", "raster=opencl"}, Capped{"light_prepass", "raster=opencl"},
                    Capped{"forward_plus_compute", "tile=8"}));

const char* const of_grids[] = {"forward_plus",  "clustered",  "forward_plus_compute", "deferred_tiled",
                                "light_prepass", "visibility", "forward_multipass",    "forward_zprepass"};

// All techniques with such lists, and no other.
TEST(CappedLists, LimitedListsAreTold) {
  for (const Technique* technique : techniques()) {
    const bool capped = std::ranges::count(of_grids, std::string(technique->name)) > 0;
    for (const char* setting : {"list-cap=64", "view-cap=256"}) {
      EXPECT_EQ(limits_lists(*technique, assigned(setting)), capped || technique->limited_lists)
          << technique->name;
    }
    EXPECT_EQ(limits_lists(*technique, {}), technique->limited_lists) << technique->name;
  }
  EXPECT_FALSE(limits_lists(find_technique("visibility"), assigned("lights=all list-cap=4")));
  EXPECT_FALSE(limits_lists(find_technique("light_prepass"), assigned("prepass-lights=volumes list-cap=4")));
}

TEST(CappedLists, WithRoomForEveryLightNoByteChanges) {
  const Scene scene = many_lights();
  for (const char* technique : of_grids) {
    Listed plain(scene, from(0), technique, "");
    for (const char* order : {"index", "distance", "brightest"}) {
      Listed capped(scene, from(0), technique,
                    std::string("list-cap=128 view-cap=128 list-cap-order=") + order);
      EXPECT_TRUE(identical(capped.run.image(), plain.run.image())) << technique << " " << order;
      EXPECT_EQ(capped.lists.indices, plain.lists.indices) << technique;
      EXPECT_EQ(capped.lists.count, plain.lists.count) << technique;
      EXPECT_EQ(count_listed_pairs(capped.run, capped.depth).lost, 0u) << technique;
    }
  }
}

TEST(CappedLists, ArePictures) {
  const Scene scene = with_glass();
  for (const char* order : {"index", "distance", "brightest"}) {
    const std::string cap = std::string("list-cap=4 list-cap-order=") + order;
    const Image lanes = render(scene, from(0), "forward_plus", assigned(cap + " kernel-shape=lanes"));
    EXPECT_TRUE(
        identical(render(scene, from(0), "forward_plus", assigned(cap + " kernel-shape=group")), lanes));
    EXPECT_FALSE(identical(render(scene, from(0), "forward_plus"), lanes)) << "nothing was left out";
    const Image resolved = render(scene, from(0), "visibility", assigned(cap + " kernel-shape=lanes"));
    EXPECT_TRUE(
        identical(render(scene, from(0), "visibility", assigned(cap + " kernel-shape=group")), resolved));
    EXPECT_TRUE(
        identical(render(scene, from(0), "forward_plus", assigned(cap + " depth-bounds=none")),
                  render(scene, from(0), "clustered", assigned(cap + " depth-bounds=none slices=1"))));
    expect_near(resolved, lanes);
  }
}

// Lists of the same lights in two rasterisers, where these found the same lists without a limit.
TEST(CappedLists, OfForwardPlusAndVisibilityAreOne) {
  const Scene scene = many_lights();
  Listed drawn(scene, from(0), "forward_plus", ""), resolved(scene, from(0), "visibility", "");
  for (const std::string order : {"index", "distance"}) {
    const std::string cap = "list-cap=4 list-cap-order=" + order;
    Listed drawn_capped(scene, from(0), "forward_plus", cap), capped(scene, from(0), "visibility", cap);
    size_t same = 0;
    for (size_t pixel = 0; pixel < size_t(width * height); ++pixel) {
      if (drawn.at(pixel) != resolved.at(pixel)) continue;
      ++same;
      ASSERT_EQ(drawn_capped.at(pixel), capped.at(pixel)) << order;
    }
    EXPECT_GT(same, size_t(width * height) * 9 / 10);
  }
}

// The scene with those of its lights alone.
Scene with_lights(const Scene& scene, std::vector<size_t> kept) {
  std::ranges::sort(kept);
  Scene less = scene;
  less.lights.clear();
  for (const size_t i : kept) less.lights.push_back(scene.lights[i]);
  return less;
}

// A list a mesh: of all lights that reach the wall's box and the ball's. Lights of long range reach both.
TEST(CappedLists, OfObjectsAreOfTheirBounds) {
  Scene scene = many_lights();
  for (Light& light : scene.lights) light.radius_m = 30;
  scene.instances.erase(scene.instances.begin() + 1);  // the ball
  const dvec3 middle(0.2, 0, -4);
  std::vector<size_t> order(scene.lights.size());
  std::iota(order.begin(), order.end(), size_t(0));
  const auto first_by = [&](auto key) {
    std::vector<size_t> sorted = order;
    if (key) std::ranges::stable_sort(sorted, {}, [&](size_t i) { return (*key)(scene.lights[i]); });
    sorted.resize(8);
    return with_lights(scene, sorted);
  };
  using Key = std::function<double(const Light&)>;
  const std::optional<Key> none, distance([&](const Light&l) { return glm::distance(l.position, middle); }),
      brightest([&](const Light&l) {
        return std::pow(glm::distance(l.position, middle), 2) / double(l.intensity);
      });
  for (const char* technique : {"forward_zprepass", "forward_multipass"}) {
    for (const auto& [name, key] :
         {std::pair("index", none), std::pair("distance", distance), std::pair("brightest", brightest)}) {
      const Image capped =
          render(scene, from(0), technique, assigned(std::string("list-cap=8 list-cap-order=") + name));
      EXPECT_TRUE(identical(capped, render(first_by(key), from(0), technique))) << technique << " " << name;
    }
  }
}

// As if the other lights were not there: the nearest of those whose range the view sees.
TEST(CappedLists, OfAViewAreTheNearest) {
  const Scene scene = many_lights();
  for (const char* technique : of_grids) {
    TechniqueRun moving(test_devices(), scene, from(0), assigned("view-cap=8"), find_technique(technique));
    moving.run_frame();
    for (const double eye : {0.0, -0.8}) {
      const View view = from(eye);
      std::vector<std::pair<double, size_t>> seen;
      const std::vector<ViewLight> lights = lights_in_view(scene, view);
      const double half_y = glm::radians(30.0), half_x = std::atan(std::tan(half_y) * width / height);
      for (size_t i = 0; i < lights.size(); ++i) {
        const dvec3 p = lights[i].position;
        const double r = lights[i].radius_m;
        const auto inside = [&](double across, double half) {
          return std::abs(across) * std::cos(half) + p.z * std::sin(half) < r;
        };
        if (inside(p.x, half_x) && inside(p.y, half_y) && p.z - r < -view.near_m)
          seen.emplace_back(glm::length(p), i);
      }
      std::ranges::sort(seen);
      ASSERT_GT(seen.size(), 8u);
      std::vector<size_t> kept;
      for (size_t i = 0; i < 8; ++i) kept.push_back(seen[i].second);
      if (eye != 0) {
        moving.look(view);
        moving.run_frame();
      }
      EXPECT_TRUE(identical(moving.image(), render(with_lights(scene, kept), view, technique)))
          << technique << " from " << eye;
      EXPECT_GT(count_listed_pairs(moving, read_depth(moving)).lost, 0u);
    }
  }
}

TEST(CappedLists, MasksHaveNoLength) {
  const Scene scene = many_lights();
  EXPECT_THROW(render(scene, from(0), "forward_plus", assigned("grid-lists=masks list-cap=64")), Error);
  const Image lists = render(scene, from(0), "forward_plus", assigned("view-cap=8"));
  EXPECT_TRUE(
      identical(render(scene, from(0), "forward_plus", assigned("grid-lists=masks view-cap=8")), lists));
}

}  // namespace
}  // namespace lightgrid::capped
