#include "scene/lights_file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/error.h"
#include "base/write_file.h"
#include "scene/camera.h"
#include "scene/virtual_lights.h"
#include "support/gltf_builder.h"
#include "support/shared_files.h"

namespace lightgrid {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class LightsFile : public testing::Test {
 protected:
  LightsFile() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ =
        std::filesystem::path(testing::TempDir()) / (std::string("lights_file_") + info->name() + ".json");
  }
  ~LightsFile() override { std::filesystem::remove(path_); }

  std::vector<Light> load(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return load_lights_file(path_);
  }
  Light load_one(const std::string& fields) { return load("{\"lights\": [{" + fields + "}]}").at(0); }

  // The message after the file's name.
  std::string refused(const std::string& text) {
    try {
      load(text);
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_EQ(message.find(path_.string() + ": "), 0) << message;
      return message.substr(std::min(message.size(), path_.string().size() + 2));
    }
    return "no error";
  }
  std::string refused_light(const std::string& fields) {
    return refused("{\"lights\": [{\"position\": [0, 0, 0]}, {" + fields + "}]}");
  }

  std::filesystem::path path_;
};

TEST_F(LightsFile, UnknownFieldsAreRefusedWithTheNearestOne) {
  const std::string at = R"("position": [1, 2, 3], )";
  EXPECT_THAT(refused_light(at + R"("colour": [1, 0, 0])"),
              HasSubstr("colour: unknown field; did you mean color?; fields are name, type, position"));
  EXPECT_THAT(refused_light(at + R"("raduis": 3)"), HasSubstr("did you mean radius?"));
  EXPECT_THAT(refused_light(at + R"("rgb255": [1, 2, 3], "colour": 3)"), HasSubstr("colour: unknown field"));
  EXPECT_THAT(refused(R"({"lights": [], "instances": [{"name": "door", "group": [1]}]})"),
              HasSubstr("group: unknown field; did you mean groups?"));
}

TEST_F(LightsFile, RangeIsAnotherNameOfRadius) {
  const std::string at = R"("position": [1, 2, 3], )";
  EXPECT_EQ(load_one(at + R"("range": 2.5)").radius_m, 2.5f);
  EXPECT_THAT(refused_light(at + R"("range": -1)"), HasSubstr("range -1 is below 0"));
  EXPECT_THAT(refused_light(at + R"("range": 2, "radius": 2)"), HasSubstr("has both radius and range"));
}

TEST_F(LightsFile, ListsWithMistypedNamesAreAWarning) {
  EXPECT_THAT(warnings_of([&] { load(R"({"lights": [], "instance": [], "map": "keep", "units": 8})"); }),
              HasSubstr("instance is not read; did you mean instances?"));
}

TEST_F(LightsFile, EveryFieldIsRead) {
  const Light light = load_one(
      R"("name": "lamp", "type": "spot", "position": [1, 2.5, -3], "direction": [0, -2, 0], "radius": 4,
         "inner_cone": 0.25, "outer_cone": 0.5, "color": [1, 0.5, 0.25], "intensity": 8, "casts_shadow": true,
         "source_radius": 0.125)");
  EXPECT_EQ(light.name, "lamp");
  EXPECT_EQ(light.type, LightType::spot);
  EXPECT_EQ(light.position, glm::dvec3(1, 2.5, -3));
  EXPECT_EQ(light.direction, glm::vec3(0, -1, 0));
  EXPECT_EQ(light.radius_m, 4);
  EXPECT_EQ(light.inner_cone_rad, 0.25f);
  EXPECT_EQ(light.outer_cone_rad, 0.5f);
  EXPECT_EQ(light.color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(light.intensity, 8);
  EXPECT_TRUE(light.casts_shadow);
  EXPECT_EQ(light.source_m, 0.125f);
}

TEST_F(LightsFile, EqualConesAreAHardEdgeAndSoAreInvertedOnesWithAWarning) {
  const auto load_cone = [&](const char* inner) {
    return load_one(
        fmt::format(R"("type": "spot", "position": [0, 0, 0], "direction": [0, -1, 0], "inner_cone": {},
                                   "outer_cone": 0.5)",
                    inner));
  };
  Light light;
  EXPECT_EQ(warnings_of([&] { light = load_cone("0.5"); }), "");
  EXPECT_EQ(light.inner_cone_rad, 0.5f);
  EXPECT_THAT(
      warnings_of([&] { light = load_cone("0.6"); }),
      testing::HasSubstr("light 0: inner_cone 0.6 is above outer_cone 0.5; the cone has a hard edge"));
  EXPECT_EQ(light.inner_cone_rad, 0.5f);
}

TEST_F(LightsFile, AbsentFieldsHaveTheirDefaults) {
  const Light light = load_one(R"("position": [0, 0, 0])");
  EXPECT_EQ(light.type, LightType::point);
  EXPECT_EQ(light.color, glm::vec3(1));
  EXPECT_EQ(light.intensity, 1);
  EXPECT_TRUE(std::isinf(light.radius_m));
  EXPECT_FALSE(light.casts_shadow);
  EXPECT_LT(light.source_m, 0);
  EXPECT_TRUE(load(R"({"lights": []})").empty());
}

TEST_F(LightsFile, RadiusZeroIsALightThatReachesNothing) {
  EXPECT_EQ(load_one(R"("position": [0, 0, 0], "radius": 0)").radius_m, 0);
}

TEST_F(LightsFile, RedEclipseLightsAreTurnedAndScaled) {
  // (80, 16, 24) map units, z up: 10 m along x, 3 m up, 2 m into the picture. Radius 32 units is 4 m: 4
  // candela.
  const Light light =
      load_one(R"("position": [80, 16, 24], "radius": 32, "rgb255": [255, 51, 0], "casts_shadow": true)");
  EXPECT_TRUE(light.casts_shadow);
  EXPECT_EQ(light.position, glm::dvec3(10, 3, -2));
  EXPECT_EQ(light.radius_m, 4);
  EXPECT_EQ(light.intensity, 4);
  EXPECT_EQ(light.color, glm::vec3(1, 0.2f, 0));
  const Light unlimited = load_one(R"("position": [0, 0, 0], "radius": 0, "rgb255": [1, 2, 3])");
  EXPECT_TRUE(std::isinf(unlimited.radius_m));
  EXPECT_EQ(unlimited.intensity, 64);
}

TEST_F(LightsFile, SavedLightsAreLoadedAsTheyWere) {
  std::vector<Light> lights(3);
  lights[0].name = "with \"quotes\" and \xC3\xA9";
  lights[0].position = {0.1, 1e6 + 1.0 / 3, -1e-9};
  lights[0].color = {0.1f, 1e-20f, 3.3333333f};
  lights[0].radius_m = 0.7f;
  lights[0].casts_shadow = true;
  lights[0].source_m = 0.3f;
  lights[1].type = LightType::spot;
  lights[1].direction = glm::normalize(glm::vec3(0.3f, -0.7f, 0.11f));
  lights[1].inner_cone_rad = 0.1f;
  lights[1].outer_cone_rad = 3.14159274f;
  lights[1].intensity = 1.1e20f;
  lights[2].type = LightType::directional;
  lights[2].direction = glm::normalize(glm::vec3(-0.9f, -0.2f, 0.3f));
  write_file(path_, lights_file_text(lights));
  const std::vector<Light> loaded = load_lights_file(path_);
  ASSERT_EQ(loaded.size(), 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(loaded[i].name, lights[i].name);
    EXPECT_EQ(loaded[i].type, lights[i].type);
    EXPECT_EQ(loaded[i].position, lights[i].position);
    EXPECT_EQ(loaded[i].direction, lights[i].direction);
    EXPECT_EQ(loaded[i].color, lights[i].color);
    EXPECT_EQ(loaded[i].intensity, lights[i].intensity);
    EXPECT_EQ(loaded[i].radius_m, lights[i].radius_m);
    EXPECT_EQ(loaded[i].inner_cone_rad, lights[i].inner_cone_rad);
    EXPECT_EQ(loaded[i].outer_cone_rad, lights[i].outer_cone_rad);
    EXPECT_EQ(loaded[i].casts_shadow, lights[i].casts_shadow);
    EXPECT_EQ(loaded[i].source_m, lights[i].source_m);
  }
}

TEST_F(LightsFile, NamesTheLightAndTheField) {
  EXPECT_EQ(refused_light(R"("name": "lamp", "position": [0, 0])"),
            "light 1 \"lamp\": position is not three numbers");
  EXPECT_EQ(refused_light(R"("radius": 1)"), "light 1: position is missing");
  EXPECT_EQ(refused_light(R"("position": [0, "1", 0])"), "light 1: position string is not a number");
  EXPECT_EQ(refused_light(R"("position": [0, 0, 0], "radius": -1)"), "light 1: radius -1 is below 0");
  EXPECT_EQ(refused_light(R"("position": [0, 1e300, 0])"), "light 1: position 1e+300 is above 3.40282e+38");
  EXPECT_EQ(refused_light(R"("position": [0, 0, 0], "color": [1, -1, 1])"), "light 1: color -1 is below 0");
  EXPECT_EQ(refused_light(R"("position": [0, 0, 0], "intensity": -2)"), "light 1: intensity -2 is below 0");
  EXPECT_EQ(
      refused_light(R"("name": "sun", "position": [0, 0, 0], "color": [0, 1e20, 1], "intensity": 1e30)"),
      "light 1 \"sun\": intensity 1e+30 times color passes the largest float, 3.40282e+38");
  EXPECT_EQ(refused_light(R"("position": [0, 0, 0], "type": "area")"),
            "light 1: type \"area\" is not point, spot, rectangle, directional or virtual");
  EXPECT_EQ(refused_light(R"("position": [0, 0, 0], "type": 3)"), "light 1: type number is not a string");
  EXPECT_EQ(refused_light(R"("type": "directional", "direction": [0, 0, 0])"),
            "light 1: direction [0, 0, 0] is zero");
  EXPECT_EQ(refused_light(R"("type": "spot", "position": [0, 0, 0])"), "light 1: direction is missing");
  EXPECT_EQ(refused_light(R"("position": [0, 0, 0], "outer_cone": 0)"),
            "light 1: outer_cone 0 is not above 0");
  EXPECT_EQ(refused_light(R"("position": [0, 0, 0], "outer_cone": 3.15)"),
            "light 1: outer_cone 3.15 is above 3.14159");
  EXPECT_EQ(refused_light(R"("position": [0, 0, 0], "inner_cone": -0.1)"),
            "light 1: inner_cone -0.1 is below 0");
  EXPECT_EQ(refused_light(R"("position": [0, 0, 0], "radius": 1, "rgb255": [0, 0, 256])"),
            "light 1: rgb255 256 is above 255");
  EXPECT_EQ(refused_light(R"("position": [0, 0, 0], "casts_shadow": 1)"),
            "light 1: casts_shadow number is not true or false");
  EXPECT_EQ(refused_light(R"("name": "a\nb", "position": 3)"),
            "light 1 \"a\\nb\": position is not three numbers");
  EXPECT_EQ(refused(R"({"lights": [1]})"), "light 0: is number, not an object");
}

TEST_F(LightsFile, IntensityUpToTheLargestFloatIsTaken) {
  EXPECT_EQ(load_one(R"("position": [0, 0, 0], "color": [0.5, 1, 0], "intensity": 3.4028234e38)").intensity,
            3.4028234e38f);
  EXPECT_EQ(load_one(R"("position": [0, 0, 0], "color": [1e38, 0, 0], "intensity": 3.4)").color.r, 1e38f);
}

TEST_F(LightsFile, NumbersThatAreNone) {
  EXPECT_THAT(refused_light(R"("position": [0, 0, 0], "radius": 1e999)"),
              testing::StartsWith("light 1: near \"radius\": number overflow parsing '1e999'"));
  EXPECT_THAT(refused_light(R"("position": [0, 0, NaN])"),
              testing::StartsWith("light 1: near \"position\": is not JSON"));
  EXPECT_THAT(refused_light(R"("position": [0, 0, null])"), HasSubstr("position null is not a number"));
}

TEST_F(LightsFile, WhatIsNoLightsFile) {
  EXPECT_THAT(refused(""), testing::StartsWith("is not JSON"));
  EXPECT_THAT(refused("glTF\x02\x01\xff\xfe"), testing::StartsWith("is not JSON"));
  EXPECT_THAT(refused("{\"lights\": [{\"position\": [0,"), HasSubstr("is not JSON"));
  EXPECT_EQ(refused("[]"), "is array, not an object");
  EXPECT_EQ(refused("{}"), "lights is missing");
  EXPECT_EQ(refused(R"({"lights": {"a": 1}})"), "lights is object, not an array");
  EXPECT_EQ(refused(std::string(1'000'000, '[')), "is nested deeper than 32");
  EXPECT_EQ(refused("{\"lights\": [{\"position\": " + std::string(1'000'000, '[')),
            "is nested deeper than 32");
}

TEST_F(LightsFile, FilesThatCannotBeRead) {
  EXPECT_THROW(load_lights_file(path_), Error);
  EXPECT_THROW(load_lights_file(testing::TempDir()), Error);
  std::ofstream(path_).close();
  std::filesystem::resize_file(path_, max_lights_file_bytes + 1);  // sparse
  EXPECT_THROW(load_lights_file(path_), Error);
}

TEST_F(LightsFile, CameraIsOptional) {
  load(R"({"camera": "eye:1,2,3,target:0,0,0", "lights": []})");
  EXPECT_EQ(camera_of_lights_file(path_), "eye:1,2,3,target:0,0,0");
  load(R"({"lights": []})");
  EXPECT_EQ(camera_of_lights_file(path_), "");
  load(R"({"camera": 3, "lights": []})");
  EXPECT_THROW(camera_of_lights_file(path_), Error);
}

TEST(SharedLightsFiles, BenchLightsAndCameraAreRead) {
  LIGHTGRID_NEEDS_SHARED("bench/sponza_lights.json");
  const auto path = shared_folder() / "bench/sponza_lights.json";
  const auto lights = load_lights_file(path);
  ASSERT_FALSE(lights.empty());
  EXPECT_EQ(lights[0].position, glm::dvec3(12.452663, 3.067523, -0.189535));
  EXPECT_EQ(lights[0].radius_m, 2);
  EXPECT_EQ(lights[0].intensity, 3);
  EXPECT_EQ(glm::dvec3(choose_camera(Scene(), camera_of_lights_file(path)).world_from_view[3]),
            glm::dvec3(-10, 2, 0));
}

TEST(SharedLightsFiles, RedEclipseMapsAreRead) {
  LIGHTGRID_NEEDS_SHARED("scenes/lights/redeclipse");
  const std::pair<const char*, size_t> maps[] = {{"biolytic", 190}, {"castle", 54}, {"darkness", 226},
                                                 {"mist", 45},      {"nova", 255},  {"vault", 45}};
  for (const auto& [map, count] : maps) {
    EXPECT_EQ(
        load_lights_file(shared_folder() / "scenes/lights/redeclipse" / (std::string(map) + ".json")).size(),
        count);
  }
}

TEST_F(LightsFile, AVirtualLightIsReadBackAsItWas) {
  Light light;
  make_virtual(light);
  light.position = {1, 2, 3};
  light.direction = {0, 1, 0};
  light.intensity = 0.5f;
  light.nearest_m = 0.25f;
  const std::vector<Light> loaded = load(lights_file_text({light}));
  ASSERT_EQ(loaded.size(), 1u);
  EXPECT_EQ(loaded[0], light);
  EXPECT_THAT(
      refused_light(R"("type": "virtual", "position": [0, 0, 0], "direction": [0, 1, 0], "nearest": -1)"),
      HasSubstr("nearest -1 is below 0"));
}

}  // namespace
}  // namespace lightgrid
