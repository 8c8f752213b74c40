#include "frontier/scene_views.h"

#include <fmt/format.h>

#include "scene/camera_path.h"

namespace lightgrid {
namespace {

// 0, n / 2, n / 4, 3 n / 4, …: van der Corput's sequence, in places of `count`.
std::vector<size_t> spread_order(size_t count) {
  std::vector<size_t> order;
  std::vector<bool> taken(count, false);
  for (size_t i = 0; order.size() < count; ++i) {
    double place = 0;
    double step = 0.5;
    for (size_t bits = i; bits > 0; bits >>= 1, step /= 2) place += double(bits & 1) * step;
    const size_t index = size_t(place * double(count));
    if (taken[index]) continue;
    taken[index] = true;
    order.push_back(index);
  }
  return order;
}

}  // namespace

std::vector<View> frontier_views(const Scene& scene, const View& start, const SceneChoice& choice,
                                 int count) {
  if (count == 1 && choice.camera_path.empty()) return {start};
  const std::string path = choice.camera_path.empty() ? fmt::format("turn:{}", count) : choice.camera_path;
  const std::vector<View> all = camera_path(scene, start, path);
  std::vector<View> views;
  for (const size_t i : spread_order(std::min(all.size(), size_t(count)))) {
    views.push_back(all[i * all.size() / std::min(all.size(), size_t(count))]);
  }
  return views;
}

std::vector<View> slow_turn(const Scene& scene, const View& start, int frames) {
  std::vector<View> views = camera_path(scene, start, "turn:1440");
  views.resize(size_t(frames));
  return views;
}

}  // namespace lightgrid
