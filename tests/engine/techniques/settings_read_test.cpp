// Technique::settings and common_settings() against runs: a declared setting changes something that a run
// shows, and all others together change nothing.
#include <fmt/ranges.h>
#include <set>

#include <gmock/gmock.h>

#include "support/long_tests.h"
#include "support/small_scene.h"
#include "support/technique_tiers.h"
#include "techniques/observed_run.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Key;
using Assignments = std::set<std::string>;

// Other settings under which a setting shows that has no effect among the defaults.
const std::vector<Assignments>& contexts() {
  static const std::vector<Assignments> all = {
      {},
      {"raster=opencl"},
      {"samples=4"},
      {"raster=opencl", "samples=4"},
      {"lights=grid", "samples=4"},  // of visibility
      {"kernel-shape=group"},
      {"z-bins=16"},
      {"list-cap=1"},
      {"list-cap=1", "list-cap-order=sampled"},
      {"range=cutoff"},
      {"range=stochastic"},
      {"range=stochastic", "alpha=1"},
      {"lidr-overlap=2"},
      {"lidr-overlap=1", "lidr-packing=sort"},
      {"lidr-volumes=front-faces"},
      {"prepass-lights=volumes"},
      {"prepass-specular=fifth-term"},
      {"voxel-lights-exact=1"},
      {"voxel-lights-exact=1", "kernel-shape=group"},
      {"shadows=map"},
      {"shadow-rays=4"},
      {"voxel-lights-exact=1", "shadows=map"},
      {"voxel-lights-exact=1", "shadow-rays=4"},
      {"lidr-shadows=final"},
  };
  return all;
}

std::string key_of(const std::string& assignment) { return assignment.substr(0, assignment.find('=')); }

bool holds_key(const Assignments& assignments, const std::string& key) {
  return std::ranges::count(assignments, key, key_of) > 0;
}

std::vector<Assignments> contexts_of(const Technique& technique) {
  std::vector<Assignments> own;
  for (const Assignments& context : contexts()) {
    if (std::ranges::all_of(context, [&](auto& each) { return reads_setting(technique, key_of(each)); }))
      own.push_back(context);
  }
  return own;
}

// A mask, glass, clearcoat, textures, point, spot and area lights and a sun.
Scene scene_of_effects(bool shadows) {
  SmallScene s = small_scene();
  for (const char* name : {"blend", "mask", "spot", "directional", "area", "groups", "cookies", "profiles"})
    effect(name).add(s);
  s.scene.lights[2].casts_shadow = s.scene.lights[0].casts_shadow = shadows;
  // Out of sight, but it takes room in groups of all lights.
  add_spot(s.scene, "aside", {4.2, 1.3, -3.2}, {6, 1.3, -3.2}, {1, 1, 1}, 500, 1.5f, 10, 20);
  // Too dim for any step of the display.
  if (shadows) add_point(s.scene, "ember", {0, 0, -1}, {1, 1, 1}, 1e-9f, 4).casts_shadow = true;
  return s.scene;
}

// Settings of shadows show where a light casts one. There the settings of the pass that finds them show too,
// which techniques without culling do not declare.
const Scene& observed_scene(bool shadows) {
  static const Scene with = scene_of_effects(true), without = scene_of_effects(false);
  return shadows ? with : without;
}

// Kept by the technique's name: a run does not depend on the declaration.
const Observed& seen_of(const Technique& technique, const Assignments& settings, bool shadows = false) {
  static std::map<std::string, std::map<Assignments, Observed>> by_technique[2];
  auto& seen = by_technique[shadows][technique.name];
  const auto found = seen.find(settings);
  if (found != seen.end()) return found->second;
  return seen[settings] =
             observe(test_devices(), observed_scene(shadows), small_view(33, 19), technique, settings);
}

// The facts that differ, one of which may be that a run was refused.
std::string difference(const Observed& a, const Observed& b) {
  std::set<std::string> facts;
  for (const auto& [fact, value] : a) {
    if (!b.contains(fact) || b.at(fact) != value) facts.insert(fact);
  }
  for (const auto& [fact, value] : b) {
    if (!a.contains(fact)) facts.insert(fact);
  }
  return fmt::format("{}", fmt::join(facts, ", "));
}

Assignments with(Assignments context, const Assignments& others) {
  context.insert(others.begin(), others.end());
  return context;
}

// By name, where it is not read: tests of samples.
bool is_refused_unread(const std::string& key) { return key == "samples" || key == "samples-resolve"; }

// All settings that the technique does not declare, at their value of this number or their last.
Assignments not_declared(const Technique& technique, size_t value) {
  Assignments others;
  for (const SettingRow& s : setting_rows()) {
    if (!reads_setting(technique, s.key) && !is_refused_unread(s.key))
      others.insert(s.key + "=" + s.values[std::min(value, s.values.size() - 1)]);
  }
  return others;
}

// The settings that the technique does not declare and a run shows, with what shows them.
std::map<std::string, std::string> read_but_not_declared(const Technique& technique) {
  std::map<std::string, std::string> found;
  for (const Assignments& context : contexts_of(technique)) {
    const Observed& base = seen_of(technique, context);
    for (size_t value = 1; value <= (context.empty() ? 3 : 2); ++value) {
      const Assignments others = not_declared(technique, value);
      const std::string all = difference(base, seen_of(technique, with(context, others)));
      if (all.empty()) continue;
      bool alone = false;
      for (const std::string& one : others) {
        const std::string by_one = difference(base, seen_of(technique, with(context, {one})));
        if (!by_one.empty()) {
          alone = true;
          found.emplace(key_of(one), by_one);
        }
      }
      if (!alone) found.emplace(fmt::format("{}", fmt::join(others, " ")), all);
    }
  }
  return found;
}

// Returns whether a value of the setting changes a run's output, beyond refusing to run.
bool shows(const Technique& technique, const SettingRow& setting) {
  const bool shadows =
      setting.key.starts_with("shadow") || setting.key == "lidr-shadows" || setting.key == "lidr-maps";
  for (size_t i = 1; i < setting.values.size(); ++i) {
    for (const Assignments& context : contexts_of(technique)) {
      if (holds_key(context, setting.key)) continue;
      const Observed& seen =
          seen_of(technique, with(context, {setting.key + "=" + setting.values[i]}), shadows);
      if (!seen.contains("refused") && seen != seen_of(technique, context, shadows)) return true;
    }
  }
  return false;
}

// The keys that the technique declares and that no setting has, that it shares with all techniques or whose
// setting no run shows.
std::vector<std::string> declared_but_not_read(const Technique& technique) {
  std::vector<std::string> found;
  const auto is_wrong = [&](const std::string& key) {
    const auto setting = std::ranges::find(setting_rows(), key, &SettingRow::key);
    if (setting == setting_rows().end()) return true;
    return !shows(technique, *setting);
  };
  for (const std::string key : technique.settings) {
    if (std::ranges::count(common_settings(), key) > 0 || is_wrong(key)) found.push_back(key);
  }
  std::ranges::copy_if(common_settings(), std::back_inserter(found), is_wrong);
  return found;
}

struct SettingsRead : testing::TestWithParam<const Technique*> {};

TEST_P(SettingsRead, OthersThanTheDeclaredChangeNothing) {
  EXPECT_THAT(read_but_not_declared(*GetParam()), IsEmpty());
}

TEST_P(SettingsRead, EachOfTheDeclaredChangesSomething) {
  EXPECT_THAT(declared_but_not_read(*GetParam()), IsEmpty());
}

// Copies of forward_plus, in long tests of every technique, whose list is one key too short, or one too long.
std::vector<const Technique*> planted_in() {
  return long_tests() ? techniques() : std::vector{&find_technique("forward_plus")};
}

TEST(SettingsReadPlanted, FindsAKeyThatIsMissing) {
  for (const Technique* technique : planted_in()) {
    for (const std::string key : technique->settings) {
      Technique planted = *technique;
      std::erase_if(planted.settings, [&](const std::string& own) { return own == key; });
      if (reads_setting(planted, key)) continue;  // every technique takes it
      if (is_refused_unread(key)) continue;
      EXPECT_THAT(read_but_not_declared(planted), Contains(Key(key))) << technique->name;
    }
  }
}

TEST(SettingsReadPlanted, FindsAKeyTooMuch) {
  for (const Technique* technique : planted_in()) {
    for (const char* key : {"slices", "buffer-bits", "lidr-order", "voxel-reuse", "range", "no-such-key"}) {
      if (std::string(key) != "range" && reads_setting(*technique, key)) continue;
      Technique planted = *technique;
      planted.settings.push_back(key);
      EXPECT_THAT(declared_but_not_read(planted), ElementsAre(key)) << technique->name;
    }
  }
}

LIGHTGRID_TECHNIQUES_OF_BOTH_TIERS(SettingsRead);

}  // namespace
}  // namespace lightgrid
