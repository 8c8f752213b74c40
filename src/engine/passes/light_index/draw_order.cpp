#include "passes/light_index/draw_order.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "passes/light_index/blending.h"
#include "passes/light_index/index_shadows.h"
#include "passes/light_index/lidr_settings.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"

namespace lightgrid {
namespace {

const Setting<bool> by_priority{
    370,
    "lidr-order",
    "the lights kept if a pixel has too many: the most important, or the scene's first",
    {{"priority", true}, {"scene", false}}};

LightExtent extent_in_space(const LightVolume& v) {
  return {v.center - v.radius, v.center + v.radius, v.center, v.radius};
}
LightExtent extent_on_screen(const LightVolume& v) {
  return {glm::dvec3(v.low_px, 0), glm::dvec3(v.high_px, 0)};
}

bool on_screen(const ViewState& seen) {
  return seen.plan.settings[setting::lidr_volumes] != LidrVolumes::stencil;
}

// Contains every mesh that a view draws for a light, whatever its distance, as long as slack is at most 1/64
// of the range (light_volumes.cpp). The coarsest ball has its corners at 1.263 of the radius; a box, and a
// cone moved back by slack / sin(angle), at 1.74.
double still_radius(const LightBounds& bounds, VolumeMeshes meshes) {
  const double angle = bounds.widened_angle_rad();
  const bool cone = angle < std::numbers::pi / 2 && meshes != VolumeMeshes::box;
  if (!cone) return bounds.radius_m * (meshes == VolumeMeshes::box ? 1.8 : 1.3);
  return bounds.radius_m * 1.8 * (1 + (1 + 1 / std::sin(angle)) / 64);
}

// In world space, so that they do not depend on the camera.
std::vector<LightExtent> still_extents(const ViewState& seen) {
  std::vector<LightExtent> extents;
  const Settings& settings = seen.plan.settings;
  const auto lights = lights_in_view(seen.scene, seen.view, ranges_of(settings), seen.plan.lights.local);
  for (size_t i = 0; i < lights.size(); ++i) {
    const glm::dvec3 at = seen.scene.lights[size_t(seen.plan.lights.local[i])].position;
    const double radius = still_radius(bounds_of(lights[i]), settings[setting::volume_mesh]);
    extents.push_back({at - radius, at + radius, at, radius});
  }
  return extents;
}

bool contains(const LightVolume& volume, double radius) {
  return glm::length(volume.center - volume.bounds.position) + volume.radius <= radius;
}

}  // namespace

LightIndexOrder::LightIndexOrder(PassContext& work)
    : layout_(light_index_layout(work.plan.settings, work.plan.lights.local.size(), share_bits_of(work))),
      group_of_light_(work.plan.lights.local.size(), no_group) {
  require_exact_blending(work, layout_);
  find_influence(work);
}

bool LightIndexOrder::follow(PassContext& work) {
  if (group_of_light_.size() != work.plan.lights.local.size()) return false;
  grouped_ = false;
  find_influence(work);
  return true;
}

void LightIndexOrder::find_influence(const ViewState& seen) {
  influence_.clear();
  type_.clear();
  for (const ViewLight& light :
       lights_in_view(seen.scene, seen.view, ranges_of(seen.plan.settings), seen.plan.lights.local)) {
    influence_.push_back(influence_of(light));
    type_.push_back(seen.plan.settings[setting::lidr_types] == LidrTypes::passes &&
                    light.type == LightType::spot);
  }
}

// Groups in all passes of a type.
static uint32_t groups_of_type(const LightIndexLayout& layout, const ViewState& seen) {
  return layout.groups * uint32_t(seen.plan.settings[setting::lidr_passes]);
}

// The groups of all lights in the scene. False if a volume is larger than its extent there: far away, where
// rounding is large.
bool LightIndexOrder::put_in_still_groups(const ViewState& seen, const std::vector<LightVolume>& volumes) {
  const Settings& settings = seen.plan.settings;
  for (const LightVolume& v : volumes) {
    if (!contains(v, still_radius(v.bounds, settings[setting::volume_mesh]))) return false;
  }
  const std::vector<LightExtent> extents = still_extents(seen);
  const uint32_t groups = groups_of_type(layout_, seen);
  for (uint32_t type = 0; type < light_types; ++type) {
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < type_.size(); ++i) {
      if (type_[i] == type) order.push_back(i);
    }
    if (settings[by_priority])
      std::ranges::stable_sort(order, [&](uint32_t a, uint32_t b) { return before(a, b); });
    const std::vector<uint32_t>& found = still_[type].of(extents, order, groups, layout_.slots);
    for (const uint32_t i : order)
      group_of_light_[i] = found[i] == no_group ? no_group : type * groups + found[i];
  }
  return true;
}

void LightIndexOrder::put_in_groups_of_view(const ViewState& seen, const std::vector<LightVolume>& volumes) {
  const uint32_t groups = groups_of_type(layout_, seen);
  for (uint32_t type = 0; type < light_types; ++type) {
    std::vector<LightExtent> extents;
    std::vector<uint32_t> lights;
    for (const LightVolume& v : volumes) {
      if (type_[v.light] != type) continue;
      extents.push_back(on_screen(seen) ? extent_on_screen(v) : extent_in_space(v));
      lights.push_back(v.light);
    }
    const std::vector<uint32_t> found = group_lights(extents, groups, layout_.slots);
    for (size_t i = 0; i < found.size(); ++i)
      group_of_light_[lights[i]] = found[i] == no_group ? no_group : type * groups + found[i];
  }
}

// With stencil, lights that do not touch in space share no pixel, whatever the camera; with front faces, the
// rectangles on screen must not touch.
void LightIndexOrder::put_in_groups(const ViewState& seen, std::vector<LightVolume>& volumes) {
  if (on_screen(seen) || !grouped_) {
    const bool still =
        seen.plan.settings[setting::lidr_sort] == LidrSort::still && put_in_still_groups(seen, volumes);
    if (!still) put_in_groups_of_view(seen, volumes);
  }
  grouped_ = true;
  const auto group = [&](const LightVolume& v) { return group_of_light_[v.light]; };
  std::erase_if(volumes, [&](const LightVolume& v) { return group(v) == no_group; });
  std::stable_sort(volumes.begin(), volumes.end(),
                   [&](const LightVolume& a, const LightVolume& b) { return group(a) < group(b); });
}

// Rounds in which no two volumes share a pixel, because the stencil marks one volume at a time. A single
// round if nothing is marked and each draw's channels are fixed.
std::vector<uint32_t> LightIndexOrder::rounds_of(const ViewState& seen,
                                                 const std::vector<LightVolume>& volumes) const {
  if (on_screen(seen) && (layout_.sorted() || layout_.groups == 1))
    return std::vector<uint32_t>(volumes.size(), 0);
  std::vector<LightExtent> extents;
  for (const LightVolume& v : volumes) extents.push_back(extent_on_screen(v));
  return draw_rounds(extents);
}

void LightIndexOrder::order(const ViewState& seen, std::vector<LightVolume> volumes) {
  const bool sorted = layout_.sorted();
  // Most influence first if lidr-order says so, else scene order.
  if (seen.plan.settings[by_priority]) {
    std::stable_sort(volumes.begin(), volumes.end(),
                     [&](const LightVolume& a, const LightVolume& b) { return before(a.light, b.light); });
  }
  if (sorted) put_in_groups(seen, volumes);
  const std::vector<uint32_t> rounds = rounds_of(seen, volumes);
  // Within a round of a group any order gives the same image; this one needs few calls. If there is only one
  // round, the order decides which lights are kept when slots run out.
  const bool any_order = sorted || !on_screen(seen) || layout_.groups > 1;
  const auto batch_of = [&](uint32_t i) {
    const uint32_t light = volumes[i].light;
    return std::tuple(sorted ? group_of_light_[light] : type_[light], rounds[i], volumes[i].crosses_near,
                      volumes[i].mesh);
  };
  std::vector<uint32_t> order(volumes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return any_order ? batch_of(a) < batch_of(b) : std::get<0>(batch_of(a)) < std::get<0>(batch_of(b));
  });
  batches_ = {};
  uint32_t last_pass = 0;  // lights without one count
  for (size_t i = 0; i < order.size(); ++i) {
    const auto [group, round, crosses, mesh] = batch_of(order[i]);
    const auto [last_group, last_round, last_crosses, last_mesh] = batch_of(order[i ? i - 1 : 0]);
    const uint32_t pass = sorted ? group / layout_.groups : group;
    if (i == 0) {
      batches_.passes = {{}};
    } else if (pass != last_pass) {
      batches_.passes.emplace_back();
    }
    last_pass = pass;
    if (i == 0 || group != last_group || round != last_round || crosses != last_crosses)
      batches_.batches.push_back(
          {i, 0, sorted ? group % layout_.groups : 0, uint32_t(batches_.passes.size()) - 1});
    ++batches_.batches.back().count;
    batches_.volumes.push_back(volumes[order[i]]);
    batches_.passes.back().points_alone &=
        seen.plan.settings[setting::lidr_types] == LidrTypes::passes && type_[volumes[order[i]].light] == 0;
  }
}

}  // namespace lightgrid
