#include "scene/effect_terms.h"

namespace lightgrid {
namespace {

std::vector<ReachOracle>& reach_oracles() {
  static std::vector<ReachOracle> oracles;
  return oracles;
}

}  // namespace

void set_reach_oracles(std::vector<ReachOracle> oracles) { reach_oracles() = std::move(oracles); }

ReachTerms reach_terms(const Scene& scene, const Light& light, const LightRanges& ranges,
                       const glm::dmat3& from_world) {
  std::vector<ReachTerm> terms;
  for (const ReachOracle& oracle : reach_oracles()) {
    if (ReachTerm term = oracle.term(scene, light, ranges, from_world)) terms.push_back(std::move(term));
  }
  return terms.empty() ? nullptr : std::make_shared<const std::vector<ReachTerm>>(std::move(terms));
}

LightShare share_of(const Scene& scene, const Light& light, const LightRanges& ranges) {
  LightShare share;
  for (const ReachOracle& oracle : reach_oracles()) {
    const LightShare more = oracle.share(scene, light, ranges);
    share.largest *= more.largest, share.of_surface = share.of_surface || more.of_surface;
  }
  return share;
}

}  // namespace lightgrid
