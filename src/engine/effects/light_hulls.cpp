// Light hulls (docs/light_hulls.md, shared/effects/light_hulls.h).
#include "shared/effects/light_hulls.h"

#include <sstream>

#include "base/error.h"
#include "plan/light_plan.h"
#include "renderer/loop_inputs.h"
#include "renderer/pass_context.h"
#include "scene/light_readers.h"

namespace lightgrid {
namespace {

// "hull" of a light in lights files, and "light_hull" in extras of glTF files: planes of four numbers each. A point
// at p, metres from the light along the world's axes, is inside a plane if normal . p <= distance.
const Property<std::string> hull{"hull", ""};

struct HullPlane {
  glm::dvec3 normal;  // unit
  double distance;
};

constexpr const char* requirement =
    "one to 8 planes, separated by commas: a normal's x, y and z, and a distance in metres";

// Empty: no hull. Throws Error(input).
std::vector<HullPlane> planes_of(const Light& light) {
  std::vector<HullPlane> planes;
  std::istringstream text(light.type == LightType::directional ? "" : hull.of(light));
  for (std::string plane; std::getline(text, plane, ',');) {
    std::istringstream words(plane);
    glm::dvec4 p(0);
    std::string rest;
    const bool numbers = words >> p.x >> p.y >> p.z >> p.w && !(words >> rest);
    const double length = glm::length(glm::dvec3(p));
    if (!numbers || !(length > 0) || !std::isfinite(length) || planes.size() == HULL_PLANES)
      throw input_error("light \"{}\": hull \"{}\" is not {}", light.name, hull.of(light), requirement);
    planes.push_back({glm::dvec3(p) / length, p.w / length});
  }
  return planes;
}

std::optional<EffectNeed> decide(const Scene& scene, const FramePlan& plan) {
  const auto first = std::ranges::find_if(plan.lights.local,
                                          [&](int i) { return !planes_of(scene.lights[size_t(i)]).empty(); });
  if (first == plan.lights.local.end()) return {};
  const size_t planes = planes_of(scene.lights[size_t(*first)]).size();
  return EffectNeed{true,
                    light_witness(scene, *first) + " has a hull of " + std::to_string(planes) + " planes"};
}

ReachTerm term(const Scene&, const Light& light, const LightRanges&, const View& view) {
  std::vector<HullPlane> planes = planes_of(light);
  if (planes.empty()) return {};
  const glm::dmat3 from_world(view.view_from_world);
  for (HullPlane& plane : planes) plane.normal = from_world * plane.normal;
  return [planes](const glm::dvec3& from_light, uint32_t) {
    double depth = 1;
    for (const HullPlane& plane : planes)
      depth = std::min(depth, (plane.distance - glm::dot(plane.normal, from_light)) / double(HULL_EDGE_M));
    return glm::dvec3(std::max(depth, 0.0));
  };
}

LightShare share(const Scene&, const Light&, const LightRanges&) {
  return {.largest = 1, .of_surface = false};
}

LOOP_INPUTS(LightHullInputs, LIGHT_HULLS_REACH_INPUTS);

// In view space; planes that a light does not have let everything pass.
std::array<glm::vec4, HULL_PLANES> planes_in_view(const Light& light, const View& view) {
  std::array<glm::vec4, HULL_PLANES> values;
  values.fill({0, 0, 0, 1});
  const glm::dmat3 from_world(view.view_from_world);
  const std::vector<HullPlane> planes = planes_of(light);
  for (size_t i = 0; i < planes.size(); ++i) {
    const double from_eye = planes[i].distance + glm::dot(planes[i].normal, light.position - view.eye);
    values[i] = glm::vec4(glm::dvec4(from_world * planes[i].normal, from_eye) / double(HULL_EDGE_M));
  }
  return values;
}

class LightHulls : public LightInputs<LightHullInputs> {
  void fill(PassContext& work) override {
    inputs_.hull_planes.put(
        *work.renderer.cl, work.plan.opengl, "uploading hulls",
        values_of_lights(work, [&](const Light& light) { return planes_in_view(light, work.view); }));
  }
};

std::unique_ptr<EffectState> make(PassContext&) { return std::make_unique<LightHulls>(); }

}  // namespace

extern constexpr Effect light_hulls{
    .name = "light_hulls", .decide = decide, .make = make, .reach = ReachOracle{term, share}};

}  // namespace lightgrid
