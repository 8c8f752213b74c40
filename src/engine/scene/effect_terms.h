// The share of lights that effects (plan/effect.h) let through, in double: the oracle of their hook
// NAME_reach (shared/inputs.h), and bounds for the code that reads lights outside of light loops.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "scene/light_ranges.h"

namespace lightgrid {

struct View;

// The mask of a light or a surface for which no effect has one.
inline constexpr uint32_t full_mask = 0xffffffffu;

// The part of a light, 0 to 1 for red, green and blue, that passes to the point at `from_light`, metres from the light, of a surface
// with this mask, besides what masks decide. Directional lights have no place: `from_light` is then where
// their light travels to, of length 1.
using ReachTerm = std::function<glm::dvec3(const glm::dvec3& from_light, uint32_t mask)>;
using ReachTerms = std::shared_ptr<const std::vector<ReachTerm>>;  // null: none

// Bounds of a ReachTerm, for all points.
struct LightShare {
  double largest = 1;
  bool of_surface = false;  // it is not the same for all surfaces
};

// A surface's BRDF towards the eye times its cosine, by the direction to the light (unit), and the normals
// about which it has lobes. Directions are in view space.
struct LitSurface {
  std::function<glm::dvec3(const glm::dvec3& to_light)> reflected;
  glm::dvec3 to_eye{0, 0, 1};
  std::vector<glm::dvec3> normals;
};

// The hook NAME_lit: the light that a surface at `from_light`, metres from the light's position, reflects per
// unit of intensity, without the light's window, cone and shadow.
using LitTerm = std::function<glm::dvec3(const glm::dvec3& from_light, const LitSurface&)>;

// The term of a light is empty if a point's formula is right for it.
struct LitOracle {
  LitTerm (*term)(const Scene&, const Light&, const LightRanges&, const glm::dmat3& from_world) = nullptr;
};

// For an effect that keeps lights from surfaces: a light reaches only surfaces whose mask shares a bit with
// its own. Code without a point of a surface reads masks in place of NAME_meets: lists of objects, tiles
// and the stencil leave out lights that would add nothing. One effect at most has masks. They are the oracle
// of NAME_meets.
struct SurfaceMasks {
  uint32_t (*of_light)(const Light&) = nullptr;
  uint32_t (*of_instance)(const Instance&) = nullptr;
};

// The hooks NAME_reach and NAME_tint, by term and share, and NAME_meets, by masks. It may read the scene and the settings
// that are stored with ranges (SettingFlags::of_lights).
struct ReachOracle {
  // An empty function: all of the light passes. Directions are in view space. The function is called while
  // the scene is unchanged.
  ReachTerm (*term)(const Scene&, const Light&, const LightRanges&, const View&) = nullptr;
  LightShare (*share)(const Scene&, const Light&, const LightRanges&) = nullptr;
  SurfaceMasks masks{};
};

// Registers the oracles of a program's effects: once, before any light is read.
void set_light_oracles(std::vector<ReachOracle> reach, std::vector<LitOracle> lit = {});

ReachTerms reach_terms(const Scene& scene, const Light& light, const LightRanges& ranges, const View& view);
// The term of the effect that computes the light; null: none. At most one effect has the light's shape.
std::shared_ptr<const LitTerm> lit_term(const Scene& scene, const Light& light, const LightRanges& ranges,
                                        const glm::dmat3& from_world);
// The share that all effects together let through.
LightShare share_of(const Scene& scene, const Light& light, const LightRanges& ranges);
uint32_t mask_of(const Light& light);
uint32_t mask_of(const Instance& instance);

}  // namespace lightgrid
