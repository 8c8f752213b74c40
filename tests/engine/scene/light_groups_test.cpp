#include "scene/light_groups.h"

#include <gmock/gmock.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/lights_file.h"
#include "support/error_of.h"
#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

// Instances "floor", "wall", "wall" and "vase", and three lights.
Scene four_instances() {
  Scene scene;
  for (const char* name : {"floor", "wall", "wall", "vase"}) {
    scene.instances.emplace_back();
    scene.instances.back().name = name;
  }
  scene.lights.resize(3);
  return scene;
}

GroupLists of(int owner, const char* groups) {
  return {.owner = owner,
          .where = "it",
          .groups = names_of_groups(json::parse(groups)),
          .include = {},
          .exclude = {}};
}

// The instances that each light lights, as rows of 0 and 1.
std::vector<std::string> lit(const Scene& scene) {
  std::vector<std::string> rows;
  for (const Light& light : scene.lights) {
    std::string& row = rows.emplace_back();
    for (const Instance& instance : scene.instances)
      row += groups_meet(groups_of(light), groups_of(instance)) ? '1' : '0';
  }
  return rows;
}

std::string refused(Scene scene, const std::vector<GroupLists>& lights,
                    const std::vector<GroupLists>& instances) {
  return error_of([&] { compile_groups(scene, lights, instances); });
}

TEST(LightGroups, MeetWhereMasksShareABit) {
  EXPECT_TRUE(groups_meet(0x80000000u, 0x80000000u)) << "the last one";
  EXPECT_FALSE(groups_meet(0x7fffffffu, 0x80000000u));
  EXPECT_FALSE(groups_meet(all_groups, 0));
  EXPECT_FALSE(groups_meet(0, all_groups));
  EXPECT_TRUE(groups_meet(all_groups, 1));
}

TEST(LightGroups, AreNotCalledForByASceneThatSaysNothing) {
  Scene scene = four_instances();
  EXPECT_FALSE(calls_for_groups(scene));
  compile_groups(scene, {}, {});
  EXPECT_FALSE(calls_for_groups(scene));
  EXPECT_TRUE(scene.group_names.empty());
  set_groups(scene.instances[3], all_groups >> 1);
  EXPECT_TRUE(calls_for_groups(scene));
}

TEST(LightGroups, NumbersKeepTheirBitsAndNamesTakeFreeOnes) {
  Scene scene = four_instances();
  compile_groups(scene, {of(0, R"(["den", 31])"), of(1, "0"), of(2, R"("yard, den")")},
                 {of(3, R"(["yard"])")});
  EXPECT_EQ(groups_of(scene.lights[1]), 1u);
  EXPECT_EQ(groups_of(scene.instances[3]), 2u) << "yard: 0 is taken by its number";
  EXPECT_EQ(groups_of(scene.lights[0]), 1u << 31 | 1u << 2);
  EXPECT_EQ(groups_of(scene.lights[2]), 2u | 4u);
  EXPECT_THAT(lit(scene), ElementsAre("1110", "1110", "1111"));
  EXPECT_EQ(words_of_groups(scene, groups_of(scene.lights[0])), "den and 31");
}

TEST(LightGroups, AnEmptyListIsNoGroup) {
  Scene scene = four_instances();
  compile_groups(scene, {of(0, "[]")}, {of(0, "[]")});
  EXPECT_THAT(lit(scene), ElementsAre("0000", "0111", "0111"));
  EXPECT_EQ(words_of_groups(scene, 0), "no group");
}

TEST(LightGroups, ListsOfInstancesCompileToMasks) {
  Scene scene = four_instances();
  std::vector<GroupLists> lists(2);
  lists[0] = {.owner = 0, .where = "key", .groups = {}, .include = {{"vase", "floor"}}, .exclude = {}};
  lists[1] = {.owner = 1, .where = "fill", .groups = {}, .include = {}, .exclude = {{"wall"}}};
  compile_groups(scene, lists, {});
  EXPECT_THAT(lit(scene), ElementsAre("1001", "1001", "1111")) << "a light without a list lights all";
  EXPECT_EQ(groups_of(scene.lights[0]), groups_of(scene.lights[1]))
      << "lists of the same instances share a group";
}

TEST(LightGroups, ListsAndGroupsOfInstancesGoTogether) {
  Scene scene = four_instances();
  const GroupLists key{.owner = 0, .where = "key", .groups = {}, .include = {{"vase"}}, .exclude = {}};
  compile_groups(scene, {key, of(1, R"(["stage"])")}, {of(1, R"(["stage"])"), of(3, R"(["stage"])")});
  EXPECT_THAT(lit(scene), ElementsAre("0001", "1111", "1111")) << "others than node 1 have every other group";
  EXPECT_EQ(groups_of(scene.instances[1]), 1u) << "stage alone";
}

TEST(LightGroups, RefusalsNameWhoIsMeant) {
  const Scene scene = four_instances();
  EXPECT_THAT(refused(scene, {of(0, "32")}, {}), HasSubstr("it: group 32 is not a number from 0 to 31"));
  EXPECT_THAT(refused(scene, {of(0, "-1")}, {}), HasSubstr("group -1"));
  std::string names = "[";
  for (int i = 0; i < 33; ++i) names += (i ? ",\"n" : "\"n") + std::to_string(i) + "\"";
  EXPECT_THAT(refused(scene, {of(0, (names + "]").c_str())}, {}),
              HasSubstr("\"n32\" is one group too many: there are at most 32"));
  const GroupLists unknown{.owner = 0, .where = "key", .groups = {}, .include = {{"vaze"}}, .exclude = {}};
  EXPECT_THAT(refused(scene, {unknown}, {}),
              HasSubstr("key: include: no node \"vaze\" shows a mesh; did you mean vase?"));
  GroupLists both = of(0, "1");
  both.exclude = {{"vase"}};
  EXPECT_THAT(refused(scene, {both}, {}), HasSubstr("give one of them"));
}

// 32 lists of one instance each: the 33rd instance, in none, would be in no group.
TEST(LightGroups, ListsThatLeaveAnInstanceInNoGroupAreRefused) {
  Scene scene;
  scene.instances.resize(33);
  scene.lights.resize(32);
  std::vector<GroupLists> lists;
  for (int i = 0; i < 33; ++i) scene.instances[size_t(i)].name = "n" + std::to_string(i);
  for (int i = 0; i < 32; ++i)
    lists.push_back({.owner = i,
                     .where = "light " + std::to_string(i),
                     .groups = {},
                     .include = {{"n" + std::to_string(i)}},
                     .exclude = {}});
  EXPECT_THAT(refused(scene, lists, {}), HasSubstr("node \"n32\""));
  scene.instances.pop_back();
  compile_groups(scene, lists, {});
  for (int i = 0; i < 32; ++i)
    EXPECT_EQ(lit(scene)[size_t(i)], std::string(size_t(i), '0') + "1" + std::string(size_t(31 - i), '0'));
}

class LightGroupFiles : public testing::Test {
 protected:
  ~LightGroupFiles() override { std::filesystem::remove(path_); }
  void load(Scene& scene, const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    load_lights(scene, path_);
  }
  const std::filesystem::path path_ = std::filesystem::path(testing::TempDir()) / "light_groups.json";
};

TEST_F(LightGroupFiles, ALightsFileGivesGroupsToLightsAndInstances) {
  Scene scene = four_instances();
  load(scene, R"({"lights": [{"position": [0, 0, 0], "groups": ["a"]},
                             {"position": [0, 0, 0], "include": ["vase"]}],
                  "instances": [{"name": "wall", "groups": ["a"]}, {"name": "floor", "groups": []}]})");
  EXPECT_THAT(lit(scene), ElementsAre("0111", "0001"));
}

TEST_F(LightGroupFiles, MasksAreWrittenAsNumbersAndReadBack) {
  Scene scene = four_instances();
  set_groups(scene.lights[0], 1u << 31 | 5u);
  set_groups(scene.lights[1], 0);
  for (Light& light : scene.lights) light.position = {1, 2, 3};
  const std::vector<Light> before = scene.lights;
  load(scene, lights_file_text(before));
  EXPECT_EQ(scene.lights, before);
}

TEST_F(LightGroupFiles, FaultsNameFileAndOwner) {
  Scene scene = four_instances();
  const auto fault = [&](const char* text) -> std::string {
    try {
      load(scene, text);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(fault(R"({"lights": [{"position": [0, 0, 0], "groups": 1.5}]})"),
              HasSubstr("light_groups.json: light 0: groups 1.5 is not a list of names and whole numbers"));
  EXPECT_THAT(fault(R"({"lights": [{"position": [0, 0, 0], "groups": [40]}]})"),
              HasSubstr("light 0: groups [40] is not a list of names and whole numbers from 0 to 31"));
  EXPECT_THAT(fault(R"({"lights": [], "instances": [{"name": "door", "groups": [1]}]})"),
              HasSubstr("instance 0 \"door\": no node of this name shows a mesh"));
  EXPECT_THAT(fault(R"({"lights": [], "instances": 3})"), HasSubstr("instances is number, not an array"));
}

TEST(GltfLightGroups, ExtrasOfNodesAndLightsAreRead) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"extras", {{"lightgrid", {{"light_groups", {"a", 4}}}}}}}};
  made.root["extensionsUsed"] = {"KHR_lights_punctual"};
  made.node()["extras"]["lightgrid"]["light_groups"] = "a";
  made.node()["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const Scene own = made.load();
  EXPECT_EQ(groups_of(own.lights.at(0)), 1u) << "a node's win over its light's";
  EXPECT_EQ(groups_of(own.instances.at(0)), 1u);
  made.node()["extras"] = json::object();
  EXPECT_EQ(groups_of(made.load().lights.at(0)), 1u | 1u << 4);
  EXPECT_EQ(groups_of(made.load().instances.at(0)), all_groups);
  made.node()["extras"]["lightgrid"]["light_groups"] = {{"not", "a list"}};
  EXPECT_THROW(made.load(), Error);
}

}  // namespace
}  // namespace lightgrid
