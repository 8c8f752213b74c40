#include "plan/settings.h"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>

#include "base/error.h"
#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/picture.h"
#include "plan/settings/shadows.h"
#include "shared/cull_tests.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string message_of(const std::string& assignment) {
  Settings settings;
  return error_of([&] { apply_setting(settings, assignment); });
}

TEST(Settings, EveryValueOfEveryKeyIsTakenAndToldBack) {
  for (const SettingRow& help : setting_rows()) {
    const std::string key = json_key(help.key);
    EXPECT_EQ(to_strings(Settings{}).at(key), help.values.front()) << "the default stands first";
    for (const std::string& value : help.values) {
      Settings settings;
      apply_setting(settings, help.key + "=" + value);
      EXPECT_EQ(to_strings(settings).at(key), value);
      auto others = to_strings(settings), before = to_strings(Settings{});
      others.erase(key);
      before.erase(key);
      EXPECT_EQ(others, before) << "no other setting moves";
    }
  }
}

TEST(Settings, EachRowHasItsKeyItsPlaceAndItsNumber) {
  std::set<std::string> keys;
  std::set<size_t> numbers;
  int last = 0;
  for (const SettingRow& row : setting_rows()) {
    EXPECT_GT(row.place, last) << row.key;
    last = row.place;
    EXPECT_TRUE(keys.insert(row.key).second) << row.key;
    EXPECT_TRUE(numbers.insert(row.number).second) << row.key;
    EXPECT_LT(row.number, Settings::max_settings) << row.key;
  }
}

TEST(Settings, ValuesWithoutANameAreKept) {
  Settings settings{{setting::shadow_memory, 12345}, {setting::shadow_source_m, 0.07}};
  EXPECT_EQ(settings[setting::shadow_memory], 12345u);
  EXPECT_EQ(settings[setting::shadow_source_m], 0.07);
  EXPECT_EQ(to_strings(settings).count("shadow_memory"), 0u);
  EXPECT_EQ(settings[setting::display_ev], 0);
  settings.set(setting::display_ev, std::nullopt);
  EXPECT_EQ(settings[setting::display_ev], std::nullopt);
  settings.set(setting::display_ev, -1.5);
  EXPECT_EQ(settings[setting::display_ev], -1.5);
  settings.reset(setting::display_ev).reset(setting::shadow_memory).reset(setting::shadow_source_m);
  EXPECT_EQ(settings, Settings());
}

TEST(Settings, CutoffAndAlphaAreNumbers) {
  Settings settings;
  apply_setting(settings, "cutoff=20");
  apply_setting(settings, "alpha=3.5e-4");
  EXPECT_EQ(settings[setting::cutoff], 20);
  EXPECT_EQ(settings[setting::alpha], 3.5e-4);
  EXPECT_EQ(to_strings(settings).at("cutoff"), "20");
  EXPECT_EQ(to_strings(settings).at("alpha"), "0.00035");
  EXPECT_TRUE(settings.given(setting::cutoff));
  apply_setting(settings, "cutoff=0.50");
  EXPECT_EQ(to_strings(settings).at("cutoff"), "0.5");
  for (const char* wrong : {"cutoff=0", "cutoff=-1", "cutoff=1e10", "alpha=nan", "alpha=inf", "cutoff=much"})
    EXPECT_THAT(message_of(wrong), HasSubstr("is a number from 1e-09 to 1e+09")) << wrong;
}

TEST(Settings, UnknownWordsAreToldTheNearest) {
  EXPECT_THAT(message_of("sliced=8"), HasSubstr("did you mean slices?"));
  EXPECT_THAT(message_of("raster=opncl"), HasSubstr("did you mean opencl?"));
}

TEST(Settings, TheModelIsMadeOfTheSettingsThatItNames) {
  for (const SettingRow& help : setting_rows()) {
    Settings settings;
    apply_setting(settings, help.key + "=" + help.values.back());
    const bool names = std::ranges::count(model_settings(), help.key) > 0;
    EXPECT_EQ(same_model(settings, Settings{}), !names) << help.key;
    EXPECT_EQ(to_strings(with_model({}, settings)) == to_strings(settings), names) << help.key;
  }
}

TEST(Settings, TheseSayWhichPictureIsMeant) {
  EXPECT_THAT(model_settings(), testing::ElementsAre("brdf", "range", "cutoff", "window", "alpha",
                                                     "light-seed", "shadow-blended"));
  EXPECT_THAT(tunable_settings(), testing::ElementsAre("kernel-shape", "portable", "group-size"));
}

TEST(Settings, ThePictureThatIsMeantHasNoApproximations) {
  Settings settings;
  EXPECT_EQ(to_strings(meant_by(settings)), to_strings(settings));
  for (const char* assignment : {"range=cutoff", "cutoff=0.2", "shadows=map", "shadow-threshold=4",
                                 "shadow-pick=4", "brdf=lambert", "tile=32"})
    apply_setting(settings, assignment);
  auto expected = to_strings(settings);
  expected["shadows"] = "exact";
  expected["shadow_threshold"] = "off";
  expected["shadow_pick"] = "off";
  EXPECT_EQ(to_strings(meant_by(settings)), expected);
}

TEST(Settings, OnlyTheKeysThatAreKeptKeepTheirValues) {
  Settings settings;
  for (const SettingRow& help : setting_rows()) apply_setting(settings, help.key + "=" + help.values.back());
  auto expected = to_strings(Settings{});
  expected["tile"] = "64";
  expected["cutoff"] = "0.0001";
  EXPECT_EQ(
      to_strings(only_with(settings, [](const std::string& k) { return k == "tile" || k == "cutoff"; })),
      expected);
}

TEST(Settings, ValuesMeanWhatTheySay) {
  Settings settings;
  apply_setting(settings, "tile=64");
  apply_setting(settings, "cull-test=sphere");
  apply_setting(settings, "depth-bounds=none");
  apply_setting(settings, "kernel-shape=group");
  EXPECT_EQ(settings[setting::tile], 64);
  EXPECT_EQ(settings[setting::cull_test], CullTest::sphere);
  EXPECT_EQ(settings[setting::depth_bounds], DepthBoundsMode::none);
  EXPECT_EQ(settings[setting::kernel_shape], KernelShape::group);
}

TEST(Settings, TakeWhatWasTunedWhereNothingElseIsSaid) {
  Settings settings;
  apply_setting(settings, "kernel-shape=auto");
  apply_setting(settings, "tile=32");
  const Settings tuned =
      with_tuned(settings, {{"kernel-shape", "group"}, {"portable", "on"}, {"group-size", "128"}});
  EXPECT_EQ(tuned[setting::kernel_shape], KernelShape::automatic) << "said";
  EXPECT_TRUE(tuned[setting::portable]);
  EXPECT_EQ(tuned[setting::group_size], 128);
  EXPECT_EQ(tuned[setting::tile], 32);
  const Settings wrong =
      with_tuned({}, {{"tile", "64"}, {"portable", "perhaps"}, {"no-such", "1"}, {"group-size", "100"}});
  EXPECT_EQ(to_strings(wrong), to_strings(Settings{}))
      << "what changes results, or is nothing known, is passed over";
}

TEST(Settings, AWrongKeyListsTheKeys) {
  for (const char* wrong : {"tiles=16", "tile", "=16", "", "Tile=16"}) {
    EXPECT_THAT(message_of(wrong),
                AllOf(HasSubstr("cull-test"), HasSubstr("tile"), HasSubstr("depth-bounds")))
        << wrong;
  }
}

TEST(Settings, ARemovedKeySaysWhatToUse) {
  EXPECT_THAT(message_of("shadow-kept=64M"),
              AllOf(HasSubstr("set shadow-kept=64M: "), HasSubstr("removed"), HasSubstr("shadow-reuse=on")));
}

TEST(Settings, AWrongValueListsTheValues) {
  for (const char* wrong : {"tile=17", "tile=", "tile=16 ", "tile=16=16", "tile=016"}) {
    EXPECT_THAT(message_of(wrong), AllOf(HasSubstr("8"), HasSubstr("32"), HasSubstr("64"), HasSubstr(wrong)))
        << wrong;
  }
}

}  // namespace
}  // namespace lightgrid
