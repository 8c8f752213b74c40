#include "session/leaks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/parallel.h"
#include "reference/lit_set.h"
#include "reference/occlusion.h"
#include "reference/position.h"
#include "reference/scene_surfaces.h"
#include "reference/triangle_tree.h"

namespace lightgrid {
namespace {

using glm::dvec3;

// The nearest opaque or masked triangle at a pixel's centre, and its depth there.
class Shown {
 public:
  Shown(const Scene& scene, const View& view) : scene_(scene), view_(view) {
    for (int i = 0; i < int(scene.instances.size()); ++i) {
      const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(i)].mesh)];
      if (scene.materials[size_t(mesh.material)].alpha_mode == AlphaMode::blend) continue;
      for (uint32_t t = 0; t < mesh.indices.size() / 3; ++t) numbers_.push_back({i, t});
    }
    std::vector<Corners> corners;
    for (const CastingTriangle& number : numbers_) {
      const Instance& instance = scene.instances[size_t(number.instance)];
      Corners& of = corners.emplace_back();
      for (size_t k = 0; k < 3; ++k) {
        const dvec3 p(scene.meshes[size_t(instance.mesh)].positions[vertices_of(number)[k]]);
        of[k] = dvec3(instance.world_from_object * glm::dvec4(p, 1));
      }
    }
    tree_ = TriangleTree(corners);
    const WorldBox box = world_box(scene);
    if (!box.empty()) far_m_ = 2 * (glm::length(box.max - box.min) + glm::length(view.eye - box.min));
  }

  struct Surface {
    CastingTriangle triangle;
    double depth = 0;
  };
  // `surfaces`: a thread's own.
  std::optional<Surface> at(SceneSurfaces& surfaces, int x, int y) const {
    const glm::dvec2 centre(x + 0.5, y + 0.5);
    const dvec3 across(view_x_of_pixel(view_, centre.x), view_y_of_pixel(view_, centre.y), 0);
    const dvec3 ahead = view_.orthographic ? dvec3(0, 0, -1) : glm::normalize(across + dvec3(0, 0, -1));
    const dvec3 from = view_.orthographic ? across : dvec3(0), to = from + ahead * far_m_;
    const auto in_world = [&](const dvec3& p) {
      return view_.eye + glm::transpose(glm::dmat3(view_.view_from_world)) * p;
    };
    std::optional<Surface> nearest;
    // The boxes' reach covers the rounding of the ray; the triangle decides.
    tree_.walk(in_world(from), in_world(to), 1e-9 * far_m_, [&](int number) {
      const CastingTriangle& triangle = numbers_[size_t(number)];
      if (const auto depth = depth_of(surfaces, triangle, centre);
          depth && (!nearest || *depth > nearest->depth))
        nearest = {triangle, *depth};
      return false;
    });
    return nearest;
  }

 private:
  std::array<uint32_t, 3> vertices_of(const CastingTriangle& t) const {
    const std::vector<uint32_t>& indices =
        scene_.meshes[size_t(scene_.instances[size_t(t.instance)].mesh)].indices;
    const size_t first = 3 * size_t(t.triangle);
    return {indices[first], indices[first + 1], indices[first + 2]};
  }

  // None where the triangle is not drawn.
  std::optional<double> depth_of(SceneSurfaces& surfaces, const CastingTriangle& t,
                                 const glm::dvec2& centre) const {
    const Instance& instance = scene_.instances[size_t(t.instance)];
    const Material& material = scene_.materials[size_t(scene_.meshes[size_t(instance.mesh)].material)];
    const TriangleInView triangle = surfaces.triangle(t.instance, vertices_of(t));
    const auto depth = surfaces.depth_at(triangle, centre);
    if (!depth || !(*depth > 0 && *depth <= 1)) return {};
    const bool mirrored = glm::determinant(glm::dmat3(instance.world_from_object)) < 0;
    if (!material.double_sided && (triangle.turn() < 0) != mirrored) return {};
    if (material.alpha_mode == AlphaMode::mask &&
        surfaces.base_color_at(triangle, centre).a < double(material.alpha_cutoff))
      return {};
    return depth;
  }

  const Scene& scene_;
  const View& view_;
  std::vector<CastingTriangle> numbers_;
  TriangleTree tree_;
  double far_m_ = 1;
};

struct Row {
  uint64_t pixels = 0, lit = 0, leaked = 0, either = 0;
  std::map<std::pair<int, int>, uint64_t> leaks;  // by light and instance
  std::map<std::pair<int, int>, Leaks::Received> received;
};

}  // namespace

Leaks find_leaks(const Scene& scene, const View& view, const LightRanges& ranges, int samples) {
  const std::vector<ViewLight> lights = lights_in_view(scene, view, ranges);
  const Occlusion occlusion(scene);
  const Shown shown(scene, view);
  const int step = std::max(1, int(std::sqrt(double(view.width) * view.height / samples)));
  std::vector<Row> rows(size_t((view.height + step - 1) / step));
  parallel_for(int(rows.size()), [&](int r) {
    Row& row = rows[size_t(r)];
    SceneSurfaces surfaces(scene, view);
    std::vector<int> last(lights.size(), -1);
    const int y = std::min(r * step + step / 2, view.height - 1);
    for (int x = step / 2; x < view.width; x += step) {
      const auto surface = shown.at(surfaces, x, y);
      if (!surface) continue;
      ++row.pixels;
      const dvec3 position = position_from_depth(view, x, y, surface->depth);
      const Receiver receiver = occlusion.receiver(view, x, y, surface->depth, surface->triangle);
      for (int i = 0; i < int(lights.size()); ++i) {
        const Light& light = scene.lights[size_t(i)];
        const uint32_t groups = scene.instances[size_t(receiver.own.instance)].groups;
        if (light.casts_shadow || !is_lit(lights[size_t(i)], position, groups)) continue;
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
    all.pixels += row.pixels, all.lit += row.lit, all.leaked += row.leaked, all.either += row.either;
    for (const auto& [pair, pixels] : row.leaks) leaks[pair] += pixels;
    for (const auto& [pair, of] : row.received) {
      Leaks::Received& sum = received[pair];
      sum.seen += of.seen, sum.leaked += of.leaked;
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

}  // namespace lightgrid
