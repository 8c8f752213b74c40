// The hard cases of light indices distinguish right from wrong: each fault, planted into the lists that
// images hold, is found by the cases that are meant for it.
#include <gtest/gtest.h>

#include <algorithm>

#include "hard_cases/library_engine.h"
#include "oracle/position.h"
#include "verify/run.h"

namespace lightgrid::lab::verify {
namespace {

// A pixel's list, and where it is.
struct PixelList {
  const std::vector<ViewLight>& lights;
  const View& view;
  size_t view_number;
  std::vector<uint32_t>& indices;
};
using Spoil = void (*)(PixelList);

double distance_to_eye(const PixelList& p, uint32_t light) { return glm::length(p.lights[light].position); }

template <typename Holds>
void drop(PixelList p, const Holds& holds) {
  std::erase_if(p.indices, holds);
}

struct LightIndexFault {
  const char* name;
  Spoil spoil;
  std::vector<const char*> by;
};

std::vector<LightIndexFault> light_index_faults() {
  return {
      {"first_light_is_none",
       [](PixelList p) { drop(p, [](uint32_t i) { return i == 0; }); },
       {"first_and_last_index", "full_pixels"}},
      {"index_of_255_wraps",
       [](PixelList p) { drop(p, [](uint32_t i) { return i == 254; }); },
       {"first_and_last_index"}},
      {"high_byte_is_lost",
       [](PixelList p) {
         for (uint32_t& i : p.indices) i &= 255;
       },
       {"first_and_last_index"}},
      {"oldest_is_shifted_out",
       [](PixelList p) {
         if (p.indices.size() == 16) p.indices.erase(p.indices.begin());
       },
       {"full_pixels"}},
      {"carry_past_the_limit",
       [](PixelList p) {
         if (p.indices.size() == 4 && p.lights.size() == 7) p.indices[0] = p.indices[1];
       },
       {"past_the_limit"}},
      {"not_from_within",
       [](PixelList p) { drop(p, [&](uint32_t i) { return distance_to_eye(p, i) < p.lights[i].radius_m; }); },
       {"eye_in_volumes"}},
      {"one_group_holds_two",
       [](PixelList p) {
         if (p.indices.size() > 2) p.indices.erase(p.indices.begin() + 1);
       },
       {"groups_that_touch", "groups_of_still_lights"}},
      {"groups_of_the_first_view",
       [](PixelList p) {
         if (p.view_number) drop(p, [&](uint32_t i) { return i % 7 == 3; });
       },
       {"groups_of_still_lights"}},
      {"last_row_is_stale",
       [](PixelList p) {
         if (p.view.height % 16 && p.view_number) p.indices.clear();
       },
       {"cut_images"}},
      {"lists_every_light",
       [](PixelList p) {
         p.indices.clear();
         for (uint32_t i = 0; i < p.lights.size(); ++i) p.indices.push_back(i);
       },
       {"first_and_last_index", "cones_and_ranges", "groups_of_still_lights"}},
      {"wide_cones_are_cut",
       [](PixelList p) {
         drop(p,
              [&](uint32_t i) { return p.lights[i].type == LightType::spot && p.lights[i].cos_outer < 0; });
       },
       {"cones_and_ranges"}},
      {"infinite_lights_have_no_mesh",
       [](PixelList p) { drop(p, [&](uint32_t i) { return std::isinf(p.lights[i].radius_m); }); },
       {"cones_and_ranges"}},
  };
}

// The library's light indices, spoiled.
class Spoiled : public LibraryEngine {
 public:
  explicit Spoiled(Spoil spoil) : spoil_(spoil) {}
  std::vector<ListImage> lists(const Scene& scene, const std::string& technique, std::span<const View> views,
                               const Settings& settings) override {
    std::vector<ListImage> images = library->lists(scene, technique, views, settings);
    for (size_t i = 0; i < images.size(); ++i) {
      const std::vector<ViewLight> lights = lights_in_view(scene, views[i]);
      const ListedLights before = std::move(images[i].lists);
      ListedLights& lists = images[i].lists = {.cell_of_pixel = before.cell_of_pixel};
      for (size_t cell = 0; cell < before.first.size(); ++cell) {
        const auto from = before.indices.begin() + std::ptrdiff_t(before.first[cell]);
        std::vector<uint32_t> indices(from, from + before.count[cell]);
        spoil_({lights, views[i], i, indices});
        lists.first.push_back(lists.indices.size());
        lists.count.push_back(uint32_t(indices.size()));
        lists.indices.insert(lists.indices.end(), indices.begin(), indices.end());
      }
    }
    return images;
  }

 private:
  Spoil spoil_;
};

struct FaultyLightIndices : testing::TestWithParam<LightIndexFault> {};

TEST_P(FaultyLightIndices, Fail) {
  Spoiled engine(GetParam().spoil);
  for (const std::string name : GetParam().by) {
    const auto chosen = chosen_cases("^lidr/" + name + "$");
    ASSERT_EQ(chosen.size(), 1u) << name;
    EXPECT_TRUE(fails(*chosen[0], engine, 0)) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Verify, FaultyLightIndices, testing::ValuesIn(light_index_faults()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lightgrid::lab::verify
