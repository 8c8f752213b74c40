#include "verify/shadow_pairs.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "scene/view_lights.h"

namespace lightgrid::lab::verify {
namespace {

// A tile of the image, and what the oracle needs to know of its pixels.
struct TileReceivers {
  std::vector<int> x, y;
  std::vector<glm::dvec3> positions;  // view space
  std::vector<Receiver> receivers;
};

TileReceivers receivers_of(const Occlusion& occlusion, const View& view, const ShadowImage& image, int tile_x,
                           int tile_y) {
  constexpr int side = HostShadows::side;
  TileReceivers tile;
  for (int i = 0; i < side * side; ++i) {  // in blocks of 4 x 4
    const int x = tile_x * side + i / 16 % 4 * 4 + i % 4, y = tile_y * side + i / 64 * 4 + i / 4 % 4;
    if (x >= view.width || y >= view.height) continue;
    const size_t pixel = view.grid().index(x, y);
    if (image.triangles[pixel].instance < 0) continue;
    const double depth = image.depths[pixel];
    tile.x.push_back(x);
    tile.y.push_back(y);
    tile.positions.push_back(lab::position_from_depth(view, x, y, depth));
    tile.receivers.push_back(occlusion.receiver(view, x, y, depth, image.triangles[pixel]));
  }
  return tile;
}

void check_lists(const Scene& scene, const ShadowImage& image) {
  const std::string wrong = malformed_lists(image.shadows.cells, image.shadows.indices, image.lights.size());
  if (!wrong.empty()) throw input_error("shadows: {}", wrong);
  for (const uint32_t light : image.shadows.indices) {
    if (!scene.lights[size_t(image.lights[light])].casts_shadow)
      throw input_error("shadows: light {} casts none, but is listed", image.lights[light]);
  }
}

constexpr size_t block = 16;  // pixels per side of a tile's block, in which the oracle shares work

struct TileLight {
  const Light& light;
  int number;  // number in the scene
  const ViewLight& in_view;
  uint32_t index;  // in lists
};

std::string words_of(const TileLight& l, const TileReceivers& tile, size_t i, const SightAnswer& answer,
                     const char* fault) {
  const glm::dvec3& p = tile.receivers[i].place.place;
  const CastingTriangle &own = tile.receivers[i].own, &by = answer.by;
  std::string words = fmt::format(
      "light {} at {:.9g} {:.9g} {:.9g} {} at pixel {},{} on instance {} triangle {} at "
      "{:.9g} {:.9g} {:.9g}",
      l.number, l.light.position.x, l.light.position.y, l.light.position.z, fault, tile.x[i], tile.y[i],
      own.instance, own.triangle, p.x, p.y, p.z);
  if (by.instance >= 0)
    words += fmt::format(", hidden by instance {} triangle {} after {:.9g} m", by.instance, by.triangle,
                         answer.distance_m);
  return words;
}

void add_pair(ShadowPairs& pairs, const ShadowImage& image, const TileReceivers& tile, const TileLight& l,
              size_t k, const SightAnswer& answer) {
  if (answer.sight == Sight::either) {
    ++pairs.either;
    return;
  }
  const bool hidden = answer.sight == Sight::hidden;
  ++(hidden ? pairs.hidden : pairs.seen);
  if (hidden_at(image.shadows, tile.x[k], tile.y[k], l.index) == hidden) return;
  ++(hidden ? pairs.leaked : pairs.acned);
  if (pairs.why.empty()) pairs.why = words_of(l, tile, k, answer, hidden ? "leaks" : "is dark, though seen,");
}

// A block of a tile's pixels.
void add_block(std::vector<ShadowPairs>& pairs, const Occlusion& occlusion,
               const std::vector<const ShadowImage*>& images, const TileReceivers& tile, const TileLight& l,
               size_t begin, int* last) {
  size_t pixels[block], count = 0;
  const Receiver* receivers[block];
  SightAnswer answers[block];
  for (size_t k = begin; k < std::min(begin + block, tile.x.size()); ++k) {
    if (is_lit(l.in_view, tile.positions[k])) {
      pixels[count] = k;
      receivers[count++] = &tile.receivers[k];
    }
  }
  occlusion.sights(l.light, {receivers, count}, answers, last);
  for (size_t i = 0; i < count; ++i) {
    for (size_t of = 0; of < images.size(); ++of)
      add_pair(pairs[of], *images[of], tile, l, pixels[i], answers[i]);
  }
}

}  // namespace

ShadowPairs& ShadowPairs::operator+=(const ShadowPairs& more) {
  seen += more.seen;
  hidden += more.hidden;
  either += more.either;
  leaked += more.leaked;
  acned += more.acned;
  if (why.empty()) why = more.why;
  return *this;
}

ShadowPairs count_shadow_pairs(const Scene& scene, const Occlusion& occlusion, const View& view,
                               const ShadowImage& image) {
  return count_shadow_pairs(scene, occlusion, view, std::vector{&image}).front();
}

std::vector<ShadowPairs> count_shadow_pairs(const Scene& scene, const Occlusion& occlusion, const View& view,
                                            const std::vector<const ShadowImage*>& images) {
  for (const ShadowImage* image : images) check_lists(scene, *image);
  const ShadowImage& first = *images.front();
  const std::vector<ViewLight> lights = lights_in_view(scene, view, {}, first.lights);
  const int tiles_x = first.shadows.tiles_x, tiles = int(first.shadows.cells.size());
  std::vector<std::vector<ShadowPairs>> of_tile(size_t(tiles), std::vector<ShadowPairs>(images.size()));
  parallel_for(tiles, [&](int t) {
    const TileReceivers tile = receivers_of(occlusion, view, first, t % tiles_x, t / tiles_x);
    for (size_t i = 0; i < lights.size(); ++i) {
      const Light& light = scene.lights[size_t(first.lights[i])];
      if (!light.casts_shadow) continue;
      const TileLight here{light, first.lights[i], lights[i], uint32_t(i)};
      int last = -1;
      for (size_t k = 0; k < tile.x.size(); k += block)
        add_block(of_tile[size_t(t)], occlusion, images, tile, here, k, &last);
    }
  });
  std::vector<ShadowPairs> sums(images.size());
  for (const auto& pairs : of_tile) {
    for (size_t of = 0; of < images.size(); ++of) sums[of] += pairs[of];
  }
  return sums;
}

bool same_surfaces_and_lights(const ShadowImage& a, const ShadowImage& b) {
  return a.triangles == b.triangles && a.depths == b.depths && a.lights == b.lights;
}

const char* difference(const ShadowImage& a, const ShadowImage& b) {
  if (a.triangles != b.triangles || a.depths != b.depths) return "surfaces";
  if (a.shadows.cells != b.shadows.cells || a.shadows.indices != b.shadows.indices) return "lists";
  return a.shadows.bits != b.shadows.bits ? "bits" : "";
}

}  // namespace lightgrid::lab::verify
