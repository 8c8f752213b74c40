// Suites of every technique in two parts: the first tier runs `Techniques/SUITE`, --all also
// `OtherTechniques/SUITE` (docs/testing.md#two-tiers).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "techniques/technique.h"

namespace lightgrid {

// One with lists of tiles in OpenGL's shaders, one with normals alone, one whose surfaces OpenCL rasterises.
inline std::vector<const Technique*> techniques_of_tier(bool first) {
  const std::set<std::string> of_first = {"forward_plus", "light_prepass", "visibility"};
  std::vector<const Technique*> chosen = techniques();
  std::erase_if(chosen, [&](const Technique* t) { return of_first.contains(t->name) != first; });
  return chosen;
}

}  // namespace lightgrid

#define LIGHTGRID_TECHNIQUES_OF_BOTH_TIERS(Suite)                                                           \
  INSTANTIATE_TEST_SUITE_P(Techniques, Suite, testing::ValuesIn(lightgrid::techniques_of_tier(true)),       \
                           [](const auto& info) { return std::string(info.param->name); });                 \
  INSTANTIATE_TEST_SUITE_P(OtherTechniques, Suite, testing::ValuesIn(lightgrid::techniques_of_tier(false)), \
                           [](const auto& info) { return std::string(info.param->name); })
