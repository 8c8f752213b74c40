// A flying camera, the pointer's gestures, and the picture's size while it moves.
#include "view/fly_camera.h"

#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>

#include "view/clock.h"
#include "view/controls.h"

namespace lightgrid::app {
namespace {

using testing::StartsWith;

// A box of 8 x 0 x 6 m: 10 m across.
Scene ten_metres() {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {8, 0, 0}, {0, 0, 6}};
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(p);
  mesh.indices = {0, 1, 2};
  scene.meshes.push_back(mesh);
  scene.materials.emplace_back();
  scene.instances.emplace_back();
  return scene;
}

constexpr double wide = 320.0 / 180;

Scene ten_metres_with_camera() {
  Scene scene = ten_metres();
  scene.cameras = {look_at({1, 2, 10}, {1, 2, 0})};
  return scene;
}

View start_view() { return make_view(look_at({1, 2, 10}, {1, 2, 0}), 320, 180); }

void expect_same(const View& a, const View& b) {
  EXPECT_EQ(a.view_from_world, b.view_from_world);
  EXPECT_EQ(a.clip_from_view, b.clip_from_view);
}

TEST(FlyCamera, StaysTheStartUntilItMoves) {
  const Scene scene = ten_metres_with_camera();
  FlyCamera camera(scene, "0", wide);
  EXPECT_EQ(camera.text(), "0");
  EXPECT_FALSE(camera.move({}, 1));
  EXPECT_FALSE(camera.turn(0, 0, 180));
  EXPECT_EQ(camera.view(320, 180).clip_from_view, start_view().clip_from_view);
  // With another aspect ratio the vertical field stays.
  const View square = camera.view(180, 180);
  EXPECT_EQ(square.clip_from_view[1][1], start_view().clip_from_view[1][1]);
  EXPECT_EQ(square.clip_from_view[0][0], square.clip_from_view[1][1]);
}

TEST(FlyCamera, FliesWhereItLooks) {
  const Scene scene = ten_metres_with_camera();
  FlyCamera camera(scene, "", wide);
  camera.speed_m = 2;
  std::array<bool, 7> held{};
  held[int(FlightKey::forward)] = true;
  EXPECT_TRUE(camera.move(held, 0.5));
  const glm::dvec3 ahead = camera.view(320, 180).eye;
  EXPECT_NEAR(ahead.x, 1, 1e-5);
  EXPECT_NEAR(ahead.y, 2, 1e-5);
  EXPECT_NEAR(ahead.z, 9, 1e-5);
  held = {};
  held[int(FlightKey::right)] = held[int(FlightKey::up)] = held[int(FlightKey::fast)] = true;
  EXPECT_TRUE(camera.move(held, 0.5));
  const glm::dvec3 aside = camera.view(320, 180).eye;
  EXPECT_NEAR(aside.x, 5, 1e-5);
  EXPECT_NEAR(aside.y, 6, 1e-5);
  EXPECT_NEAR(aside.z, 9, 1e-5);
}

TEST(FlyCamera, TurnsWithTheDragAndNeverPastTheVertical) {
  const Scene scene = ten_metres_with_camera();
  FlyCamera camera(scene, "", wide);
  // A drag over the picture's height turns by the vertical field, 60 degrees; dragging to the right shows
  // what is left.
  EXPECT_TRUE(camera.turn(180, 0, 180));
  const glm::dvec3 left = -glm::transpose(glm::dmat3(camera.view(320, 180).view_from_world))[2];
  EXPECT_NEAR(left.x, -std::sqrt(0.75), 1e-5);
  EXPECT_NEAR(left.z, -0.5, 1e-5);
  EXPECT_TRUE(camera.turn(0, 1800, 180));
  const glm::dvec3 up = -glm::transpose(glm::dmat3(camera.view(320, 180).view_from_world))[2];
  EXPECT_GT(up.y, 0.999);
  EXPECT_LT(up.y, 1);
}

TEST(FlyCamera, IsTheTextThatItGives) {
  const Scene scene = ten_metres_with_camera();
  FlyCamera camera(scene, "", wide);
  camera.turn(31.7, -12.9, 180);
  std::array<bool, 7> held{};
  held[int(FlightKey::back)] = true;
  camera.move(held, 0.123);
  EXPECT_THAT(camera.text(), StartsWith("eye:"));
  expect_same(make_view(choose_camera(scene, camera.text()), 320, 180), camera.view(320, 180));
}

TEST(FlyCamera, KeepsANearPlaneThatWasGiven) {
  const Scene scene = ten_metres_with_camera();
  FlyCamera camera(scene, "eye:1,2,3,target:0,0,0,near:0.25", wide);
  camera.turn(31.7, -12.9, 180);
  EXPECT_EQ(camera.view(320, 180).near_m, 0.25);
  camera.go_to("eye:1,2,3,target:0,0,0", wide);
  camera.turn(31.7, -12.9, 180);
  EXPECT_NE(camera.view(320, 180).near_m, 0.25);
}

// As `lightgrid render` sees the scene at that time and size.
TEST(FlyCamera, FollowsAnAnimatedCameraOfTheSceneUntilItMoves) {
  Scene scene = ten_metres_with_camera();
  FlyCamera camera(scene, "", wide);
  scene.cameras[0] = look_at({4, 2, 10}, {4, 2, 0});
  EXPECT_EQ(camera.view(320, 180).eye, glm::dvec3(4, 2, 10));
  camera.turn(0, 5, 180);
  EXPECT_NEAR(camera.view(320, 180).eye.x, 4, 1e-5);
  scene.cameras[0] = look_at({0, 2, 10}, {0, 2, 0});
  EXPECT_NEAR(camera.view(320, 180).eye.x, 4, 1e-5);
}

TEST(FlyCamera, AnOverviewFitsAWindowOfAnotherShapeAndStaysWhenTheSceneMoves) {
  Scene scene = ten_metres();
  FlyCamera camera(scene, "", wide);
  expect_same(make_view(choose_camera(scene, "", 0.5), 90, 180), camera.view(90, 180));
  camera.hold(wide);
  const View held = camera.view(320, 180);
  const glm::dvec3 overview(choose_camera(scene, "", wide).world_from_view[3]);
  EXPECT_NEAR(glm::distance(held.eye, overview), 0, 1e-4);
  scene.instances[0].world_from_object = glm::translate(glm::dmat4(1), {1, 0, 0});
  EXPECT_EQ(camera.view(320, 180).eye, held.eye);
}

Input at(double x, double y, bool button) {
  Input input;
  input.x = x;
  input.y = y;
  input.button = button;
  return input;
}

TEST(Pointer, TurnsDragsTheLineAndClicks) {
  Pointer pointer;
  pointer.follow(at(20, 30, false), 320, 180, 0.5, true);
  const PointerResult turned = pointer.follow(at(40, 25, true), 320, 180, 0.5, true);
  EXPECT_EQ(turned.turn_x, 20);
  EXPECT_EQ(turned.turn_y, -5);
  EXPECT_FALSE(pointer.follow(at(40, 25, false), 320, 180, 0.5, true).click);

  pointer.follow(at(161, 90, false), 320, 180, 0.5, true);
  const PointerResult dragged = pointer.follow(at(80, 90, true), 320, 180, 0.5, true);
  EXPECT_EQ(dragged.line, 0.25);
  EXPECT_EQ(dragged.turn_x, 0);
  pointer.follow(at(80, 90, false), 320, 180, 0.25, true);

  pointer.follow(at(10, 0, false), 320, 180, 0.25, true);
  pointer.follow(at(10, 0, true), 320, 180, 0.25, true);
  EXPECT_EQ(pointer.follow(at(10, 0, false), 320, 180, 0.25, true).click, (lab::PicturePixel{10, 0}));
}

// A slow frame: since the last one the pointer came from elsewhere and was pressed.
TEST(Pointer, APressCountsWhereItHappened) {
  Pointer pointer;
  pointer.follow(at(400, 30, false), 320, 180, 0.5, true);
  Input press = at(90, 40, true);
  press.pressed = {{90, 40}};
  EXPECT_EQ(pointer.follow(press, 320, 180, 0.5, true).turn_x, 0);
  EXPECT_EQ(pointer.follow(at(90, 40, false), 320, 180, 0.5, true).click, (lab::PicturePixel{90, 40}));
}

TEST(Pointer, ADragBetweenTwoFramesIsNoClick) {
  Pointer pointer;
  Input press = at(160, 40, true);
  press.pressed = {{160, 40}};
  EXPECT_FALSE(pointer.follow(press, 320, 180, 0.5, true).line)
      << "a press alone leaves the line where it is";
  const PointerResult released = pointer.follow(at(80, 40, false), 320, 180, 0.5, true);
  EXPECT_EQ(released.line, 0.25);
  EXPECT_FALSE(released.click);
  pointer.follow(at(80, 40, false), 320, 180, 0.25, true);
  EXPECT_FALSE(pointer.follow(at(200, 40, false), 320, 180, 0.25, true).line);
}

TEST(Pointer, LeavesWhatAPanelTakes) {
  Pointer pointer;
  pointer.follow(at(20, 30, false), 320, 180, 0.5, false);
  pointer.follow(at(20, 30, true), 320, 180, 0.5, false);
  const PointerResult dragged = pointer.follow(at(90, 30, true), 320, 180, 0.5, true);
  EXPECT_EQ(dragged.turn_x, 0);
  EXPECT_FALSE(pointer.follow(at(90, 30, false), 320, 180, 0.5, true).click);
}

TEST(Resolution, DropsWhileTheCameraMovesAndIsFullAtRest) {
  Resolution resolution;
  EXPECT_EQ(resolution.next(true, 0.1, 30), 1);
  resolution.measured(120);  // the target is 33 ms: a quarter of the pixels
  EXPECT_EQ(resolution.next(true, 0.1, 30), 0.5);
  EXPECT_FALSE(resolution.resting());
  resolution.measured(30);
  EXPECT_EQ(resolution.next(false, 0.1, 30), 0.5);
  EXPECT_EQ(resolution.next(false, 0.1, 30), 1);
  EXPECT_TRUE(resolution.resting());
}

TEST(Resolution, StartsSmallAndLeavesTimeForTheWindow) {
  Resolution resolution(true);
  EXPECT_EQ(resolution.next(false, 0.01, 30), 0.5);
  EXPECT_FALSE(resolution.resting());
  resolution.measured(5, 15);  // of the target of 33 ms 18 are left; a full picture takes 20
  EXPECT_EQ(resolution.next(true, 0.01, 30), 0.75);
  EXPECT_EQ(resolution.next(false, 1, 30), 1);
}

TEST(Resolution, StaysFullWhereNoRateIsHeld) {
  Resolution resolution;
  resolution.measured(1e6);
  EXPECT_EQ(resolution.next(true, 0.1, 0), 1);
}

}  // namespace
}  // namespace lightgrid::app
