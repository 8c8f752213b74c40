// The shading of this project in double: glTF 2.0 metallic-roughness (specification, appendix B), with GGX or
// Blinn-Phong, or Lambert alone, a coat over it (KHR_materials_clearcoat), and the diffuse models of
// docs/material_models.md, under KHR_lights_punctual. docs/oracle.md#shading has the formulas that the GLSL
// follows too.
#pragma once

#include <functional>
#include <vector>

#include "scene/material_model.h"
#include "scene/surface.h"
#include "scene/view_lights.h"

namespace lightgrid::lab {

// Reflected over incoming radiance, towards `to_eye` from `to_light` (both unit, view space), 1 / sr. Without
// the coat and what leaves skin.
glm::dvec3 brdf(const Surface& surface, const glm::dvec3& to_eye, const glm::dvec3& to_light,
                Brdf lobe = Brdf::ggx);

// The same times the cosine at the surface, with the coat, whose cosine is that of its own normal.
glm::dvec3 reflected(const Surface& surface, const glm::dvec3& to_eye, const glm::dvec3& to_light,
                     Brdf lobe = Brdf::ggx);

struct ShadeSettings {
  Brdf brdf = Brdf::ggx;
  glm::dvec3 ambient{0};
  bool window = true;  // false: lights reach everything, as if their radius were infinite
  // shade_pixels leaves out the lights (numbers in `lights`) that it says are hidden at a pixel; empty: none.
  // Called from several threads.
  std::function<bool(uint32_t pixel, uint32_t light)> hidden = {};
  // Radiance that effects add (BaseTerm in plan/effect.h).
  std::vector<std::function<glm::dvec3(const Surface&, const glm::dvec3& position)>> base = {};
  // Radiance past all surfaces, by direction from the eye in view space (BackgroundTerm); empty: the scene's.
  std::function<glm::dvec3(const glm::dvec3& direction)> background = {};
};

// Radiance towards the eye, lights added in order. Finite for finite input.
glm::dvec3 shade(const Surface& surface, const glm::dvec3& position, bool orthographic,
                 const std::vector<ViewLight>& lights, const ShadeSettings& settings);

// Radiance of `pixels` (y * width + x each, all covered), in their order. `surface_at` is called from several
// threads. Lights whose window is zero on a whole tile are skipped, which changes no bit.
std::vector<glm::dvec3> shade_pixels(const View& view, const std::vector<float>& depth,
                                     const std::function<Surface(uint32_t pixel)>& surface_at,
                                     const std::vector<ViewLight>& lights, const ShadeSettings& settings,
                                     const std::vector<uint32_t>& pixels);

// At most `most` of `pixels`, spread evenly: one from each of `most` equal runs, at a position within the run
// that follows the golden ratio, to avoid aliasing with periodic images. Ascending if `pixels` is;
// deterministic.
std::vector<uint32_t> sample_pixels(const std::vector<uint32_t>& pixels, size_t most);

}  // namespace lightgrid::lab
