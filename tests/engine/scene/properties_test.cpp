// Properties that an effect of this test owns, from both kinds of files and back.
#include "scene/properties.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "base/write_file.h"
#include "scene/light_groups.h"
#include "scene/lights_file.h"
#include "scene/load_gltf.h"
#include "scene/property_rows.h"
#include "scene/write_gltf.h"
#include "support/gltf_builder.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;

FileTable parse(const std::vector<uint8_t>& bytes) {
  if (bytes.size() < 2) throw input_error("is too short");
  FileTable table{.shape = {uint32_t(bytes.size())}};
  for (const uint8_t byte : bytes) table.values.push_back(byte);
  return table;
}

const Property<double> part{"planted_part", 1, {.low = 0, .high = 2, .inherited = true}};
const Property<uint32_t> bits{"planted_bits", 7};
const Property<glm::dvec3> axis{"planted_axis", glm::dvec3(0)};
const Property<std::string> word{"planted_word", "", {.inherited = true}};
const Property<SharedTable> table{"planted_table", nullptr, {.parse = parse}};

class Files : public testing::Test {
 protected:
  std::vector<Light> load(const json& light) {
    json given = {{"position", {0, 0, 0}}};
    given.update(light);
    write_file(folder_.path / "lights.json", json({{"lights", {given, given}}}).dump());
    return load_lights_file(folder_.path / "lights.json");
  }
  std::string fault(const json& light) {
    try {
      load(light);
    } catch (const Error& error) {
      return error.what();
    }
    return "no fault";
  }

  TempFolder folder_;
};

void expect_planted(const Light& light) {
  EXPECT_EQ(part.of(light), 0.25);
  EXPECT_EQ(bits.of(light), 0xffffffffu);
  EXPECT_EQ(axis.of(light), glm::dvec3(0.5, -1, 3));
  EXPECT_EQ(word.of(light), "a b");
  ASSERT_TRUE(table.of(light));
  EXPECT_THAT(table.of(light)->values, testing::ElementsAre('x', 'y', 'z'));
  EXPECT_THAT(table.of(light)->shape, testing::ElementsAre(3u));
}

TEST_F(Files, HaveTheValuesOfEveryType) {
  write_file(folder_.path / "profile.bin", "xyz");
  const json given = {{"planted_part", 0.25},
                      {"planted_bits", 0xffffffffu},
                      {"planted_axis", {0.5, -1, 3}},
                      {"planted_word", "a b"},
                      {"planted_table", "profile.bin"}};
  const std::vector<Light> lights = load(given);
  expect_planted(lights.at(0));
  EXPECT_EQ(table.of(lights[0]), table.of(lights[1])) << "one file is read once";

  write_file(folder_.path / "deeper.json", lights_file_text(lights));
  EXPECT_EQ(load_lights_file(folder_.path / "deeper.json"), lights);

  Scene scene;
  scene.lights = lights;
  const std::vector<uint8_t> glb = glb_of(scene);
  const std::filesystem::path file = folder_.path / "elsewhere.glb";
  write_file(file, std::string(glb.begin(), glb.end()));
  std::filesystem::remove(folder_.path / "profile.bin");
  expect_planted(load_gltf(file).lights.at(1));
}

TEST_F(Files, WriteNoDefaults) {
  const std::vector<Light> lights = load({{"planted_part", 1}, {"planted_bits", 7}, {"planted_word", ""}});
  EXPECT_THAT(lights_file_text(lights), testing::Not(HasSubstr("planted")));
  EXPECT_EQ(lights.at(0), load(json::object()).at(0));
  EXPECT_EQ(bits.of(lights[0]), 7u);
}

TEST_F(Files, FaultsNameTheLightAndTheField) {
  const std::string light = (folder_.path / "lights.json").string() + ": light 0: ";
  EXPECT_EQ(fault({{"planted_part", 3}}), light + "planted_part 3 is not a number from 0 to 2");
  EXPECT_EQ(fault({{"planted_bits", 0.5}}), light + "planted_bits 0.5 is not a whole number");
  EXPECT_EQ(fault({{"planted_axis", {1, 2}}}), light + "planted_axis [1,2] is not three numbers");
  EXPECT_EQ(fault({{"planted_word", 3}}), light + "planted_word 3 is not a string");
  EXPECT_THAT(fault({{"planted_prt", 0.5}}), HasSubstr("did you mean planted_part?"));
  EXPECT_THAT(fault({{"planted_table", "none.bin"}}), HasSubstr(light + "file \"none.bin\" cannot be read"));
  write_file(folder_.path / "short.bin", "x");
  EXPECT_EQ(fault({{"planted_table", "short.bin"}}), light + "planted_table short.bin: is too short");
}

TEST(PropertiesInGltf, ANodesValueReplacesThatOfItsLight) {
  GltfBuilder made = GltfBuilder::triangle();
  const json of_light = {{"light_planted_part", 0.5}, {"light_planted_word", "lamp"}};
  made.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"extras", {{"lightgrid", of_light}, {"light_planted_bits", 3}}}}};
  made.node()["extensions"]["KHR_lights_punctual"]["light"] = 0;
  made.node()["extras"]["lightgrid"]["light_planted_part"] = 0.75;
  const Light light = made.load().lights.at(0);
  EXPECT_EQ(bits.of(light), 7u) << "which is the program's own";
  EXPECT_EQ(part.of(light), 0.75);
  EXPECT_EQ(word.of(light), "lamp");
}

TEST(Properties, AreInheritedOnlyIfTheRowSaysSo) {
  Light light;
  part.set(light, 0.5);
  bits.set(light, 1);
  set_groups(light, 6);
  Light virtual_light;
  virtual_light.properties = inherited(light.properties);
  EXPECT_EQ(part.of(virtual_light), 0.5);
  EXPECT_EQ(bits.of(virtual_light), 7u);
  EXPECT_EQ(groups_of(virtual_light), 6u);
}

TEST(Properties, AreEqualByContent) {
  Light a, b;
  table.set(a, std::make_shared<const FileTable>(FileTable{.values = {1}}));
  EXPECT_FALSE(a == b);
  table.set(b, std::make_shared<const FileTable>(FileTable{.values = {1}}));
  EXPECT_TRUE(a == b);
  table.set(b, std::make_shared<const FileTable>(FileTable{.values = {2}}));
  EXPECT_FALSE(a == b);
  table.set(a, nullptr);
  EXPECT_TRUE(a.properties.values().empty());
}

}  // namespace
}  // namespace lightgrid
