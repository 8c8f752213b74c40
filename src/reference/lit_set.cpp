#include "reference/lit_set.h"

#include <algorithm>
#include <cassert>
#include <mutex>
#include <numeric>

#include "reference/attenuation.h"
#include "reference/pixel_tiles.h"
#include "reference/position.h"

namespace lightgrid {

namespace {

// Sums over the pixels of one tile.
struct Tally {
  uint64_t listed = 0, lit = 0, lost = 0, wrong = 0;
};

// The set of lights of the current list. Marks are never cleared: each list has its own mark.
class Membership {
 public:
  explicit Membership(size_t lights) : mark_of_light_(lights, 0) {}

  // Returns the number of entries that are no light or a repetition.
  uint64_t read(const ListedLights& lists, uint32_t cell) {
    ++mark_;
    if (cell >= lists.count.size() || cell >= lists.first.size()) return 1;
    const uint64_t begin = lists.first[cell], end = begin + lists.count[cell];
    const uint64_t readable_end = std::clamp<uint64_t>(lists.indices.size(), begin, end);
    uint64_t wrong = end - readable_end;
    for (uint64_t i = begin; i < readable_end; ++i) {
      const uint32_t light = lists.indices[i];
      if (light >= mark_of_light_.size() || has(light)) {
        ++wrong;
      } else {
        mark_of_light_[light] = mark_;
      }
    }
    return wrong;
  }

  bool has(uint32_t light) const { return mark_of_light_[light] == mark_; }

 private:
  std::vector<uint32_t> mark_of_light_;
  uint32_t mark_ = 0;
};

uint32_t cell_of(const ListedLights& lists, uint32_t pixel) {
  return lists.cell_of_pixel.empty() ? 0 : lists.cell_of_pixel[pixel];
}

uint32_t length_of_list(const ListedLights& lists, uint32_t cell) {
  return cell < lists.count.size() ? lists.count[cell] : 0;
}

Tally tally_tile(const TileOfPixels& tile, const std::vector<uint32_t>& covered,
                 const std::vector<ViewLight>& lights, const ListedLights& lists, LitPairs& out) {
  std::vector<size_t> order(tile.indices.size());
  std::iota(order.begin(), order.end(), size_t(0));
  const auto cell_at = [&](size_t i) { return cell_of(lists, covered[tile.indices[i]]); };
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return cell_at(a) < cell_at(b); });
  std::vector<uint32_t> pixels;
  std::vector<glm::dvec3> positions;
  for (const size_t i : order)
    pixels.push_back(covered[tile.indices[i]]), positions.push_back(tile.positions[i]);

  Tally tally;
  Membership listed(lights.size());
  for (size_t begin = 0, end = 0; begin < pixels.size(); begin = end) {
    const uint32_t cell = cell_of(lists, pixels[begin]);
    while (end < pixels.size() && cell_of(lists, pixels[end]) == cell) ++end;
    tally.wrong += listed.read(lists, cell) * (end - begin);
    tally.listed += uint64_t(length_of_list(lists, cell)) * (end - begin);
    for (size_t i = begin; i < end; ++i) out.listed_of_pixel[pixels[i]] = length_of_list(lists, cell);
    for (uint32_t light : tile.lights) {
      uint64_t lit = 0;
      for (size_t i = begin; i < end; ++i) {
        const bool reaches = is_lit(lights[light], positions[i]);
        out.lit_of_pixel[pixels[i]] += reaches;
        if (!listed.has(light)) out.lost_of_pixel[pixels[i]] += reaches;
        lit += reaches;
      }
      tally.lit += lit;
      if (!listed.has(light)) tally.lost += lit;
    }
  }
  return tally;
}

}  // namespace

bool is_lit(const ViewLight& light, const glm::dvec3& position) {
  if (is_directional(light)) return true;
  const glm::dvec3 offset = position - light.position;
  const double distance = length_of(offset.x, offset.y, offset.z);
  if (!(distance < light.radius_m)) return false;
  if (has_cone(light) && !(cos_from_axis(light, offset, distance) > light.cos_outer)) return false;
  return light_reaches(light, position, no_instance) > 0;
}

std::vector<uint32_t> lit_lights(const std::vector<ViewLight>& lights, const glm::dvec3& position) {
  std::vector<uint32_t> lit;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (is_lit(lights[i], position)) lit.push_back(i);
  }
  return lit;
}

LitPairs count_pairs(const View& view, const std::vector<float>& depth, const std::vector<ViewLight>& lights,
                     const ListedLights& lists) {
  assert(depth.size() == view.grid().values());
  assert(lists.cell_of_pixel.empty() || lists.cell_of_pixel.size() == depth.size());
  const std::vector<uint32_t> none(depth.size(), 0);
  LitPairs out{none, none, none};
  const std::vector<uint32_t> covered = covered_pixels(depth);
  std::mutex adding;
  const auto position_of = [&](uint32_t p) {
    return position_from_depth(view, int(p) % view.width, int(p) / view.width, depth[p]);
  };
  for_each_tile(view.width, covered, position_of, lights, [&](const TileOfPixels& tile) {
    const Tally tally = tally_tile(tile, covered, lights, lists, out);
    std::lock_guard lock(adding);
    out.listed += tally.listed, out.lit += tally.lit, out.lost += tally.lost, out.wrong += tally.wrong;
  });
  return out;
}

}  // namespace lightgrid
