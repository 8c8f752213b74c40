// Sequences of the hunt of shadows: what the library keeps from frame to frame does not show, and what a
// faulty one keeps does.
#include <gmock/gmock.h>

#include <cstring>

#include <nlohmann/json.hpp>

#include "hard_cases/library_engine.h"
#include "support/gltf_pointers.h"
#include "support/long_tests.h"
#include "verify/check.h"
#include "verify/hunt_sequences.h"
#include "verify/hunt_shadows.h"
#include "verify/run.h"

namespace lightgrid::lab::verify {
namespace {

// Draws the scene as it was before lights changed where nothing else did, as if shadow-reuse overlooked them.
class OverlooksLights : public FrameSequence {
 public:
  OverlooksLights(CullEngine& library, const Scene& scene, const std::string& technique, const View& view,
                  const Settings& settings)
      : scene_(scene), shown_(scene) {
    frames_ = library.sequence(shown_, technique, view, settings);
  }

  SequenceFrame draw(const View& view, const SceneChanges& changes) override {
    if (changes.lights.empty() || !changes.instances.empty() || !changes.meshes.empty()) shown_ = scene_;
    return frames_->draw(view, changes);
  }

 private:
  const Scene& scene_;
  Scene shown_;
  std::unique_ptr<FrameSequence> frames_;
};

// Is not told of all changes.
class Forgets : public FrameSequence {
 public:
  Forgets(std::unique_ptr<FrameSequence> frames, std::vector<int> SceneChanges::*what)
      : frames_(std::move(frames)), what_(what) {}

  SequenceFrame draw(const View& view, const SceneChanges& changes) override {
    SceneChanges told = changes;
    (told.*what_).clear();
    return frames_->draw(view, told);
  }

 private:
  std::unique_ptr<FrameSequence> frames_;
  std::vector<int> SceneChanges::*what_;
};

// The library, whose sequences are drawn with a fault.
struct Faulty : LibraryEngine {
  explicit Faulty(std::vector<int> SceneChanges::*of = nullptr) : forgotten(of) {}

  std::vector<int> SceneChanges::*forgotten;  // null: OverlooksLights

  std::vector<ShadowImage> shadows(const Scene& scene, std::span<const View> views,
                                   const Settings& settings) override {
    return library->shadows(scene, views, settings);
  }
  std::unique_ptr<FrameSequence> sequence(const Scene& scene, const std::string& technique, const View& view,
                                          const Settings& settings) override {
    if (!forgotten) return std::make_unique<OverlooksLights>(*library, scene, technique, view, settings);
    return std::make_unique<Forgets>(library->sequence(scene, technique, view, settings), forgotten);
  }
};

// Ends with the first stale frame.
SequenceReport sequences_of(CullEngine& engine, const SequenceKind& kind, uint64_t scenes = 10,
                            int frames = 6) {
  SequenceReport sum;
  const std::vector<ShadowHuntClass> classes = chosen_shadow_classes("rooms|boxes");
  for (uint64_t seed = 1; seed <= scenes && sum.stale == 0; ++seed) {
    Random random(seed);
    const SequenceReport report = compare_sequence(engine, hunted_scene(classes[seed % 2], seed), kind,
                                                   settings_with(kind.settings), frames, random);
    sum.frames += report.frames;
    sum.stale += report.stale;
    sum.pairs += report.pairs;
    if (sum.why.empty()) sum.why = report.why;
  }
  return sum;
}

TEST(HuntOfSequences, WhatTheLibraryKeepsDoesNotShow) {
  const auto engine = device_engine("");
  const int frames = long_tests() ? 300 : 6;
  for (const SequenceKind& kind : sequence_kinds()) {
    if (kind.technique != std::string("visibility")) continue;
    const SequenceReport report = sequences_of(*engine, kind, 4, frames);
    EXPECT_EQ(report.frames, 4u * unsigned(frames));
    EXPECT_EQ(report.stale, 0u) << report.why;
    EXPECT_EQ(report.pairs.wrong(), 0u) << report.pairs.why;
    EXPECT_EQ(report.pairs.decided() > 5'000, kind.exact) << report.pairs.decided();
  }
}

// A floor, and three nodes with a triangle and a lamp each, of which an animation hides some.
Scene flickering() {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_node_visibility", "KHR_animation_pointer"};
  made.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 4}, {"range", 5}}};
  made.root["materials"] = {{{"doubleSided", true}}};
  made.primitive()["material"] = 0;
  made.root["nodes"][0]["translation"] = {-4, -4, 0};
  made.root["nodes"][0]["scale"] = {8, 8, 1};
  const std::vector<std::vector<uint8_t>> shown = {{1, 0, 1}, {0, 1, 1}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i) {
    made.root["nodes"].push_back({{"mesh", 0},
                                  {"translation", {-2.5 + i, -2.0, 0.5 + 0.3 * i}},
                                  {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    made.root["nodes"].push_back({{"mesh", 0}, {"translation", {-2.6 + i, -2.5, 0.3}}});
    for (const int node : {2 * i + 1, 2 * i + 2}) {
      made.root["scenes"][0]["nodes"].push_back(node);
      animate(made, visible_of(node), shown[size_t((i + node) % 3)], "SCALAR", u8);
    }
  }
  animate(made, "/extensions/KHR_lights_punctual/lights/0/intensity", std::vector<float>{4, 2, 4}, "SCALAR",
          f32);
  Scene scene = made.load();
  for (Light& light : scene.lights) light.casts_shadow = true;
  return scene;
}

TEST(HuntOfSequences, AnimatedVisibilityDoesNotShowWhatWasKept) {
  const auto engine = device_engine("");
  const View view = shadow_view({-2, -3, 4}, {-1.5, -1.5, 0});
  for (const SequenceKind& kind : sequence_kinds().first(2)) {
    Scene scene = flickering();
    Random random(7);
    const auto keeping = engine->sequence(scene, kind.technique, view, settings_with(kind.settings));
    SceneChanges changes;
    size_t changed = 0;
    for (int i = 0; i < 16; ++i, changes = set_time(scene, double(random.next() % 4) - 0.5)) {
      const SequenceFrame kept = keeping->draw(view, changes);
      const auto fresh = engine->sequence(scene, kind.technique, view, settings_with(kind.settings));
      EXPECT_EQ(difference(kept, fresh->draw(view, {})), "") << kind.settings << ", frame " << i;
      changed += !changes.empty();
    }
    EXPECT_GT(changed, 6u);
  }
}

TEST(HuntOfStaleSequences, HardCasesOfContactsFindFaultsAfterMotion) {
  Faulty lights, casters(&SceneChanges::instances);
  for (const HardCase* hard_case : chosen_cases("^shadows/lights_(beside_a_wall|inside_slivers)$")) {
    EXPECT_TRUE(fails(*hard_case, lights, 0)) << hard_case->name;
    EXPECT_TRUE(fails(*hard_case, casters, 0)) << hard_case->name;
  }
}

TEST(HuntOfStaleSequences, FaultsAreFound) {
  Faulty lights, instances(&SceneChanges::instances), meshes(&SceneChanges::meshes);
  for (Faulty* fault : {&lights, &instances, &meshes}) {
    for (const SequenceKind& kind : sequence_kinds().first(2)) {
      const SequenceReport report = sequences_of(*fault, kind);
      EXPECT_GT(report.stale, 0u) << kind.settings;
      EXPECT_THAT(report.why, testing::HasSubstr("of visibility shadow-reuse=on"));
    }
  }
}

// A wall with a lamp, a caster and its shadow, and a card between the camera and the shadow, out of the lamp's
// range, that moves. Returns the number of frames that differ from fresh ones.
int stale_behind_a_card(CullEngine& engine) {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, quad_of({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}));
  add_triangles(scene, quad_of({-1, -1, 0.4f}, {2, 0, 0}, {0, 2, 0}));
  add_triangles(scene, quad_of({0.4f, -1.2f, 6}, {0.25f, 0, 0}, {0, 0.25f, 0}));
  Light& lamp = scene.lights.emplace_back();
  lamp.position = {0.3, 0.2, 1.2};
  lamp.radius_m = 3;
  lamp.casts_shadow = true;
  const View view = shadow_view({1, -1, 8}, {0, 0, 0});
  const SequenceKind& kind = sequence_kinds().front();
  const auto keeping = engine.sequence(scene, kind.technique, view, settings_with(kind.settings));
  SceneChanges changes;
  int stale = 0;
  for (int i = 0; i < 6; ++i) {
    const SequenceFrame kept = keeping->draw(view, changes);
    const auto fresh = engine.sequence(scene, kind.technique, view, settings_with(kind.settings));
    stale += !difference(kept, fresh->draw(view, {})).empty();
    scene.instances.back().world_from_object[3].x += 0.1;
    changes.instances = {int(scene.instances.size()) - 1};
  }
  return stale;
}

TEST(HuntOfSequences, SurfacesAppearBehindAMovedCard) {
  EXPECT_EQ(stale_behind_a_card(*device_engine("")), 0);
}

// A part of the kernels, and what stands there instead.
struct KeptFault {
  const char *name, *right, *wrong;
};

struct FaultyKeptPairs : testing::TestWithParam<KeptFault> {};

TEST_P(FaultyKeptPairs, AreFound) {
  const KeptFault& fault = GetParam();
  int planted = 0;
  const auto engine = device_engine("", [&](std::string text) {
    const size_t at = text.find(fault.right);
    if (at == text.npos) return text;
    ++planted;
    return text.replace(at, std::strlen(fault.right), fault.wrong);
  });
  EXPECT_TRUE(stale_behind_a_card(*engine) > 0 || sequences_of(*engine, sequence_kinds().front()).stale > 0);
  EXPECT_GT(planted, 0) << "no kernel has this text";
}

INSTANTIATE_TEST_SUITE_P(
    Of, FaultyKeptPairs,
    testing::Values(KeptFault{"LightsAndCastersThatMoved", "row->lights ? row->lights[light]",
                              "row->lights ? light"},
                    KeptFault{"OtherSurfaces", "same_receivers && !same_receivers[tile]", "false"},
                    KeptFault{"OtherDepths", "numbers[at] == number && depth_bits[at] == depth", "true"},
                    KeptFault{"FirstLightOf32", "(listed.y + popcount(listed.x & (own - 1u)))", "listed.y"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(HuntOfStaleSequences, AStaleFrameFailsTheHuntAndItsSeedShowsItAgain) {
  Faulty engine(&SceneChanges::instances);
  const HuntOptions hunted{.contacts = 600'000, .seed = 1, .filter = "^instances$"};
  const ShadowHuntReport report = hunt_shadows(engine, hunted);
  EXPECT_GT(report.total().stale, 0u);
  EXPECT_EQ(report.total().pairs.wrong() + report.total().refused, 0u);
  ASSERT_FALSE(report.total().failed.empty());
  EXPECT_THAT(report.total().refusal, testing::HasSubstr("differ"));
  const nlohmann::ordered_json json = to_json(report);
  EXPECT_EQ(json["frames"], report.total().frames);
  EXPECT_EQ(json["classes"][0]["stale"], report.total().stale);

  const uint64_t seed = report.total().failed.front();
  const ShadowHuntReport again = hunt_shadows(engine, {.contacts = 1, .seed = seed, .filter = "^instances$"});
  EXPECT_GT(again.total().stale, 0u);
  EXPECT_EQ(again.total().failed, std::vector<uint64_t>{seed});
}

}  // namespace
}  // namespace lightgrid::lab::verify
