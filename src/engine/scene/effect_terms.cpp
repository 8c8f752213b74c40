#include "scene/effect_terms.h"

namespace lightgrid {
namespace {

std::vector<ReachOracle>& reach_oracles() {
  static std::vector<ReachOracle> oracles;
  return oracles;
}

std::vector<LitOracle>& lit_oracles() {
  static std::vector<LitOracle> oracles;
  return oracles;
}

SurfaceMasks& surface_masks() {
  static SurfaceMasks masks;
  return masks;
}

}  // namespace

void set_light_oracles(std::vector<ReachOracle> reach, std::vector<LitOracle> lit) {
  surface_masks() = {};
  for (const ReachOracle& oracle : reach) {
    if (oracle.masks.of_light) surface_masks() = oracle.masks;
  }
  reach_oracles() = std::move(reach);
  lit_oracles() = std::move(lit);
}

ReachTerms reach_terms(const Scene& scene, const Light& light, const LightRanges& ranges, const View& view) {
  std::vector<ReachTerm> terms;
  for (const ReachOracle& oracle : reach_oracles()) {
    if (!oracle.term) continue;
    if (ReachTerm term = oracle.term(scene, light, ranges, view)) terms.push_back(std::move(term));
  }
  return terms.empty() ? nullptr : std::make_shared<const std::vector<ReachTerm>>(std::move(terms));
}

std::shared_ptr<const LitTerm> lit_term(const Scene& scene, const Light& light, const LightRanges& ranges,
                                        const glm::dmat3& from_world) {
  for (const LitOracle& oracle : lit_oracles()) {
    if (LitTerm term = oracle.term(scene, light, ranges, from_world))
      return std::make_shared<const LitTerm>(std::move(term));
  }
  return nullptr;
}

LightShare share_of(const Scene& scene, const Light& light, const LightRanges& ranges) {
  // A light of a shape is no point for surfaces near it.
  LightShare share{.of_surface =
                       mask_of(light) != full_mask || lit_term(scene, light, ranges, glm::dmat3(1))};
  for (const ReachOracle& oracle : reach_oracles()) {
    if (!oracle.share) continue;
    const LightShare more = oracle.share(scene, light, ranges);
    share.largest *= more.largest;
    share.of_surface = share.of_surface || more.of_surface;
  }
  return share;
}

uint32_t mask_of(const Light& light) {
  const auto of = surface_masks().of_light;
  return of ? of(light) : full_mask;
}

uint32_t mask_of(const Instance& instance) {
  const auto of = surface_masks().of_instance;
  return of ? of(instance) : full_mask;
}

}  // namespace lightgrid
