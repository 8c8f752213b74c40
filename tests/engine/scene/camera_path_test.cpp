#include "scene/camera_path.h"

#include <gmock/gmock.h>

#include <fstream>

#include "base/error.h"
#include "scenes/builtin.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

View start() { return make_view(look_at({1, 2, 3}, {1, 2, -7}), 64, 48); }

glm::dvec3 forward(const View& view) { return -glm::transpose(glm::dmat3(view.view_from_world))[2]; }

void expect_direction(const View& view, const glm::dvec3& wanted) {
  EXPECT_LT(glm::length(forward(view) - wanted), 1e-12);
  EXPECT_LT(glm::length(glm::dvec3(view.view_from_world * glm::dvec4(view.eye, 1))), 1e-12)
      << "the eye is the origin";
}

TEST(CameraPath, TurnsAboutItsOwnPlace) {
  const std::vector<View> views = camera_path({}, start(), "turn:4");
  ASSERT_EQ(views.size(), 4u);
  const glm::dvec3 directions[] = {{0, 0, -1}, {-1, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(views[i].eye, glm::dvec3(1, 2, 3));
    expect_direction(views[i], directions[i]);
  }
  EXPECT_EQ(views[0].view_from_world, start().view_from_world) << "the first view is the camera's own";
}

TEST(CameraPath, DolliesByAQuarterOfTheScene) {
  const Scene hall = find_builtin_scene("hall")->make();
  const WorldBox box = world_box(hall);
  const std::vector<View> views = camera_path(hall, start(), "dolly:2");
  ASSERT_EQ(views.size(), 2u);
  expect_direction(views[1], {0, 0, -1});
  EXPECT_NEAR(views[1].eye.z, 3 - glm::length(box.max - box.min) / 8, 1e-9);
}

// Whose squares no double holds.
TEST(CameraPath, DolliesByAMetreInASceneOfAnySize) {
  Scene hall = find_builtin_scene("hall")->make();
  hall.instances[0].world_from_object[3].x = 1e200;
  EXPECT_NEAR(camera_path(hall, start(), "dolly:2")[1].eye.z, 2.5, 1e-9);
}

TEST(CameraPath, FollowsKeysOfAFile) {
  const TempFolder folder;
  const std::string path = (folder.path / "path.json").string();
  std::ofstream(path) << R"({"frames": 5, "keys": [{"eye": [0, 0, 0], "target": [0, 0, -1]},
                              {"eye": [4, 0, 0], "target": [4, 0, -1], "fov": 90}]})";
  const std::vector<View> views = camera_path({}, start(), path);
  ASSERT_EQ(views.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(views[i].eye.x, i, 1e-12);
  EXPECT_NEAR(views[4].clip_from_view[1][1], 1, 1e-12) << "90 degrees";
  EXPECT_EQ(views[2].width, 64);
}

TEST(CameraPath, RefusesWhatIsNone) {
  const TempFolder folder;
  const std::string path = (folder.path / "path.json").string();
  const auto message = [&](const std::string& text) -> std::string {
    return error_of([&] { camera_path({}, start(), text); });
  };
  for (const char* text : {"turn:0", "turn:x", "turn:100001", "dolly:-1", "turn:2.5"}) {
    EXPECT_THAT(message(text), testing::HasSubstr("N from 1 to 100000")) << text;
  }
  EXPECT_THAT(message("nowhere.json"), testing::HasSubstr("nor a file"));
  const std::pair<const char*, const char*> files[] = {
      {"[", "not JSON"},
      {"{}", "keys"},
      {R"({"keys": [3]})", "key 0: 3 is not an object"},
      {R"({"key": [], "keys": [{}]})", "key: unknown field; did you mean keys?; fields are frames, keys"},
      {R"({"keys": [{"eye": [0, 0, 0], "target": [0, 0, 1], "fow": 40}]})",
       "key 0: fow: unknown field; did you mean fov?; fields are eye, target, fov"},
      {R"({"keys": []})", "keys"},
      {R"({"keys": [{"eye": [0, 0], "target": [0, 0, 1]}]})", "key 0: eye"},
      {R"({"keys": [{"eye": [0, 0, 0]}]})", "key 0: target"},
      {R"({"keys": [{"eye": [0, 0, 0], "target": [0, 0, 0]}]})", "a target is at its eye"},
      {R"({"keys": [{"eye": [0, 0, 0], "target": [0, 0, 1e300]}]})", "key 0: target"},
      {R"({"keys": [{"eye": [0, 0, 0], "target": [0, 0, 1]}], "frames": 0})", "frames"},
  };
  const std::string deep = std::string(200'000, '[');
  EXPECT_THAT(message(folder.path.string()), testing::HasSubstr("is a folder, not a file"));
  std::ofstream(path) << deep;
  EXPECT_THAT(message(path), testing::HasSubstr("is nested deeper than 8"));
  for (const auto& [text, wanted] : files) {
    std::ofstream(path) << text;
    EXPECT_THAT(message(path), testing::HasSubstr(wanted)) << text;
  }
}

}  // namespace
}  // namespace lightgrid
