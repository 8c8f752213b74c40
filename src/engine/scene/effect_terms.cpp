#include "scene/effect_terms.h"

namespace lightgrid {
namespace {

std::vector<ReachOracle>& reach_oracles() {
  static std::vector<ReachOracle> oracles;
  return oracles;
}

SurfaceMasks& surface_masks() {
  static SurfaceMasks masks;
  return masks;
}

}  // namespace

void set_reach_oracles(std::vector<ReachOracle> oracles) {
  surface_masks() = {};
  for (const ReachOracle& oracle : oracles) {
    if (oracle.masks.of_light) surface_masks() = oracle.masks;
  }
  reach_oracles() = std::move(oracles);
}

ReachTerms reach_terms(const Scene& scene, const Light& light, const LightRanges& ranges, const View& view) {
  std::vector<ReachTerm> terms;
  for (const ReachOracle& oracle : reach_oracles()) {
    if (!oracle.term) continue;
    if (ReachTerm term = oracle.term(scene, light, ranges, view)) terms.push_back(std::move(term));
  }
  return terms.empty() ? nullptr : std::make_shared<const std::vector<ReachTerm>>(std::move(terms));
}

LightShare share_of(const Scene& scene, const Light& light, const LightRanges& ranges) {
  LightShare share{.of_surface = mask_of(light) != full_mask};
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
