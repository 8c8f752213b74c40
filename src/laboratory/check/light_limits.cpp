#include "check/light_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>

#include "check/light_cells.h"
#include "plan/visibility.h"
#include "scene/effect_terms.h"
#include "scene/hidden.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;
using Lights = std::vector<int>;  // indices in the scene

struct SeenObject {
  int instance;       // its first
  LightBox box;       // world
  uint32_t mask = 0;  // of all of its instances together
};

LightBox box_of_instance(const Scene& scene, int instance, const glm::dmat4& space_from_world) {
  const Instance& owner = scene.instances[size_t(instance)];
  const Aabb& bounds = scene.meshes[size_t(owner.mesh)].bounds;
  LightBox box;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 corner(i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                            i & 4 ? bounds.max.z : bounds.min.z, 1);
    const dvec3 at(space_from_world * owner.world_from_object * corner);
    box.min = glm::min(box.min, at);
    box.max = glm::max(box.max, at);
  }
  return box;
}

// A cone that points away from a side of the view from outside of it is not seen, nor is a ball outside.
bool is_seen(const Frustum& frustum, const ViewLight& light) {
  if (!may_see_sphere(frustum, light.position, light.radius_m)) return false;
  if (!has_cone(light) || light.cos_outer <= 0) return true;
  for (int i = 0; i < frustum.count; ++i) {
    const dvec3 normal(frustum.planes[i]);
    const double inward = glm::dot(normal, light.direction);
    const bool outside = glm::dot(normal, light.position) + frustum.planes[i].w < 0;
    if (outside && inward < 0 && 1 - inward * inward < light.cos_outer * light.cos_outer) return false;
  }
  return true;
}

// A frame as engines see it.
struct LimitFrame {
  const Scene& scene;
  const View& view;
  std::vector<ViewLight> in_view;
  std::vector<LightBounds> in_world;
  Lights all, seen;  // directional lights are in `all`
  std::vector<SeenObject> objects;
  std::vector<LightBox> view_boxes;  // instances in view, in view space

  LimitFrame(const Scene& scene, const View& view, const LightRanges& ranges, double range_factor)
      : scene(scene), view(view), in_view(lights_in_view(scene, view, ranges)) {
    for (ViewLight& light : in_view) light.radius_m *= range_factor;
    const Frustum frustum = frustum_of(view);
    for (size_t i = 0; i < in_view.size(); ++i) {
      in_world.push_back(bounds_of(scene.lights[i], in_view[i].radius_m));
      const glm::dvec3& intensity = in_view[i].radiant_intensity;
      if (!(in_view[i].radius_m > 0) || !(intensity.r + intensity.g + intensity.b > 0)) continue;
      all.push_back(int(i));
      if (!is_directional(in_view[i]) && is_seen(frustum, in_view[i])) seen.push_back(int(i));
    }
    const std::vector<int> firsts = objects_of(scene);
    std::map<int, SeenObject> found;
    for (int i = 0; i < int(firsts.size()); ++i) {
      const Instance& instance = scene.instances[size_t(i)];
      const Aabb& bounds = scene.meshes[size_t(instance.mesh)].bounds;
      if (is_hidden(instance) ||
          !may_see_box(frustum, view_from_object(view, instance.world_from_object), bounds))
        continue;
      view_boxes.push_back(box_of_instance(scene, i, view.view_from_world));
      found.try_emplace(firsts[size_t(i)], SeenObject{firsts[size_t(i)], {}});
    }
    for (int i = 0; i < int(firsts.size()); ++i) {  // parts that are out of view belong to the object
      const auto object = found.find(firsts[size_t(i)]);
      if (object == found.end()) continue;
      const LightBox box = box_of_instance(scene, i, glm::dmat4(1));
      object->second.box.min = glm::min(object->second.box.min, box.min);
      object->second.box.max = glm::max(object->second.box.max, box.max);
      object->second.mask |= mask_of(scene.instances[size_t(i)]);
    }
    for (const auto& [first, object] : found) objects.push_back(object);
  }
};

void set_order(const EngineLimit& limit, const LimitFrame& frame, Lights& lights) {
  const LimitOrder order = limit.order;
  const auto light = [&](int i) -> const ViewLight& { return frame.in_view[size_t(i)]; };
  if (order == LimitOrder::nearest)
    std::ranges::stable_sort(lights, {}, [&](int i) { return glm::length(light(i).position); });
  if (order == LimitOrder::farthest)
    std::ranges::stable_sort(lights, {}, [&](int i) { return as_listed(limit.cells, light(i)).position.z; });
  if (order == LimitOrder::points_first)
    std::ranges::stable_sort(lights, {}, [&](int i) { return has_cone(light(i)); });
}

// Counts of one limit in one frame.
class LimitCount {
 public:
  // numbers: of the lights in LimitResult::dropped.
  LimitCount(const LimitFrame& frame, size_t number, LimitResult& result,
             std::unordered_map<int, size_t>& numbers)
      : frame_(frame), limit_(*result.limit), number_(number), result_(result), numbers_(numbers) {}

  // kept: the lights that the engine's earlier limits left. What this one drops from the view is removed.
  void run(Lights& kept) {
    const Lights lights = of_kinds(limit_.of == LimitOf::scene  ? frame_.all
                                   : limit_.of == LimitOf::seen ? frame_.seen
                                                                : kept);
    switch (limit_.scope) {
      case LimitScope::view:
        return drop_from(kept, take({}, lights));
      case LimitScope::mesh:
        return meshes(lights);
      case LimitScope::cell:
        return cells(lights);
      case LimitScope::pool:
        return pool(lights);
      case LimitScope::distance:
        return drop_from(kept, distance(lights));
    }
  }

  void finish() {
    if (over_ == 0) return;
    ++result_.frames_over;
    result_.places_over += over_;
    result_.over.push_back(worst_over_);
    const bool whole = limit_.scope == LimitScope::view || limit_.scope == LimitScope::distance;
    if (whole && result_.worst.frame == number_) result_.lost = lost_;
  }

 private:
  Lights of_kinds(const Lights& lights) const {
    Lights found;
    std::ranges::copy_if(lights, std::back_inserter(found), [&](int i) {
      const ViewLight& light = frame_.in_view[size_t(i)];
      if (limit_.kinds == LimitKinds::every) return true;
      return !is_directional(light) && (limit_.kinds != LimitKinds::points || !has_cone(light));
    });
    return found;
  }

  static void drop_from(Lights& kept, Lights dropped) {
    std::ranges::sort(dropped);
    std::erase_if(kept, [&](int i) { return std::ranges::binary_search(dropped, i); });
  }

  // The lights that a place with these lights drops. Points and spots apart, where they count so.
  Lights take(LimitPlace place, const Lights& lights) {
    if (limit_.kinds != LimitKinds::each) return take_kind(place, lights);
    Lights kinds[2], dropped;
    const size_t over_before = over_;
    for (const int i : lights) kinds[has_cone(frame_.in_view[size_t(i)])].push_back(i);
    for (int spots = 0; spots < 2; ++spots) {
      place.kind = spots ? "spots" : "points";
      for (const int i : take_kind(place, kinds[spots])) dropped.push_back(i);
    }
    over_ = std::min(over_, over_before + 1);  // one place, even if both kinds are over
    return dropped;
  }

  Lights take_kind(LimitPlace place, Lights lights) {
    note(place, lights.size());
    if (lights.size() <= result_.most) return {};
    set_order(limit_, frame_, lights);
    lights.erase(lights.begin(), lights.begin() + std::ptrdiff_t(result_.most));
    drop(place, lights);
    return lights;
  }

  void note(LimitPlace& place, size_t counted) {
    place.frame = number_;
    place.counted = counted;
    if (counted > result_.worst.counted) result_.worst = place;
  }

  void drop(LimitPlace place, const Lights& lights) {
    ++over_;
    if (place.counted > worst_over_.counted) worst_over_ = place;
    lost_.insert(lost_.end(), lights.begin(), lights.end());
    for (const int i : lights) {
      const auto [at, is_new] = numbers_.try_emplace(i, result_.dropped.size());
      if (is_new)
        result_.dropped.push_back({i, place, 1});
      else
        ++result_.dropped[at->second].places;
    }
  }

  void meshes(const Lights& lights) {
    for (const SeenObject& object : frame_.objects) {
      Lights reaching;
      std::ranges::copy_if(lights, std::back_inserter(reaching), [&](int i) { return reaches(object, i); });
      take({.instance = object.instance}, reaching);
    }
  }

  bool reaches(const SeenObject& object, int i) const {
    const LightBounds& light = frame_.in_world[size_t(i)];
    if ((mask_of(frame_.scene.lights[size_t(i)]) & object.mask) == 0) return false;
    if (limit_.reach == LimitReach::always || is_directional(frame_.in_view[size_t(i)])) return true;
    if (limit_.reach == LimitReach::range) return meets(object.box, light.position, light.radius_m);
    return meets(object.box, box_of_light(light));
  }

  void cells(const Lights& lights) {
    each_cell(limit_.cells, frame_.view, frame_.in_view, lights,
              [&](const glm::ivec3& cell, const LightBox& box, const Lights& of_cell) {
                if (of_cell.size() > std::min(result_.most, result_.worst.counted) && shows_surface(box))
                  take({.cell = cell}, of_cell);
              });
  }

  // Cells in empty space drop lights that nobody misses.
  bool shows_surface(const LightBox& cell) const {
    return std::ranges::any_of(frame_.view_boxes, [&](const LightBox& box) { return meets(box, cell); });
  }

  // Which entries are lost depends on the order of threads: all lights may be.
  void pool(const Lights& lights) {
    size_t entries = 0;
    const glm::ivec3 cells =
        each_cell(limit_.cells, frame_.view, frame_.in_view, lights,
                  [&](const glm::ivec3&, const LightBox&, const Lights& list) { entries += list.size(); });
    LimitPlace place;
    result_.most = size_t(limit_.most) * size_t(cells.x) * size_t(cells.y) * size_t(cells.z);
    note(place, entries);
    if (entries > result_.most) drop(place, lights);
  }

  Lights distance(const Lights& lights) {
    Lights beyond;
    std::ranges::copy_if(lights, std::back_inserter(beyond), [&](int i) {
      const ViewLight& light = frame_.in_view[size_t(i)];
      return light.position.z + light.radius_m < -limit_.most;
    });
    LimitPlace place;
    note(place, beyond.size());
    if (!beyond.empty()) drop(place, beyond);
    return beyond;
  }

  const LimitFrame& frame_;
  const EngineLimit& limit_;
  size_t number_;
  LimitResult& result_;
  std::unordered_map<int, size_t>& numbers_;
  size_t over_ = 0;
  LimitPlace worst_over_;
  Lights lost_;
};

}  // namespace

std::vector<int> objects_of(const Scene& scene) {
  std::vector<int> firsts;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Instance* before = i > 0 ? &scene.instances[i - 1] : nullptr;
    const bool same = before && before->name == instance.name && before->node == instance.node &&
                      before->world_from_object == instance.world_from_object &&
                      before->mesh != instance.mesh;
    firsts.push_back(same ? firsts.back() : int(i));
  }
  return firsts;
}

LightCheck::LightCheck(const std::vector<const EngineLimit*>& limits, const LightRanges& ranges,
                       double range_factor)
    : ranges_(ranges), range_factor_(range_factor), numbers_(limits.size()) {
  for (const EngineLimit* limit : limits) {
    LimitResult& result = results_.emplace_back();
    result.limit = limit;
    result.most = size_t(limit->most);
  }
}

void LightCheck::count(const Scene& scene, const View& view) {
  const LimitFrame frame(scene, view, ranges_, range_factor_);
  Lights kept;
  const char* engine = "";
  for (size_t i = 0; i < results_.size(); ++i) {
    LimitResult& result = results_[i];
    if (std::string(engine) != result.limit->engine) kept = frame.seen;
    engine = result.limit->engine;
    LimitCount count(frame, frame_, result, numbers_[i]);
    count.run(kept);
    count.finish();
    ++result.frames;
  }
  ++frame_;
}

std::vector<LimitResult> LightCheck::results() const {
  std::vector<LimitResult> results = results_;
  for (LimitResult& result : results) std::ranges::sort(result.dropped, {}, &DroppedLight::light);
  return results;
}

std::optional<LimitPicture> limit_picture(const EngineLimit& limit, const Scene& scene, std::string& why) {
  const auto has = [&](bool spots) {
    return std::ranges::any_of(scene.lights,
                               [&](const Light& l) { return !is_directional(l) && has_cone(l) == spots; });
  };
  LimitPicture picture{"visibility", "visibility", true, ""};
  if (limit.scope == LimitScope::view && limit.order == LimitOrder::nearest) {
    picture.limited = fmt::format("visibility:view-cap={}", limit.most);
    picture.without_lost = false;
  }
  if (limit.scope == LimitScope::view || limit.scope == LimitScope::distance) return picture;
  picture.without_lost = false;
  if (limit.scope == LimitScope::pool)
    why = "list-cap is of one list, not of all together";
  else if (limit.cells == LimitCells::three)
    why = "list-cap-order has none that keeps the farthest lights";
  else if (limit.reach == LimitReach::always)
    why = "list-cap leaves out lights that do not reach a mesh, before it counts";
  else if (limit.kinds == LimitKinds::each && has(false) && has(true))
    why = "list-cap counts points and spots together";
  else if (limit.cells == LimitCells::unreal)
    picture = {"visibility", fmt::format("visibility:tile=64,slices=32,list-cap={}", limit.most), false,
               "The picture's slices are not the engine's."};
  else
    picture = {"forward_zprepass", fmt::format("forward_zprepass:list-cap={}", limit.most), false, ""};
  if (!why.empty()) return {};
  const std::vector<int> firsts = objects_of(scene);
  const auto is_part = [&](size_t i) { return firsts[i] != int(i); };
  if (limit.scope == LimitScope::mesh &&
      std::ranges::any_of(std::views::iota(size_t(0), firsts.size()), is_part))
    picture.note =
        "In the picture each primitive has this room, in the engine all primitives of a node together.";
  return picture;
}

}  // namespace lightgrid::lab
