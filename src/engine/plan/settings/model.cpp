#include "plan/settings/model.h"

namespace lightgrid {

LightRanges ranges_of(const Settings& s) {
  LightRanges ranges{s[setting::range], s[setting::window], s[setting::cutoff], s[setting::alpha],
                     s[setting::light_seed]};
  for (const SettingRow& row : setting_rows()) {
    if (row.flags.of_lights && s.difference(row) != 0) ranges.effects[row.key] = s.difference(row);
  }
  return ranges;
}

void set_ranges(Settings& s, const LightRanges& ranges) {
  s.set(setting::range, ranges.range).set(setting::window, ranges.window).set(setting::cutoff, ranges.cutoff);
  s.set(setting::alpha, ranges.alpha).set(setting::light_seed, ranges.seed);
  for (const SettingRow& row : setting_rows()) {
    const auto found = ranges.effects.find(row.key);
    if (row.flags.of_lights) s.set_difference(row, found == ranges.effects.end() ? 0 : found->second);
  }
}

}  // namespace lightgrid
