// The techniques, and the settings that each reads.
#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "passes/fill_far_light.h"
#include "passes/find_shadows.h"
#include "passes/resolve_samples.h"
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

// How the technique finds shadows itself; pass: it does not.
LidrShadows own_shadows(const Technique& technique, const Settings& settings) {
  return adapted_needs(technique, settings).own_shadows ? settings.lidr_shadows : LidrShadows::pass;
}

// prepass: one texel decides.
bool filters_maps(LidrShadows way) {
  return way == LidrShadows::prepass_soft || way == LidrShadows::final_pass;
}

// Settings are shown only with others that read them, and one that changes no bit where it is given.
bool has_effect(const Technique& technique, const Settings& settings, const std::string& key) {
  const LightRange range = settings.ranges.range;
  if (key == "cutoff") return range == LightRange::cutoff;
  if (key == "alpha" || key == "light-seed") return range == LightRange::stochastic;
  if (key == "window") return range == LightRange::scene || range == LightRange::cutoff;
  if (key == "far-light") return settings.far_light > 0;
  const LidrShadows own = own_shadows(technique, settings);
  if (key.ends_with("-maps")) return own == LidrShadows::final_pass;
  if (key == "shadow-size" || key == "shadow-bits" || key == "shadow-filter")
    return settings.shadows == ShadowMethod::map || filters_maps(own) ||
           (own == LidrShadows::prepass && key != "shadow-filter");
  if (key == "list-cap-order") return settings.list_cap > 0;
  if (key == "list-seed") return settings.samples_lists();
  if (key.starts_with("samples-")) return settings.samples > 1;
  if (key == "picture") return settings.picture == PictureFormat::bytes;
  if (key == "shadow-source") return settings.shadows == ShadowMethod::exact && settings.shadow_rays > 1;
  if (key == "shadow-memory" || key == "shadow-reuse" || key == "shadow-threshold" || key == "shadow-cells")
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
    for (const char* key : {"shadows", "shadow-size", "shadow-bits", "shadow-filter", "shadow-rays",
                            "shadow-source", "shadow-pick", "shadow-cells", "shadow-reuse",
                            "shadow-threshold", "shadow-memory", "picture", "everything-on"})
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

bool limits_lists(const Technique& technique, const Settings& settings) {
  return technique.limited_lists || ((settings.list_cap > 0 || settings.view_cap > 0) &&
                                     adapted_needs(technique, settings).capped_lists);
}

bool samples_lists(const Technique& technique, const Settings& settings) {
  return settings.samples_lists() && adapted_needs(technique, settings).sampled_lists;
}

bool is_random(const Technique& technique, const Settings& settings) {
  return settings.ranges.range == LightRange::stochastic || samples_lists(technique, settings);
}

bool is_approximate(const Technique& technique, const Settings& settings) {
  return technique.approximate || settings.shadows != ShadowMethod::exact || settings.soft_shadows() ||
         settings.picks_shadows() || settings.shadow_threshold > 0 || samples_lists(technique, settings) ||
         own_shadows(technique, settings) != LidrShadows::pass;
}

Frame draw_frame(const Technique& technique, RenderView& v) {
  Frame frame;
  begin_shadow_bands(v, v.caches.shadow_bits);
  do {
    fill_far_light(v, v.caches.far_light);
    frame = technique.render(v);
    frame.image = resolve_samples(v, frame.image);
  } while (next_shadow_band(v, v.caches.shadow_bits, frame.image));
  tell_shadows(v, v.caches.shadow_bits, frame);
  return frame;
}

int most_samples(const Technique& technique, const Settings& settings) {
  return adapted_needs(technique, settings).most_samples;
}

void check_samples(const Technique& technique, const Settings& settings) {
  const int most = most_samples(technique, settings);
  if (settings.samples > 1 && settings.samples_resolve != SamplesResolve::linear &&
      !holds(technique.settings, "samples-resolve"))
    throw input_error(
        "set samples-resolve: {} averages light where it shades tiles; choose "
        "samples-resolve=linear",
        technique.name);
  if (settings.samples <= most) return;
  throw input_error("set samples={}: {} with these settings takes {} a pixel", settings.samples,
                    technique.name, most);
}

std::map<std::string, std::string> settings_of(const Technique& technique, const Settings& settings) {
  std::map<std::string, std::string> all = to_strings(settings), own;
  for (const SettingHelp& help : setting_help()) {
    const std::string key = json_key(help.key);
    const bool shown = holds(common_settings(), help.key) || holds(technique.settings, help.key);
    if (shown && has_effect(technique, settings, help.key)) own[key] = all.at(key);
  }
  return own;
}

}  // namespace lightgrid
