// Light profiles (docs/profiles.md): the share of a light's intensity by direction, from a photometric file
// (scene/light_profiles.h).
#include "scene/light_profiles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.h"
#include "plan/light_plan.h"
#include "renderer/loop_inputs.h"
#include "renderer/pass_context.h"
#include "shared/effects/light_profiles.h"

namespace lightgrid {
namespace {

const Setting<bool> with_profiles{74,
                                  "light-profiles",
                                  "profiles of lights: intensity by direction, from photometric files",
                                  {{"on", true}, {"off", false}},
                                  {.model = true, .common = true, .of_lights = true, .shown_if_given = true}};

std::optional<EffectNeed> decide(const Scene& scene, const FramePlan& plan) {
  if (!plan.settings[with_profiles]) return {};
  return need_of_lights(scene, plan, [](const Light& light) { return profile_of(light) != nullptr; });
}

ReachTerm term(const Scene&, const Light& light, const LightRanges& ranges, const View& view) {
  const SharedTable profile = with_profiles.of(ranges) ? profile_of(light) : nullptr;
  if (!profile) return {};
  const glm::dmat3 from_world(view.view_from_world);
  const ProfileAxes axes = profile_axes(*profile, axes_of(light));
  const glm::dvec3 pole = from_world * axes.pole, first = from_world * axes.first,
                   second = from_world * axes.second;
  return [=](const glm::dvec3& from_light, uint32_t) {
    const double z = glm::dot(pole, from_light), x = glm::dot(first, from_light),
                 y = glm::dot(second, from_light), length = glm::length(from_light);
    const double degrees = 180 / std::numbers::pi;
    const double polar = length > 0 ? std::acos(std::clamp(z / length, -1.0, 1.0)) : 0;
    return glm::dvec3(profile_share(*profile, polar * degrees, std::atan2(y, x) * degrees));
  };
}

LightShare share(const Scene&, const Light&, const LightRanges&) {
  return {.largest = 1, .of_surface = false};
}

LOOP_INPUTS(LightProfilesInputs, LIGHT_PROFILES_REACH_INPUTS);

// A light's place in profile_shares is a float there.
constexpr size_t max_shares = size_t(1) << 24;

// The grids of all profiles, one behind the other.
struct ProfileGrids {
  struct Grid {
    ProfileGrid steps;  // without shares
    size_t first = 0;   // in `shares`
  };
  std::map<SharedTable, Grid> of;
  std::vector<float> shares{0};

  explicit ProfileGrids(const ViewState& seen) {
    for (const int i : seen.plan.lights.local) {
      const SharedTable profile = profile_of(seen.scene.lights[size_t(i)]);
      if (!profile || of.contains(profile)) continue;
      ProfileGrid grid = grid_of(*profile);
      of[profile].first = shares.size();
      shares.insert(shares.end(), grid.shares.begin(), grid.shares.end());
      grid.shares.clear();
      of[profile].steps = std::move(grid);
    }
    if (shares.size() > max_shares)
      throw input_error("{} light profiles take {} values; at most {} fit", of.size(), shares.size(),
                        max_shares);
  }
};

class LightProfiles : public LightInputs<LightProfilesInputs> {
  void fill(PassContext& work) override {
    const ProfileGrids grids(work);
    const glm::dmat3 from_world(work.view.view_from_world);
    put(work, inputs_.profile_lights, values_of_lights(work, [&](const Light& light) {
          return values_of(light, profile_of(light), grids, from_world);
        }));
    if (grids.shares != uploaded_) put(work, inputs_.profile_shares, grids.shares);
    uploaded_ = grids.shares;
  }

  static std::array<glm::vec4, 4> values_of(const Light& light, const SharedTable& profile,
                                            const ProfileGrids& grids, const glm::dmat3& from_world) {
    const ProfileAxes axes = profile ? profile_axes(*profile, axes_of(light)) : ProfileAxes{};
    const ProfileGrids::Grid grid = profile ? grids.of.at(profile) : ProfileGrids::Grid{};
    const ProfileGrid& steps = grid.steps;
    return {glm::vec4(from_world * axes.pole, profile ? float(grid.first) : -1.0f),
            glm::vec4(from_world * axes.first, float(steps.columns)),
            glm::vec4(from_world * axes.second, steps.front ? -float(steps.rows) : float(steps.rows)),
            ends_of(steps)};
  }

  static glm::vec4 ends_of(const ProfileGrid& grid) {
    const double angle = grid.last_rad - grid.first_rad;
    return {grid.first_rad, grid.rows / std::max(angle, 1e-9),
            grid.first_rad > 0 ? std::cos(grid.first_rad) : 2,
            grid.last_rad < std::numbers::pi ? std::cos(grid.last_rad) : -2};
  }

  template <typename Value>
  static void put(PassContext& work, ColumnInput& to, const std::vector<Value>& values) {
    to.put(*work.renderer.cl, work.plan.opengl, "uploading light profiles", values);
  }

  std::vector<float> uploaded_;
};

std::unique_ptr<EffectState> make(PassContext&) { return std::make_unique<LightProfiles>(); }

}  // namespace

extern constexpr Effect light_profiles{
    .name = "light_profiles", .decide = decide, .make = make, .reach = ReachOracle{term, share}};

}  // namespace lightgrid
