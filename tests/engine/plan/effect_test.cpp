#include "plan/effect.h"

#include <gtest/gtest.h>

namespace lightgrid {
namespace {

ReachTerm term(const Scene&, const Light&, const LightRanges&, const View&) { return {}; }
LightShare share(const Scene&, const Light&, const LightRanges&) { return {}; }

LitTerm lit(const Scene&, const Light&, const LightRanges&, const glm::dmat3&) { return {}; }

uint32_t mask(const Light&) { return 1; }

TEST(MissingOracle, NamesWhatAnEffectHasNone) {
  const std::vector<std::string> mean = {"far-light"};
  const auto missing = [&](const Effect& effect) { return missing_oracle(effect, mean); };
  EXPECT_EQ(missing({.name = "a"}), "it answers no hook: give .base, .reach or .lit with its oracle");
  EXPECT_EQ(missing({.name = "a", .base = BaseOracle{}}),
            "base has no oracle: give .term, or .meant_by with a setting's key");
  EXPECT_EQ(missing({.name = "a", .base = BaseOracle{.meant_by = "tile"}}),
            "base is meant by tile, which has no .mean");
  EXPECT_EQ(missing({.name = "a", .base = BaseOracle{.meant_by = "far-light"}}), "");
  EXPECT_EQ(missing({.name = "a",
                     .base = BaseOracle{.term = [](const Scene&, const View&,
                                                   const Settings&) { return BaseTerm(); }}}),
            "");
  EXPECT_EQ(
      missing({.name = "a", .base = BaseOracle{.meant_by = "far-light"}, .background = BackgroundOracle{}}),
      "background has no oracle: give .term, and .base, whose inputs it reads");
  EXPECT_EQ(missing({.name = "a", .reach = ReachOracle{term, nullptr}}),
            "reach has no oracle: give .term and .share, or .masks");
  EXPECT_EQ(missing({.name = "a", .lit = LitOracle{}}), "lit has no oracle: give .term");
  EXPECT_EQ(missing({.name = "a", .lit = LitOracle{lit}}), "");
  EXPECT_EQ(missing({.name = "a", .reach = ReachOracle{.masks = {.of_light = mask}}}), "");
  EXPECT_EQ(missing({.name = "a", .reach = ReachOracle{term, share}}), "");
}

}  // namespace
}  // namespace lightgrid
