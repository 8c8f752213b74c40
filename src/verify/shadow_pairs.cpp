#include "verify/shadow_pairs.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "reference/lit_set.h"
#include "reference/position.h"
#include "scene/view_lights.h"

namespace lightgrid::verify {
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
  for (int y = tile_y * side; y < std::min(view.height, (tile_y + 1) * side); ++y) {
    for (int x = tile_x * side; x < std::min(view.width, (tile_x + 1) * side); ++x) {
      const size_t pixel = view.grid().index(x, y);
      if (image.triangles[pixel].instance < 0) continue;
      const double depth = image.depths[pixel];
      tile.x.push_back(x), tile.y.push_back(y);
      tile.positions.push_back(position_from_depth(view, x, y, depth));
      tile.receivers.push_back(occlusion.receiver(view, x, y, depth, image.triangles[pixel]));
    }
  }
  return tile;
}

std::string words_of(const Light& light, int number, const TileReceivers& tile, size_t i,
                     const SightAnswer& answer, const char* fault) {
  const glm::dvec3& p = tile.receivers[i].place.place;
  const CastingTriangle &own = tile.receivers[i].own, &by = answer.by;
  std::string words = fmt::format(
      "light {} at {:.9g} {:.9g} {:.9g} {} at pixel {},{} on instance {} triangle {} at "
      "{:.9g} {:.9g} {:.9g}",
      number, light.position.x, light.position.y, light.position.z, fault, tile.x[i], tile.y[i], own.instance,
      own.triangle, p.x, p.y, p.z);
  if (by.instance >= 0)
    words += fmt::format(", hidden by instance {} triangle {} after {:.9g} m", by.instance, by.triangle,
                         answer.distance_m);
  return words;
}

void check_lists(const Scene& scene, const ShadowImage& image) {
  const std::string wrong = malformed_lists(image.shadows.cells, image.shadows.indices, image.lights.size());
  if (!wrong.empty()) throw input_error("shadows: {}", wrong);
  for (const uint32_t light : image.shadows.indices) {
    if (!scene.lights[size_t(image.lights[light])].casts_shadow)
      throw input_error("shadows: light {} casts none, but is listed", image.lights[light]);
  }
}

}  // namespace

ShadowPairs& ShadowPairs::operator+=(const ShadowPairs& more) {
  seen += more.seen, hidden += more.hidden, either += more.either;
  leaked += more.leaked, acned += more.acned;
  if (why.empty()) why = more.why;
  return *this;
}

ShadowPairs count_shadow_pairs(const Scene& scene, const Occlusion& occlusion, const View& view,
                               const ShadowImage& image) {
  check_lists(scene, image);
  const std::vector<ViewLight> lights = lights_in_view(scene, view, {}, image.lights);
  const int tiles_x = image.shadows.tiles_x, tiles = int(image.shadows.cells.size());
  std::vector<ShadowPairs> of_tile(static_cast<size_t>(tiles));
  parallel_for(tiles, [&](int t) {
    ShadowPairs& pairs = of_tile[size_t(t)];
    const TileReceivers tile = receivers_of(occlusion, view, image, t % tiles_x, t / tiles_x);
    for (size_t i = 0; i < lights.size(); ++i) {
      const Light& light = scene.lights[size_t(image.lights[i])];
      if (!light.casts_shadow) continue;
      int last = -1;
      for (size_t k = 0; k < tile.x.size(); ++k) {
        if (!is_lit(lights[i], tile.positions[k])) continue;
        const SightAnswer answer = occlusion.sight(light, tile.receivers[k], &last);
        if (answer.sight == Sight::either) {
          ++pairs.either;
          continue;
        }
        const bool hidden = answer.sight == Sight::hidden;
        ++(hidden ? pairs.hidden : pairs.seen);
        if (hidden_at(image.shadows, tile.x[k], tile.y[k], uint32_t(i)) == hidden) continue;
        ++(hidden ? pairs.leaked : pairs.acned);
        if (pairs.why.empty())
          pairs.why =
              words_of(light, image.lights[i], tile, k, answer, hidden ? "leaks" : "is dark, though seen,");
      }
    }
  });
  ShadowPairs sum;
  for (const ShadowPairs& pairs : of_tile) sum += pairs;
  return sum;
}

const char* difference(const ShadowImage& a, const ShadowImage& b) {
  if (a.triangles != b.triangles || a.depths != b.depths) return "surfaces";
  if (a.shadows.cells != b.shadows.cells || a.shadows.indices != b.shadows.indices) return "lists";
  return a.shadows.bits != b.shadows.bits ? "bits" : "";
}

}  // namespace lightgrid::verify
