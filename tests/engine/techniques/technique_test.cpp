// Settings that make a technique's pictures approximate or random, and settings that are shown.
#include "techniques/technique.h"

#include <gtest/gtest.h>

namespace lightgrid {
namespace {

struct SettingsCase {
  const char* technique;
  std::vector<const char*> assignments;
  bool approximate, random;
};

TEST(Techniques, SettingsMakePicturesApproximateOrRandom) {
  const SettingsCase cases[] = {
      {"forward", {}, false, false},
      {"forward", {"far-light=512", "range=cutoff", "samples=4", "kernel-shape=group"}, false, false},
      {"forward", {"range=stochastic"}, false, true},
      {"forward", {"shadows=map"}, true, false},
      {"forward", {"shadows=none"}, true, false},
      {"forward", {"shadow-threshold=1"}, true, false},
      {"forward", {"shadow-rays=4"}, true, false},
      {"forward", {"shadow-rays=4", "shadow-source=0"}, false, false},
      {"forward", {"shadow-pick=4"}, true, false},
      {"forward", {"lidr-shadows=none"}, false, false},
      {"lidr", {"lidr-shadows=none"}, true, false},
      {"lidr", {"lidr-shadows=volumes"}, true, false},
      {"forward_plus", {"list-cap=8"}, false, false},
      {"forward_plus", {"list-cap-order=sampled"}, false, false},
      {"forward_plus", {"list-cap=8", "list-cap-order=sampled"}, true, true},
      {"visibility", {"list-cap=8", "list-cap-order=tree"}, true, true},
      {"forward_multipass", {"list-cap=8", "list-cap-order=sampled"}, false, false},
      {"voxel_lights", {}, true, false},
  };
  for (const SettingsCase& c : cases) {
    Settings settings;
    std::string name = c.technique;
    for (const char* assignment : c.assignments) {
      apply_setting(settings, assignment);
      name += std::string(" ") + assignment;
    }
    const Technique& technique = find_technique(c.technique);
    EXPECT_EQ(is_approximate(technique, settings), c.approximate) << name;
    EXPECT_EQ(is_random(technique, settings), c.random) << name;
  }
}

TEST(Techniques, OnlySettingsWithAnEffectAreShown) {
  const auto shown = [](const char* technique, std::initializer_list<const char*> assignments,
                        const char* key) {
    Settings settings;
    for (const char* assignment : assignments) apply_setting(settings, assignment);
    return settings_of(find_technique(technique), settings).contains(key);
  };
  EXPECT_FALSE(shown("forward", {}, "shadow_size"));
  EXPECT_TRUE(shown("forward", {"shadows=map"}, "shadow_filter"));
  EXPECT_FALSE(shown("forward", {"lidr-shadows=final"}, "shadow_size")) << "read by lidr only";
  EXPECT_TRUE(shown("lidr", {"lidr-shadows=final"}, "shadow_filter"));
  EXPECT_TRUE(shown("lidr", {"lidr-shadows=prepass"}, "shadow_size"));
  EXPECT_FALSE(shown("lidr", {"lidr-shadows=prepass"}, "shadow_filter"));
  EXPECT_FALSE(shown("forward", {}, "shadow_threshold"));
  EXPECT_TRUE(shown("forward", {"shadow-threshold=off"}, "shadow_threshold")) << "given";
  EXPECT_FALSE(shown("forward", {}, "portable")) << "read where lights cast, and not listed";
  EXPECT_TRUE(shown("forward_plus", {"list-cap=8", "list-cap-order=sampled"}, "list_seed"));
  EXPECT_FALSE(shown("forward_multipass", {"list-cap=8", "list-cap-order=sampled"}, "list_seed"));
}

}  // namespace
}  // namespace lightgrid
