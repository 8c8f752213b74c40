// The techniques, and the settings that each reads.
#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "techniques/technique.h"

namespace lightgrid {

extern const Technique forward, forward_multipass, forward_zprepass, forward_plus, clustered,
    forward_plus_compute, deferred, deferred_tiled, light_prepass, lidr, visibility, voxel_lights, world_grid;

namespace {

bool holds(const std::vector<const char*>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

// Settings are shown only with others that read them, and one that changes no bit where it is given.
bool has_effect(const Settings& settings, const std::string& key) {
  const LightRange range = settings.ranges.range;
  if (key == "cutoff") return range == LightRange::cutoff;
  if (key == "alpha" || key == "light-seed") return range == LightRange::stochastic;
  if (key == "window") return range == LightRange::scene || range == LightRange::cutoff;
  if (key == "shadow-size" || key == "shadow-bits" || key == "shadow-filter")
    return settings.shadows == ShadowMethod::map;
  if (key == "shadow-source") return settings.shadows == ShadowMethod::exact && settings.shadow_rays > 1;
  if (key == "shadow-kept" || key == "shadow-memory" || key == "shadow-reuse" || key == "shadow-threshold")
    return settings.given.contains(key);
  return true;
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
    for (const std::string& key : model_settings()) {
      if (key != "brdf") all.push_back(key.c_str());  // techniques list brdf themselves
    }
    for (const char* key :
         {"shadows", "shadow-size", "shadow-bits", "shadow-filter", "shadow-rays", "shadow-source",
          "shadow-pick", "shadow-kept", "shadow-reuse", "shadow-threshold", "shadow-memory", "everything-on"})
      all.push_back(key);
    return all;
  }();
  return keys;
}

// Of kernels, which find_shadows reads where lights cast: every technique takes them.
static bool is_of_kernels(const std::string& key) {
  return key == "kernel-shape" || key == "portable" || key == "group-size";
}

bool reads_setting(const Technique& technique, const std::string& key) {
  return holds(common_settings(), key) || holds(technique.settings, key) || is_of_kernels(key);
}

std::map<std::string, std::string> settings_of(const Technique& technique, const Settings& settings) {
  std::map<std::string, std::string> all = to_strings(settings), own;
  for (const SettingHelp& help : setting_help()) {
    const std::string key = json_key(help.key);
    const bool shown = holds(common_settings(), help.key) || holds(technique.settings, help.key);
    if (shown && has_effect(settings, help.key)) own[key] = all.at(key);
  }
  return own;
}

}  // namespace lightgrid
