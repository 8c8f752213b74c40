// The techniques, and the settings that each reads.
#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "passes/frame_stages.h"
#include "plan/settings/grid.h"
#include "plan/settings/samples.h"
#include "techniques/technique.h"

namespace lightgrid {

extern const Technique forward, forward_multipass, forward_zprepass, forward_plus, clustered,
    forward_plus_compute, deferred, deferred_tiled, light_prepass, lidr, visibility, voxel_lights, world_grid;

namespace {

bool holds(const std::vector<const char*>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

TechniqueNeeds adapted_needs(const Technique& technique, Settings settings) {
  TechniqueNeeds needs = technique.needs;
  if (needs.adapt) needs.adapt(needs, settings);
  return needs;
}

// `settings` as the technique reads them.
Settings read_by(const Technique& technique, const Settings& settings) {
  return only_with(settings, [&](const std::string& key) { return reads_setting(technique, key); });
}

// Returns whether a setting that the technique reads meets its condition.
bool meets(const Technique& technique, const Settings& settings,
           SettingFlags::Condition SettingFlags::*condition) {
  const Settings read = read_by(technique, settings);
  return std::ranges::any_of(setting_rows(), [&](const SettingRow& row) {
    return row.flags.*condition && reads_setting(technique, row.key) && (row.flags.*condition)(read);
  });
}

}  // namespace

const std::vector<const Technique*>& techniques() {
  static const std::vector<const Technique*> all = {
      &forward,   &forward_multipass, &forward_zprepass, &forward_plus, &clustered,  &forward_plus_compute,
      &deferred,  &deferred_tiled,    &light_prepass,    &lidr,         &visibility, &voxel_lights,
      &world_grid};
  return all;
}

std::string technique_names() {
  std::string names;
  for (const Technique* technique : techniques())
    names += (names.empty() ? "" : ", ") + std::string(technique->name);
  return names;
}

const Technique& find_technique(const std::string& name) {
  for (const Technique* technique : techniques()) {
    if (technique->name == name) return *technique;
  }
  std::vector<std::string> names;
  for (const Technique* technique : techniques()) names.emplace_back(technique->name);
  throw input_error("technique \"{}\": unknown name{}; techniques are {}", name, did_you_mean(name, names),
                    technique_names());
}

const std::vector<const char*>& common_settings() {
  static const std::vector<const char*> keys = [] {
    std::vector<const char*> all;
    for (const SettingRow& row : setting_rows()) {
      if (row.flags.common) all.push_back(row.key.c_str());
    }
    return all;
  }();
  return keys;
}

// Tunable settings are those of kernels, find_shadows' among them, which every technique may run.
bool reads_setting(const Technique& technique, const std::string& key) {
  return holds(common_settings(), key) || holds(technique.settings, key) ||
         std::ranges::count(tunable_settings(), key) > 0;
}

bool limits_lists(const Technique& technique, const Settings& settings) {
  return technique.limited_lists || ((settings[setting::list_cap] > 0 || settings[setting::view_cap] > 0) &&
                                     adapted_needs(technique, settings).lists.capped);
}

bool is_random(const Technique& technique, const Settings& settings) {
  return meets(technique, settings, &SettingFlags::random);
}

bool is_approximate(const Technique& technique, const Settings& settings) {
  return technique.approximate || meets(technique, settings, &SettingFlags::approximate);
}

Frame draw_frame(const Technique& technique, RenderView& v) {
  Frame frame;
  begin_stages(v, v.caches);
  do {
    v.effects.before_lights(v);
    frame = technique.render(v);
  } while (shade_again(v, v.caches, frame.image));
  end_stages(v, v.caches, frame);
  return frame;
}

int max_samples(const Technique& technique, const Settings& settings) {
  return adapted_needs(technique, settings).samples.most;
}

void check_samples(const Technique& technique, const Settings& settings) {
  const int most = max_samples(technique, settings);
  if (settings[setting::samples] > 1 && settings[setting::samples_resolve] != SamplesResolve::linear &&
      !holds(technique.settings, "samples-resolve"))
    throw input_error(
        "set samples-resolve: {} averages light where it shades tiles; choose "
        "samples-resolve=linear",
        technique.name);
  if (settings[setting::samples] <= most) return;
  throw input_error("set samples={}: {} with these settings takes {} a pixel", settings[setting::samples],
                    technique.name, most);
}

std::map<std::string, std::string> settings_of(const Technique& technique, const Settings& settings) {
  std::map<std::string, std::string> all = to_strings(settings), own;
  const Settings read = read_by(technique, settings);
  for (const SettingRow& row : setting_rows()) {
    const bool listed = row.flags.common || holds(technique.settings, row.key);
    const bool shown = !row.flags.shown || row.flags.shown(read);
    if (listed && shown && (!row.flags.shown_if_given || settings.given(row)))
      own[json_key(row.key)] = all.at(json_key(row.key));
  }
  return own;
}

}  // namespace lightgrid
