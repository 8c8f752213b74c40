// Light groups (docs/light_groups.md): a light reaches only surfaces with which it shares a group. Files'
// names and lists of groups compile to masks (scene/light_groups.h).
#include "scene/light_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "plan/light_plan.h"
#include "renderer/loop_inputs.h"
#include "renderer/pass_context.h"
#include "shared/effects/light_groups.h"

namespace lightgrid {
namespace {

template <typename Owner>
bool lacks(const Owner& owner) {
  return groups_of(owner) != all_groups;
}

// Names the first light or instance without some group, and counts both.
std::string witness(const Scene& scene) {
  const auto light = std::ranges::find_if(scene.lights, lacks<Light>);
  const auto instance = std::ranges::find_if(scene.instances, lacks<Instance>);
  const std::string first =
      light != scene.lights.end()
          ? fmt::format("{} has {}", light_witness(scene, int(light - scene.lights.begin())),
                        words_of_groups(scene, groups_of(*light)))
          : fmt::format("node {} \"{}\" has {}", instance - scene.instances.begin(), instance->name,
                        words_of_groups(scene, groups_of(*instance)));
  std::set<uint32_t> masks;
  for (const Instance& i : scene.instances) masks.insert(groups_of(i));
  return fmt::format("{}; {} of {} lights and {} of {} instances lack a group, which have {} different masks",
                     first, std::ranges::count_if(scene.lights, lacks<Light>), scene.lights.size(),
                     std::ranges::count_if(scene.instances, lacks<Instance>), scene.instances.size(),
                     masks.size());
}

std::optional<EffectNeed> decide(const Scene& scene, const FramePlan&) {
  if (!calls_for_groups(scene))
    return EffectNeed{false, "not called for: every light and every instance has all groups"};
  return EffectNeed{true, witness(scene)};
}

LOOP_INPUTS(GroupsOfLights, LIGHT_GROUPS_MEETS_INPUTS);
LOOP_INPUTS(GroupsOfSurfaces, LIGHT_GROUPS_SURFACE_INPUTS);

class LightGroups : public EffectState {
 public:
  bool follow(PassContext&) override {
    followed_ = false;
    return true;
  }

  void before_lights(PassContext& work) override {
    if (followed_) return;
    put(work, lights_.light_groups, values_of_lights(work, groups_of<Light>), of_lights_);
    put(work, surfaces_.surface_groups, work.plan.masks.values, of_surfaces_);
    followed_ = true;
  }

  void bind() const override {
    lights_.bind();
    surfaces_.bind();
  }
  ClArguments reach_arguments() override { return lights_.arguments() + surfaces_.arguments(); }
  size_t memory_bytes() const override { return lights_.bytes() + surfaces_.bytes(); }

 private:
  // A camera that moves uploads nothing.
  static void put(PassContext& work, ColumnInput& to, std::vector<uint32_t> groups,
                  std::vector<uint32_t>& uploaded) {
    if (groups.empty()) groups.push_back(0);
    if (groups == uploaded) return;
    to.put(*work.renderer.cl, work.plan.opengl, "uploading light groups", groups);
    uploaded = std::move(groups);
  }

  GroupsOfLights lights_;
  GroupsOfSurfaces surfaces_;
  std::vector<uint32_t> of_lights_, of_surfaces_;
  bool followed_ = false;
};

std::unique_ptr<EffectState> make(PassContext&) { return std::make_unique<LightGroups>(); }

}  // namespace

extern constexpr Effect light_groups{
    .name = "light_groups",
    .decide = decide,
    .make = make,
    .reach = ReachOracle{.masks = {.of_light = [](const Light& light) { return groups_of(light); },
                                   .of_instance = [](const Instance& i) { return groups_of(i); }}}};

}  // namespace lightgrid
