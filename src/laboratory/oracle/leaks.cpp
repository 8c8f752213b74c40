#include "oracle/leaks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/parallel.h"
#include "oracle/lit_set.h"
#include "oracle/occlusion.h"
#include "oracle/position.h"
#include "oracle/primary_rays.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;

struct Row {
  uint64_t pixels = 0, lit = 0, leaked = 0, either = 0;
  std::map<std::pair<int, int>, uint64_t> leaks;  // by light and instance
  std::map<std::pair<int, int>, Leaks::Received> received;
};

}  // namespace

Leaks find_leaks(const Scene& scene, const View& view, const LightRanges& ranges, int samples) {
  const std::vector<ViewLight> lights = lights_in_view(scene, view, ranges);
  const Occlusion occlusion(scene);
  const PrimaryRays shown(scene, view);
  const int step = std::max(1, int(std::sqrt(double(view.width) * view.height / samples)));
  std::vector<Row> rows(size_t((view.height + step - 1) / step));
  parallel_for(int(rows.size()), [&](int r) {
    Row& row = rows[size_t(r)];
    SceneSurfaces surfaces(scene, view);
    std::vector<int> last(lights.size(), -1);
    const int y = std::min(r * step + step / 2, view.height - 1);
    for (int x = step / 2; x < view.width; x += step) {
      const auto surface = shown.at(surfaces, {x + 0.5, y + 0.5});
      if (!surface) continue;
      ++row.pixels;
      const dvec3 position = position_from_depth(view, x, y, surface->depth);
      const Receiver receiver = occlusion.receiver(view, x, y, surface->depth, surface->triangle);
      for (int i = 0; i < int(lights.size()); ++i) {
        const Light& light = scene.lights[size_t(i)];
        const uint32_t mask = mask_of(scene.instances[size_t(receiver.own.instance)]);
        if (light.casts_shadow || !is_lit(lights[size_t(i)], position, mask)) continue;
        const SightAnswer answer = occlusion.sight(light, receiver, &last[size_t(i)]);
        if (answer.sight == Sight::hidden && answer.by == receiver.own) continue;
        ++row.lit;
        row.either += answer.sight == Sight::either;
        Leaks::Received& received = row.received[{i, receiver.own.instance}];
        ++(answer.sight == Sight::hidden ? received.leaked : received.seen);
        if (answer.sight != Sight::hidden) continue;
        ++row.leaked;
        ++row.leaks[{i, answer.by.instance}];
      }
    }
  });
  Leaks all;
  std::map<std::pair<int, int>, uint64_t> leaks;
  std::map<std::pair<int, int>, Leaks::Received> received;
  for (const Row& row : rows) {
    all.pixels += row.pixels;
    all.lit += row.lit;
    all.leaked += row.leaked;
    all.either += row.either;
    for (const auto& [pair, pixels] : row.leaks) leaks[pair] += pixels;
    for (const auto& [pair, of] : row.received) {
      Leaks::Received& sum = received[pair];
      sum.seen += of.seen;
      sum.leaked += of.leaked;
    }
  }
  for (const auto& [pair, of] : received)
    all.received.push_back({pair.first, pair.second, of.seen, of.leaked});
  for (const auto& [pair, pixels] : leaks) all.leaks.push_back({pair.first, pair.second, pixels});
  std::ranges::stable_sort(all.leaks, std::ranges::greater(), &Leak::pixels);
  return all;
}

std::string describe(const Leaks& leaks, const Scene& scene, size_t most) {
  std::string text = fmt::format(
      "light through walls: {} of {} lit pairs of {} sampled pixels and the lights that cast no shadow\n",
      leaks.leaked, leaks.lit, leaks.pixels);
  for (size_t i = 0; i < std::min(most, leaks.leaks.size()); ++i) {
    const Leak& leak = leaks.leaks[i];
    text += fmt::format("  light {} \"{}\" shines through node {} \"{}\": {} pixels\n", leak.light,
                        scene.lights[size_t(leak.light)].name, leak.instance,
                        scene.instances[size_t(leak.instance)].name, leak.pixels);
  }
  if (leaks.leaks.size() > most) text += fmt::format("  and {} more\n", leaks.leaks.size() - most);
  return text;
}

}  // namespace lightgrid::lab
