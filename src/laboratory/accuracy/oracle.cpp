#include "accuracy/oracle.h"

#include "accuracy/oracle_sample.h"
#include "accuracy/shadow_truth.h"
#include "accuracy/surfaces_in_double.h"
#include "measures/metrics.h"
#include "oracle/position.h"
#include "oracle/seen_pairs.h"
#include "plan/settings/model.h"

namespace lightgrid::lab {
namespace {

// A row of pixels as an image, for the metrics.
Image as_image(const std::vector<glm::dvec3>& colors) {
  Image image(int(colors.size()), 1);
  for (size_t i = 0; i < colors.size(); ++i) image.pixels[i] = glm::vec4(glm::vec3(colors[i]), 1);
  return image;
}

}  // namespace

Surface surface_of(const SurfaceImages& s, uint32_t pixel) {
  Surface surface;
  surface.normal = glm::normalize(glm::dvec3(s.normal_roughness.pixels[pixel]));
  surface.roughness = s.normal_roughness.pixels[pixel].w;
  surface.base_color = s.base_color_metallic.pixels[pixel];
  surface.metallic = s.base_color_metallic.pixels[pixel].w;
  surface.emissive = s.emissive_occlusion.pixels[pixel];
  surface.occlusion = s.emissive_occlusion.pixels[pixel].w;
  surface.unlit = surface.occlusion < 0;
  if (!s.model.pixels.empty()) {
    const MaterialModel& model = s.models.at(size_t(s.model.pixels[pixel].r));
    surface.subsurface_color = model.subsurface_color;
    surface.roll_off = model.roll_off;
    surface.minnaert_k = model.minnaert_k;
  }
  if (!s.specular.pixels.empty()) {
    surface.f0 = s.specular.pixels[pixel];
    surface.f90 = s.specular.pixels[pixel].w;
  }
  if (s.coat_factor.pixels.empty() || s.coat_factor.pixels[pixel].r == 0) return surface;
  surface.coat = s.coat_factor.pixels[pixel].r;
  surface.coat_roughness = s.coat_normal_roughness.pixels[pixel].w;
  surface.coat_normal = glm::normalize(glm::dvec3(s.coat_normal_roughness.pixels[pixel]));
  return surface;
}

std::vector<ViewLight> local_lights(const ViewState& v) {
  return lights_in_view(v.scene, v.view, ranges_of(v.plan.settings), v.plan.lights.local);
}

ListedLights listed_lights(TechniqueRun& run, const std::vector<float>& depth) {
  const HostLists& listed = run.frame().listed;
  return listed ? listed(depth) : list_every_light(uint32_t(run.view().plan.lights.local.size()));
}

std::vector<uint32_t> masks_of_pixels(const FramePlan& plan, const Scene& scene,
                                      const std::vector<SceneTriangle>& shown) {
  std::vector<uint32_t> masks;
  if (!plan.masks.needed) return masks;
  for (const SceneTriangle& triangle : shown)
    masks.push_back(triangle.instance < 0 ? 0 : mask_of(scene.instances[size_t(triangle.instance)]));
  return masks;
}

LitPairs count_listed_pairs(TechniqueRun& run, const std::vector<float>& depth, const SeenPairs* seen) {
  const ViewState& v = run.view();
  std::vector<uint32_t> masks;
  if (v.plan.masks.needed) masks = masks_of_pixels(v.plan, v.scene, shown_triangles(run));
  if (!seen) return count_pairs(v.view, depth, local_lights(v), listed_lights(run, depth), nullptr, masks);
  std::optional<HostShadows> shaded;
  if (run.frame().shadows) shaded = run.frame().shadows();
  const PairShadows shadows{*seen, shaded ? &*shaded : nullptr, uint32_t(v.plan.lights.directional.size())};
  return count_pairs(v.view, depth, local_lights(v), listed_lights(run, depth), &shadows, masks);
}

std::optional<LitPairs> count_blended_pairs(TechniqueRun& run, ShadowTruth& truth) {
  const ViewState& v = run.view();
  if (!run.frame().blended_shadows || !truth.casts() || v.plan.surfaces.blended.empty()) return {};
  LitPairs sum;
  for (const HostShadowLayer& layer : run.frame().blended_shadows()) {
    const SeenPairs* seen = truth.of_layer(v, layer);
    const PairShadows shadows{*seen, &layer.shadows};
    std::vector<uint32_t> masks;
    for (const glm::ivec2& triangle : layer.triangles)
      masks.push_back(triangle.x < 0 ? 0 : mask_of(v.scene.instances[size_t(triangle.x)]));
    const LitPairs pairs =
        count_pairs(v.view, layer.depth, local_lights(v),
                    list_every_light(uint32_t(v.plan.lights.local.size())), &shadows, masks);
    sum.lit += pairs.lit;
    sum.leaked += pairs.leaked;
    sum.acned += pairs.acned;
    sum.either += pairs.either;
  }
  return sum;
}

PairCounts pair_counts(const TechniqueRun& run, const LitPairs& pairs, const SeenPairs* seen) {
  PairCounts counts{pairs.listed, pairs.lit, pairs.lost, pairs.wrong};
  if (seen)
    counts.shadows = {pairs.leaked,   pairs.acned,   pairs.either,
                      seen->pixels(), seen->pairs(), !run.approximate()};
  return counts;
}

ReferenceErrors measure_reference_errors(const SurfaceOracle& oracle, const Image& every_light,
                                         const std::vector<uint32_t>& pixels) {
  const Image with_window = as_image(oracle.shade(pixels, true)),
              without = as_image(oracle.shade(pixels, false));
  Image in_float(int(pixels.size()), 1);
  for (size_t i = 0; i < pixels.size(); ++i) in_float.pixels[i] = every_light.pixels[pixels[i]];
  return {compare_images(with_window, without), compare_images(in_float, with_window),
          oracle.pixels_left_out()};
}

ReferenceErrors measure_reference_errors(RenderView& v, const Image& every_light,
                                         const std::vector<float>& depth, size_t samples) {
  const SurfaceOracle oracle(v, depth);
  return measure_reference_errors(oracle, every_light,
                                  oracle.decided(sample_pixels(oracle.pixels(), samples)));
}

}  // namespace lightgrid::lab
