// The places that an effect, a technique, a setting, a light source, an error measure, a column of the light
// table and an answer of light_reaches need: the source files that name them are counted
// (docs/overview.md#how-to-add).
#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "effects/effects.h"
#include "measures/error_measures.h"
#include "scene/light_readers.h"
#include "scene/property_rows.h"
#include "support/paths.h"
#include "support/read_files.h"
#include "techniques/technique.h"

namespace lightgrid::app {
using namespace lab;
namespace {

using testing::IsEmpty;
using Naming = std::map<std::string, std::set<std::string>>;  // of each file what it names

// Comments may name anything.
std::string code_of(const std::string& text) { return std::regex_replace(text, std::regex("//[^\n]*"), ""); }

std::string text_at(const std::string& path) {
  return file_bytes(std::filesystem::path(source_folder) / path);
}

// Files of these folders of the checkout in which one of an item's texts stands.
Naming files_that_name(const std::vector<std::string>& folders,
                       const std::map<std::string, std::vector<std::string>>& texts) {
  const std::filesystem::path root = source_folder;
  Naming found;
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      const std::string code = code_of(file_bytes(entry.path()));
      for (const auto& [item, own_texts] : texts) {
        if (std::ranges::any_of(own_texts, [&](auto& text) { return code.find(text) != code.npos; }))
          found[entry.path().lexically_relative(root).generic_string()].insert(item);
      }
    }
  }
  return found;
}

// The names that only one of the two has: lines "FILE: NAME".
std::set<std::string> differences(const Naming& found, const Naming& expected) {
  std::set<std::string> lines[2], apart;
  for (const Naming* naming : {&found, &expected}) {
    for (const auto& [file, names] : *naming) {
      for (const std::string& name : names) lines[naming == &expected].insert(file + ": " + name);
    }
  }
  std::ranges::set_symmetric_difference(lines[0], lines[1], std::inserter(apart, apart.end()));
  return apart;
}

std::vector<std::string> mentions(const std::string& text, const std::string& word) {
  const std::regex whole("\\b" + word + "\\b");
  std::vector<std::string> all;
  for (std::sregex_iterator at(text.begin(), text.end(), whole), end; at != end; ++at)
    all.push_back(at->str());
  return all;
}

// Its own file, a declaration and a row in registry.cpp, and its page (Techniques.HaveAPageEach…). Recipes
// adds one in these places and builds.
TEST(Adding, ATechniqueTakesItsFileAndTheRegistry) {
  const std::string registry = code_of(text_at("src/engine/techniques/registry.cpp"));
  for (const Technique* t : techniques()) {
    const std::string name = t->name;
    EXPECT_EQ(mentions(registry, name).size(), 2u) << name;
    EXPECT_THAT(text_at("src/engine/techniques/" + name + ".cpp"),
                testing::HasSubstr("extern const Technique " + name + "{"));
  }
}

std::string without_underscores(std::string name, const std::string& instead) {
  return std::regex_replace(name, std::regex("_"), instead);
}

// Its own files, at most five, and a declaration and a row in effects.cpp.
TEST(Adding, AnEffectTakesItsFilesAndTheTable) {
  std::map<std::string, std::vector<std::string>> texts;
  std::map<std::string, size_t> own;
  Naming expected = {
      // Points and sequences that have it by choice.
      {"src/laboratory/frontier/points.cpp", {"far_light"}},
      {"src/laboratory/verify/hunt_sequences.cpp", {"far_light"}},
      // A glTF extension has them.
      {"src/engine/scene/gltf/lights.cpp", {"area_lights"}},
      // The option that names the picture, and files that have it.
      {"src/engine/scene/gltf/image_based_light.cpp", {"environment_light"}},
      {"src/engine/run/scene_choice.cpp", {"environment_light"}},
      // The scene has the names of groups, and lightgrid_light the mask.
      {"src/engine/scene/scene.h", {"light_groups"}},
      {"src/apps/c_api/scene.cpp", {"light_groups"}},
      // A scene that has them, and hard cases.
      {"src/engine/scenes/rooms.cpp", {"light_groups"}},
      {"src/laboratory/verify/device_engine.cpp", {"light_groups"}},
      {"src/laboratory/verify/group_cases.cpp", {"light_groups"}},
      // Hard cases, rows of one table, and the page that lists them.
      {"src/laboratory/verify/effect_rows.cpp",
       {"area_lights", "environment_light", "far_light", "light_cookies", "light_groups", "light_hulls",
        "light_profiles"}},
      {"src/laboratory/verify/catalogue.md",
       {"area_lights", "environment_light", "far_light", "light_cookies", "light_hulls", "light_profiles"}},
      // Its volume is read from a frame, and has sums of its own in double.
      {"src/engine/run/frames.h", {"far_light"}},
      {"src/laboratory/verify/effect_cases.cpp", {"far_light"}},
      // Images and tables for cases.
      {"src/engine/scenes/cookie_image.h", {"light_cookies"}},
      {"src/engine/scenes/profile_text.h", {"light_profiles"}},
  };
  // Names of its data.
  const std::map<std::string, std::vector<std::string>> data = {
      {"area_lights", {"has_rectangle(", "rectangle_of(", "set_rectangle("}},
      {"light_groups",
       {"all_groups", "group_names", "GroupLists", "compile_groups", "groups_of(", "set_groups(",
        "group_masks", "max_groups"}}};
  const std::string table = code_of(text_at("src/engine/effects/effects.cpp"));
  for (const Effect* effect : all_effects) {
    const std::string name = effect->name, key = without_underscores(name, "-");
    texts[name] = {'"' + key, key + "=", '"' + without_underscores(name, " "), define_of(*effect)};
    for (const char* after : {" ", ",", ";", ".", "(", ")", "/", "_", "->", "\""})
      texts[name].push_back(name + after);
    if (const auto own_data = data.find(name); own_data != data.end())
      texts[name].insert(texts[name].end(), own_data->second.begin(), own_data->second.end());
    expected["src/engine/effects/effects.cpp"].insert(name);
    EXPECT_EQ(mentions(table, name).size(), 2u) << name;
  }
  ASSERT_FALSE(texts.empty());
  EXPECT_TRUE(std::ranges::is_sorted(all_effects, {}, [](const Effect* e) { return std::string(e->name); }));
  Naming others;
  for (const auto& [file, names] : files_that_name({"src", "shaders", "kernels"}, texts)) {
    for (const std::string& name : names) {
      const bool is_own = file.starts_with("src/engine/effects/" + name + ".") ||
                          file == "src/engine/shared/effects/" + name + ".h" ||
                          file.starts_with("src/engine/scene/" + name + ".") ||
                          file.starts_with("kernels/" + name + "/");
      if (is_own)
        ++own[name];
      else
        others[file].insert(name);
    }
  }
  EXPECT_THAT(differences(others, expected), IsEmpty());
  for (const auto& [name, files] : own) EXPECT_LE(files, 5u) << name;
}

// Its row, from which all readers and writers of files follow.
TEST(Adding, APropertyOfLightsTakesOneRow) {
  std::map<std::string, std::vector<std::string>> texts;
  std::map<std::string, size_t> files_of;
  for (const PropertyRow& row : property_rows()) {
    const PropertyKey& key = row.keys.front();
    texts[key.key] = {'"' + key.key + '"'};
  }
  ASSERT_TRUE(texts.contains("groups"));
  for (const auto& [file, keys] : files_that_name({"src"}, texts)) {
    // An example, and lights files of hard cases.
    if (file == "src/apps/c_api/lightgrid.h" || file == "src/laboratory/verify/effect_rows.cpp") continue;
    for (const std::string& key : keys) ++files_of[key];
  }
  for (const auto& [key, own] : texts) EXPECT_EQ(files_of[key], 1u) << key;
}

// Without an oracle an effect that is wrong would pass: techniques would only be compared with each other.
TEST(Adding, EveryHookOfAnEffectHasItsOracle) {
  std::vector<std::string> keys_that_mean;
  for (const SettingRow& setting : setting_rows()) {
    if (setting.flags.mean) keys_that_mean.push_back(setting.key);
  }
  for (const Effect* effect : all_effects)
    EXPECT_EQ(missing_oracle(*effect, keys_that_mean), "") << effect->name;
}

// The hooks with an oracle are those that the text answers.
TEST(Adding, AnEffectsTextAnswersTheHooksThatHaveAnOracle) {
  for (const Effect* effect : all_effects) {
    const std::string name = effect->name, define = define_of(*effect), upper = define.substr(7);
    const std::string text = text_at("src/engine/shared/effects/" + name + ".h");
    const auto lists = [&](const std::string& hook) {
      return text.find("#define " + upper + hook + "_INPUTS(") != text.npos;
    };
    EXPECT_EQ(lists("_BASE"), effect->base.has_value()) << name;
    EXPECT_EQ(lists("_REACH") || lists("_TINT"), effect->reach && effect->reach->term) << name;
    EXPECT_EQ(lists("_MEETS"), has_masks(*effect)) << name;
    EXPECT_EQ(lists("_LIT"), effect->lit.has_value()) << name;
  }
}

TEST(Adding, AnEffectThatASettingStandsForIsNotInThePictureThatIsMeant) {
  const Scene scene{.lights = {{.radius_m = 2}}};
  for (const Effect* effect : all_effects) {
    if (!effect->base || !effect->base->meant_by) continue;
    bool ever_drawn = false;
    const auto setting = std::ranges::find(setting_rows(), effect->base->meant_by, &SettingRow::key);
    ASSERT_NE(setting, setting_rows().end());
    for (const std::string& value : setting->values) {
      FramePlan plan{.lights = {.local = {0}}};
      apply_setting(plan.settings, setting->key + "=" + value);
      ever_drawn = ever_drawn || effect->decide(scene, plan);
      plan.settings = meant_by(plan.settings);
      EXPECT_FALSE(effect->decide(scene, plan)) << setting->key << "=" << value;
    }
    EXPECT_TRUE(ever_drawn) << effect->name;
  }
}

// With the text of each key that has a name.
std::string with_keys(std::string code) {
  const std::regex named("(\\w+_key)\\[\\] = (\"[^\"]+\")");
  std::vector<std::pair<std::string, std::string>> keys;
  for (std::sregex_iterator at(code.begin(), code.end(), named), end; at != end; ++at)
    keys.emplace_back((*at)[1], (*at)[2]);
  for (const auto& [name, key] : keys) code = std::regex_replace(code, std::regex(name + ","), key + ",");
  return code;
}

// Its row, which no list of settings names.
TEST(Adding, ASettingTakesOneRow) {
  const std::regex row("Setting<[\\w:<>]+> (\\w+)\\{\\s*\\d+,\\s*\"([^\"]+)\"");
  std::map<std::string, std::vector<std::string>> files_of;
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(source_folder) / "src")) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    const std::string code = with_keys(code_of(file_bytes(entry.path())));
    for (std::sregex_iterator at(code.begin(), code.end(), row), end; at != end; ++at) {
      files_of[(*at)[2]].push_back(entry.path().string());
      names.push_back((*at)[1]);
    }
  }
  std::vector<std::string> keys;
  for (const SettingRow& setting : setting_rows()) {
    EXPECT_THAT(files_of[setting.key], testing::SizeIs(1)) << setting.key;
    keys.push_back('"' + setting.key + '"');
  }
  const std::string all =
      code_of(text_at("src/engine/plan/settings.h")) + code_of(text_at("src/engine/plan/settings.cpp"));
  for (const std::string& key : keys) EXPECT_THAT(all, testing::Not(testing::HasSubstr(key)));
  for (const std::string& name : names)
    EXPECT_FALSE(std::regex_search(all, std::regex("setting::" + name + "\\b"))) << name;
}

// The number of data members that a struct declares.
size_t members_of(const std::string& file, const std::string& name) {
  const std::string code = code_of(text_at(file)), head = "struct " + name + " {\n";
  const size_t begin = code.find(head);
  if (begin == code.npos) return SIZE_MAX;
  const std::string body = code.substr(begin + head.size(), code.find("\n};", begin) - begin - head.size());
  const std::string flat = std::regex_replace(body, std::regex("<[^;<>]*>|\\([^;()]*\\)|\\{[^;{}]*\\}"), "");
  return size_t(std::ranges::count_if(flat, [](char c) { return c == ';' || c == ','; }));
}

// Parts, not effects: an effect adds a member to its own part, or none.
TEST(Adding, ThePlanAndTheNeedsHaveAMemberForEachPart) {
  EXPECT_LE(members_of("src/engine/plan/frame_plan.h", "FramePlan"), 20u);
  EXPECT_LE(members_of("src/engine/plan/technique_needs.h", "TechniqueNeeds"), 8u);
  EXPECT_EQ(members_of("src/engine/plan/mask_plan.h", "MaskPlan"), 5u) << "what is counted";
  EXPECT_EQ(members_of("src/engine/plan/instance_boxes.h", "InstanceBox"), 10u) << "of lists as well";
}

// The functions that they call depend on the plan: stages of a frame (passes/frame_stages.h), effects, light sources.
TEST(Adding, TheRunnerAndTheRecipesNameNoEffect) {
  for (const char* file : {"src/engine/techniques/registry.cpp", "src/engine/techniques/recipes.cpp",
                           "src/engine/run/technique_run.cpp"}) {
    std::string code = code_of(text_at(file));
    std::ranges::transform(code, code.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    for (const char* effect : {"shadow", "group", "virtual_lights", "clearcoat"})
      EXPECT_EQ(code.find(effect), code.npos) << file << " names " << effect;
    for (const Effect* effect : all_effects)
      EXPECT_EQ(code.find(effect->name), code.npos) << file << " names " << effect->name;
  }
}

// Its builder, which makes the LightSource, and the choice of a loop in forward.frag; and that of kernels
// where they read it too. The loop's own text names nothing.
TEST(Adding, ALightSourceTakesItsBuilderAndTheChoiceOfItsLoop) {
  std::map<std::string, std::vector<std::string>> texts = {
      {"-DWORLD_GRID", {"-DWORLD_GRID\"", "#ifdef WORLD_GRID", "defined(WORLD_GRID)"}}};
  std::set<std::string> in_glsl;
  const std::string choice = code_of(text_at("shaders/forward.frag"));
  const std::regex define("defined\\((LIGHTS_\\w+)\\)");
  for (std::sregex_iterator at(choice.begin(), choice.end(), define), end; at != end; ++at) {
    in_glsl.insert((*at)[1]);
    texts[(*at)[1]] = {(*at)[1]};
  }
  const Naming expected = {
      {"shaders/forward.frag", in_glsl},
      {"kernels/resolve/resolve_light.h", {"-DWORLD_GRID", "LIGHTS_VOXELS"}},
      {"src/engine/passes/build_voxels.cpp", {"LIGHTS_VOXELS"}},
      {"src/engine/passes/build_world_grid.cpp", {"-DWORLD_GRID", "LIGHTS_WORLD"}},
      {"src/engine/passes/common/light_buffer.cpp", {"LIGHTS_BUFFER"}},
      {"src/engine/passes/cull_lights.cpp", {"LIGHTS_GRID", "LIGHTS_MASKS"}},
      {"src/engine/passes/find_object_lights.cpp", {"LIGHTS_OBJECT"}},
      {"src/engine/passes/light_index.cpp", {"LIGHTS_LIDR"}},
  };
  EXPECT_THAT(differences(files_that_name({"src", "shaders", "kernels"}, texts), expected), IsEmpty());
}

// Its field, and its function with its row in error_measures.cpp.
TEST(Adding, AnErrorMeasureTakesItsFieldAndItsRow) {
  std::map<std::string, std::vector<std::string>> texts;
  std::set<std::string> all;
  std::vector<ErrorMeasure> measures(error_measures().begin(), error_measures().end());
  measures.insert(measures.end(), frontier_error_measures().begin(), frontier_error_measures().end());
  for (const ErrorMeasure& measure : measures) {
    const std::string key = measure.key;
    all.insert(key);
    texts[key] = {"ImageError::" + key + ",", '"' + key + "\", \""};
    const std::string results = text_at("src/laboratory/measures/results.h");
    const size_t begin = results.find("struct ImageError {");
    const std::string fields = results.substr(begin, results.find("};", begin) - begin);
    EXPECT_THAT(fields, testing::AnyOf(testing::HasSubstr("  double " + key + " = 0;"),
                                       testing::HasSubstr("  double " + key + " = unknown_error;")));
  }
  const Naming expected = {
      {"src/laboratory/measures/error_measures.cpp", all},
      // Figures of the frontier about two pictures, next to the one that a sample is of.
      {"src/laboratory/frontier/answer_csv.cpp", {"max_rel"}},
      // Figures of the oracle and of surfaces have these names too.
      {"src/laboratory/report/report.cpp", {"max_rel", "rmse_rel"}},
  };
  EXPECT_THAT(differences(files_that_name({"src"}, texts), expected), IsEmpty());
}

// Its row and its values, and each that computes with it; a fourth is the member of Light that it is made of.
// Neither kernels' arguments, nor shaders' textures, nor uploads name a column.
TEST(Adding, AColumnOfTheLightTableTakesItsRowItsValuesAndItsReaders) {
  const std::string table = text_at("src/engine/shared/light_table.h");
  const std::regex row(R"(ROW\(IF_\w+, \w+, (\w+), (\w+), \w+\))");
  std::map<std::string, std::vector<std::string>> texts;
  std::set<std::string> all;
  for (std::sregex_iterator at(table.begin(), table.end(), row), end; at != end; ++at) {
    const std::string member = (*at)[1], array = (*at)[2];
    all.insert(member);
    texts[member] = {array, "glm::vec4 " + member + "(", "float " + member + "(const ViewLight"};
  }
  EXPECT_THAT(all, testing::IsSupersetOf({"position", "color", "cone", "max_falloff"}));
  // All that names the newest columns. The others are read by every light loop.
  texts["cone"].push_back("light.cone.");
  texts["max_falloff"].push_back("REAL(light.max_falloff");
  const Naming expected = {
      {"src/engine/shared/light_table.h", all},
      {"src/engine/renderer/upload/lights.cpp", all},
      // Readers: the range alone; a cone's part in what arrives.
      {"shaders/lights/blocks.glsl", {"position"}},
      {"src/engine/shared/punctual_light.h", {"cone", "max_falloff"}},
      {"src/engine/shared/voxel_exact.h", {"cone", "max_falloff"}},
      // A record of the culler's own, from LightBounds.
      {"kernels/culling/gpu/cull_lights.cl", {"cone"}},
  };
  EXPECT_THAT(differences(files_that_name({"src", "kernels", "shaders"}, texts), expected), IsEmpty());
}

// Its text for all three languages, the same in double, and the effect of the plan that asks for it.
TEST(Adding, AnAnswerOfLightReachesTakesItsTextItsOracleAndThePlan) {
  const std::map<std::string, std::vector<std::string>> texts = {
      {"answers", {"real light_reaches(", "dvec3 light_reaches(", "plan.light_reaches = "}},
  };
  const Naming expected = {
      {"src/engine/shared/light_table.h", {"answers"}},
      {"src/laboratory/oracle/attenuation.h", {"answers"}},
      {"src/engine/plan/shadow_plan.cpp", {"answers"}},
  };
  EXPECT_THAT(differences(files_that_name({"src", "kernels", "shaders"}, texts), expected), IsEmpty());
}

std::set<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

bool names_one(const std::string& code, const std::vector<std::string>& texts) {
  return std::ranges::any_of(texts, [&](const std::string& text) { return code.find(text) != code.npos; });
}

// Computing what arrives, or how bright a light is.
const std::vector<std::string> reading = {
    " arrival_at(",        "(arrival_at(",         " voxel_arrival(",         " attenuation(light",
    " arrival_at_sample(", "arrival_beyond(",      "radiant_intensity",       "influence_of(",
    "largest_intensity(",  "brightest_intensity(", "light_importance(",       "max_irradiance(",
    "->luminance",         "record.luminance",     "double(light.intensity)", "= light.intensity * ",
    "= n.intensity"};

std::vector<LightReader> all_readers() {
  std::vector<LightReader> all(std::begin(light_readers), std::end(light_readers));
  for (const Effect* effect : all_effects) {
    if (effect->reader) all.push_back(*effect->reader);
  }
  return all;
}

// A new reader of lights is listed with what it reads, or fails here.
TEST(Adding, EveryReaderOfLightsIsListedInLightReaders) {
  std::set<std::string> listed, found;
  for (const LightReader& reader : all_readers()) listed.merge(words_of(reader.files));
  // Declarations, the table's values, and checks of others' orders.
  const std::set<std::string> no_readers = {"src/engine/scene/scene.cpp",
                                            "src/engine/plan/dim_lights.h",
                                            "src/engine/renderer/upload/lights.cpp",
                                            "src/engine/scene/effect_terms.cpp",
                                            "src/engine/scene/effect_terms.h",
                                            "src/engine/scene/light_ranges.h",
                                            "src/engine/scene/light_readers.h",
                                            "src/engine/scene/shadow_casters.h",
                                            "src/engine/scene/view_lights.cpp",
                                            "src/engine/scene/view_lights.h",
                                            "src/laboratory/verify/cap_cases.cpp",
                                            "src/laboratory/verify/effect_cases.cpp",
                                            "src/laboratory/verify/light_index_cases.cpp"};
  for (const auto& [file, items] : files_that_name({"src", "kernels", "shaders"}, {{"reads", reading}})) {
    if (!no_readers.contains(file)) found.insert(file);
  }
  EXPECT_EQ(found, listed);
}

// Texts by which a factor is read. Of a new one its own name.
std::vector<std::string> marks_of(const std::string& factor) {
  const std::vector<std::string> arrivals = {"arrival_at(", "arrival_beyond(", "attenuation(light",
                                             "voxel_arrival("};
  std::map<std::string, std::vector<std::string>> marks = {
      {"position", {"position", "radius_m", "range_of(", "bounds_of(", "influence_of("}},
      {"color", reading},
      {"cone", {"has_cone(", "cos_outer", "bounds_of("}},
      {"max_falloff", {"max_falloff"}},
      {"masks", {"light_reaches(", "mask_of(", "share.of_surface", "->mask"}},
      {"shadows", {"light_reaches("}},
      {"effects", {"light_reaches(", "largest_intensity(", "influence_of(", "share_of("}}};
  for (const char* of_distance : {"position", "color", "cone", "max_falloff"})
    marks[of_distance].insert(marks[of_distance].end(), arrivals.begin(), arrivals.end());
  const auto own = marks.find(factor);
  return own == marks.end() ? std::vector<std::string>{factor} : own->second;
}

TEST(Adding, AReaderOfLightsReadsTheFactorsThatItClaims) {
  for (const LightReader& reader : all_readers()) {
    SCOPED_TRACE(reader.name);
    EXPECT_TRUE(says_all(reader));
    std::string code;
    for (const std::string& file : words_of(reader.files)) {
      code += code_of(text_at(file));
      // Each light loop ends with the hook.
      if (reader.masks == reads && reader.shadows == reads) {
        EXPECT_TRUE(names_one(code_of(text_at(file)), {"light_reaches("})) << file;
      }
    }
#define LIGHT_FACTOR(condition, type, member, array, texels)    \
  if (reader.member == reads) {                                 \
    EXPECT_TRUE(names_one(code, marks_of(#member))) << #member; \
  }
    LIGHT_TABLE(LIGHT_FACTOR)
#undef LIGHT_FACTOR
    if (reader.shadows == reads) {
      EXPECT_TRUE(names_one(code, marks_of("shadows")));
    }
    if (reader.effects == reads) {
      EXPECT_TRUE(names_one(code, marks_of("effects")));
    }
  }
}

}  // namespace
}  // namespace lightgrid::app
