#include "scene/camera.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "scene/view_lights.h"
#include "scenes/builtin.h"

namespace lightgrid {
namespace {

constexpr double quarter_turn = std::numbers::pi / 2;

glm::dvec3 ndc(const View& view, glm::dvec3 point_view) {
  const glm::dvec4 clip = view.clip_from_view * glm::dvec4(point_view, 1);
  return glm::dvec3(clip) / clip.w;
}

std::string message_of(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "no error";
}

Camera simple_camera() {
  Camera camera;
  camera.name = "simple";
  camera.fov_y_rad = quarter_turn;
  camera.near_m = 0.5;
  camera.far_m = 8.5;
  return camera;
}

TEST(MakeView, PerspectiveWorkedOutByHand) {
  // f = 1 / tan(45 degrees) = 1; aspect 2; near/(far - near) = 1/16; far * near/(far - near) = 4.25/8 =
  // 17/32.
  const View view = make_view(simple_camera(), 200, 100);
  const double f = 1 / std::tan(quarter_turn / 2);
  const glm::dmat4 expected(f / 2, 0, 0, 0, 0, f, 0, 0, 0, 0, 0.0625, -1, 0, 0, 0.53125, 0);
  EXPECT_EQ(view.clip_from_view, expected);
  EXPECT_EQ(view.view_from_world, glm::dmat4(1));
}

TEST(MakeView, DepthIsOneAtNearAndZeroAtFar) {
  const View view = make_view(simple_camera(), 17, 9);
  EXPECT_DOUBLE_EQ(ndc(view, {0, 0, -0.5}).z, 1);
  EXPECT_DOUBLE_EQ(ndc(view, {0, 0, -8.5}).z, 0);
  // (17/32 - 2/16) / 2 = 13/64.
  EXPECT_DOUBLE_EQ(ndc(view, {0, 0, -2}).z, 13.0 / 64);
}

TEST(MakeView, InfiniteFarIsNearOverDistance) {
  Camera camera = simple_camera();
  camera.far_m = std::numeric_limits<double>::infinity();
  const View view = make_view(camera, 1, 1);
  EXPECT_EQ(ndc(view, {0, 0, -0.5}).z, 1);
  EXPECT_EQ(ndc(view, {3, 1, -64}).z, 0.5 / 64);
}

TEST(MakeView, OrthographicDepthIsLinearAndReversed) {
  Camera camera = simple_camera();
  camera.orthographic = true;
  camera.half_height_m = 4;
  camera.near_m = 0;
  camera.far_m = 16;
  const View view = make_view(camera, 320, 160);
  EXPECT_EQ(ndc(view, {8, 4, 0}), glm::dvec3(1, 1, 1));
  EXPECT_EQ(ndc(view, {-8, -4, -16}), glm::dvec3(-1, -1, 0));
  EXPECT_EQ(ndc(view, {0, 0, -4}).z, 0.75);
}

TEST(MakeView, ViewFromWorldUndoesTheCamera) {
  const Camera camera = look_at({3, 4, 5}, {-1, 2, 0.5});
  const View view = make_view(camera, 4, 3);
  const glm::dmat4 product = view.view_from_world * camera.world_from_view;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) EXPECT_NEAR(product[column][row], column == row, 1e-14);
  }
  const glm::dvec4 target = view.view_from_world * glm::dvec4(-1, 2, 0.5, 1);
  EXPECT_NEAR(target.x, 0, 1e-14);
  EXPECT_NEAR(target.y, 0, 1e-14);
  EXPECT_NEAR(target.z, -glm::length(glm::dvec3(4, 2, 4.5)), 1e-14);
}

TEST(MakeView, ScaleAndMirroringAreTakenOut) {
  Camera camera = simple_camera();
  camera.world_from_view[0] *= -3;
  camera.world_from_view[1] *= 2;
  camera.world_from_view[2] *= 5;
  EXPECT_EQ(make_view(camera, 1, 1).view_from_world, glm::dmat4(1));
}

TEST(MakeView, SceneAndCameraMovedTogetherGiveTheSameBits) {
  // Positions in multiples of 1/1024 m: at 2^20 m a double holds them exactly, so the move loses nothing.
  const glm::dvec3 move(1 << 20, -(1 << 20), 1 << 20);
  const glm::dvec3 eye(0.3125, 1.75, 13.5), target(-4.125, 3, -6.0625);
  Scene near_scene;
  for (int i = 0; i < 50; ++i) {
    near_scene.lights.emplace_back().position =
        glm::dvec3(i * 37 % 41, i * 29 % 43, i * 31 % 47) / 1024.0 * 7.0;
  }
  Scene far_scene = near_scene;
  for (Light& light : far_scene.lights) light.position += move;
  const View near_view = make_view(look_at(eye, target), 17, 9);
  const View far_view = make_view(look_at(eye + move, target + move), 17, 9);
  const auto near_lights = lights_in_view(near_scene, near_view),
             far_lights = lights_in_view(far_scene, far_view);
  for (size_t i = 0; i < near_lights.size(); ++i) EXPECT_EQ(near_lights[i].position, far_lights[i].position);

  glm::dmat4 object(1), moved(1);
  object[3] = glm::dvec4(1.5, 2.25, -3.125, 1);
  moved[3] = object[3] + glm::dvec4(move, 0);
  EXPECT_EQ(view_from_object(near_view, object), view_from_object(far_view, moved));
}

TEST(MakeView, RefusesWhatMakesNoProjection) {
  const auto refused = [](const auto& change) {
    Camera camera = simple_camera();
    change(camera);
    return message_of([&] { make_view(camera, 4, 4); });
  };
  using testing::HasSubstr;
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refused([](Camera& c) { c.fov_y_rad = std::numbers::pi; }), HasSubstr("field of view"));
  EXPECT_THAT(refused([&](Camera& c) { c.fov_y_rad = nan; }), HasSubstr("field of view"));
  EXPECT_THAT(refused([](Camera& c) { c.near_m = 0; }), HasSubstr("near"));
  EXPECT_THAT(refused([](Camera& c) { c.far_m = c.near_m; }), HasSubstr("far"));
  EXPECT_THAT(refused([&](Camera& c) { c.far_m = nan; }), HasSubstr("far"));
  EXPECT_THAT(refused([](Camera& c) { c.world_from_view[2] = glm::dvec4(0); }), HasSubstr("no direction"));
  EXPECT_THAT(refused([](Camera& c) { c.world_from_view[1] = c.world_from_view[2]; }), HasSubstr("flat"));
  EXPECT_THAT(refused([&](Camera& c) { c.world_from_view[3].y = nan; }), HasSubstr("position"));
  EXPECT_THAT(refused([&](Camera& c) {
                c.orthographic = true;
                c.far_m = inf;
              }),
              HasSubstr("orthographic"));
  EXPECT_THAT(refused([](Camera& c) {
                c.orthographic = true;
                c.half_height_m = 0;
              }),
              HasSubstr("half height"));
}

TEST(ChooseCamera, ByNameThenIndexThenFirst) {
  Scene scene;
  scene.cameras.resize(3);
  scene.cameras[0].name = "aisle";
  scene.cameras[1].name = "0";
  scene.cameras[2].name = "";
  EXPECT_EQ(choose_camera(scene, "").name, "aisle");
  EXPECT_EQ(choose_camera(scene, "aisle").name, "aisle");
  EXPECT_EQ(choose_camera(scene, "0").name, "0");
  EXPECT_EQ(choose_camera(scene, "1").name, "0");
  EXPECT_EQ(choose_camera(scene, "2").name, "");
  EXPECT_EQ(message_of([&] { choose_camera(scene, "3"); }),
            "camera 3: no camera of that name or index; the scene has 0 \"aisle\", 1 \"0\", 2 \"\"");
  EXPECT_EQ(message_of([] { choose_camera(Scene(), "door"); }),
            "camera door: no camera of that name or index; the scene has none");
}

TEST(ChooseCamera, EyeTargetAndField) {
  const Camera camera = choose_camera(Scene(), "eye:1,2,3,target:1,2,-5,fov:90");
  EXPECT_EQ(camera.world_from_view, glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1));
  EXPECT_DOUBLE_EQ(camera.fov_y_rad, quarter_turn);
  EXPECT_DOUBLE_EQ(choose_camera(Scene(), "target:0,0,0,eye:1e3,-2.5,.5").fov_y_rad, std::numbers::pi / 3);
}

TEST(ChooseCamera, StraightUpAndDown) {
  for (const double side : {-1.0, 1.0}) {
    const Camera camera =
        choose_camera(Scene(), side > 0 ? "eye:0,0,0,target:0,1,0" : "eye:0,0,0,target:0,-1,0");
    const View view = make_view(camera, 1, 1);
    EXPECT_EQ(glm::dvec3(view.view_from_world * glm::dvec4(0, side, 0, 1)), glm::dvec3(0, 0, -1));
    EXPECT_EQ(glm::determinant(glm::dmat3(view.view_from_world)), 1);
  }
}

TEST(ChooseCamera, SaysWhatIsWrong) {
  const auto refused = [](const std::string& wish) {
    return message_of([&] { choose_camera(Scene(), wish); });
  };
  using testing::HasSubstr;
  EXPECT_EQ(refused("eye:0,0,x,target:1,1,1"), "camera eye:0,0,x,target:1,1,1: \"x\" is not a number");
  EXPECT_THAT(refused("eye:0,0,nan,target:1,1,1"), HasSubstr("\"nan\" is not a number"));
  EXPECT_THAT(refused("eye:0,0,1e999,target:1,1,1"), HasSubstr("\"1e999\" is not a number"));
  EXPECT_THAT(refused("eye:0,0,1e300,target:1,1,1"), HasSubstr("beyond 1e+12"));
  EXPECT_THAT(refused("eye:0,0"), HasSubstr("\"\" is not a number"));
  EXPECT_THAT(refused("eye:0,0,0"), HasSubstr("target: is missing"));
  EXPECT_THAT(refused("eye:0,0,0,target:0,0,0"), HasSubstr("target is the eye"));
  EXPECT_THAT(refused("eye:0,0,0,target:0,0,1,fov:0"), HasSubstr("fov 0 "));
  EXPECT_THAT(refused("eye:0,0,0,target:0,0,1,fov:180"), HasSubstr("fov 180 "));
  EXPECT_THAT(refused("eye:0,0,0,eye:0,0,1"), HasSubstr("there twice"));
  EXPECT_THAT(refused("eye:0,0,0,target:0,0,1,roll:3"), HasSubstr("\"roll:3\""));
  EXPECT_THAT(refused("eye:0,0,0,target:0,0,1,near:0"), HasSubstr("near 0 is not above 0"));
  EXPECT_THAT(refused("eye:0,0,0,target:0,0,1,near:-0.1"), HasSubstr("near -0.1 is not above 0"));
  EXPECT_THAT(refused("eye:0,0,0,target:0,0,1,near:inf"), HasSubstr("\"inf\" is not a number"));
}

// A scene whose box has this diagonal.
Scene scene_of_size(double size_m) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.bounds = {{0, 0, 0}, {3, 0, 4}};
  scene.instances.push_back({.mesh = 0, .world_from_object = glm::dmat4(glm::dmat3(size_m / 5))});
  return scene;
}

TEST(ChooseCamera, NearIsAThousandthOfTheSceneAndAtMostATenthOfAMetre) {
  const std::string eye = "eye:0,1.7,0,target:1,1.7,0";
  const std::pair<double, double> near_of_size[] = {{1e-3, 1e-6}, {1, 1e-3},   {100, 0.1},
                                                    {500, 0.1},   {2000, 0.1}, {1e6, 0.1}};
  for (const auto& [size, near] : near_of_size) {
    EXPECT_DOUBLE_EQ(choose_camera(scene_of_size(size), eye).near_m, near) << size;
    EXPECT_EQ(choose_camera(scene_of_size(size), eye + ",near:0.25").near_m, 0.25) << size;
  }
  Scene with_camera = scene_of_size(2000);
  with_camera.cameras.push_back(simple_camera());
  EXPECT_EQ(choose_camera(with_camera, "").near_m, 0.5) << "a camera of the scene keeps its own";
}

TEST(ChooseCamera, DefaultSeesTheWholeScene) {
  for (const double size : {1e-3, 1.0, 1e6}) {
    Scene scene;
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.bounds = {{-1, 0, -3}, {1, 2, 3}};
    for (uint32_t corner = 0; corner < 8; ++corner) {
      mesh.positions.emplace_back(corner & 1 ? 1 : -1, corner & 2 ? 2 : 0, corner & 4 ? 3 : -3);
      for (int i = 0; i < 3; ++i) mesh.indices.push_back(corner);
    }
    glm::dmat4 matrix(size);
    matrix[3] = glm::dvec4(100, -20, 7, 1);
    scene.instances.push_back({"box", 0, matrix});
    const Camera camera = choose_camera(scene, "");
    const View view = make_view(camera, 100, 100);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 world =
          matrix * glm::dvec4(corner & 1 ? 1 : -1, corner & 2 ? 2 : 0, corner & 4 ? 3 : -3, 1);
      const glm::dvec3 p(view_from_object(view, glm::dmat4(1)) * world);
      const glm::dvec3 screen = ndc(view, p);
      EXPECT_LT(-p.z, 100 * size);
      EXPECT_LT(std::abs(screen.x), 1);
      EXPECT_LT(std::abs(screen.y), 1);
      EXPECT_GT(screen.z, 0);
      EXPECT_LT(screen.z, 1);
    }
  }
}

// A box's corners as triangles that meet in its middle: the visible part differs from the box.
Scene tripod(const glm::dmat4& matrix) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {
      {0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {2, 2, 2}};  // the last one belongs to no triangle
  mesh.indices = {0, 1, 2, 0, 2, 3, 0, 3, 1};
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(p);
  scene.instances.push_back({"tripod", 0, matrix});
  return scene;
}

TEST(ChooseCamera, DefaultFillsTheImage) {
  glm::dmat4 turned = glm::rotate(glm::dmat4(1), 2.0, glm::normalize(glm::dvec3(1, 2, 3)));
  for (const double size : {1e-6, 1.0, 1e9}) {
    for (const glm::dmat4& rotation : {glm::dmat4(1), turned, glm::scale(turned, {1e-9, 1, 1e-9})}) {
      for (const glm::ivec2 image : {glm::ivec2(1280, 720), glm::ivec2(100, 100), glm::ivec2(90, 700)}) {
        const Scene scene = tripod(glm::translate(glm::dmat4(1), glm::dvec3(5, -3, 8) * size) * rotation *
                                   glm::dmat4(glm::dmat3(size)));
        const View view = make_view(choose_camera(scene, "", double(image.x) / image.y), image.x, image.y);
        glm::dvec2 low(2), high(-2);
        for (const uint32_t i : scene.meshes[0].indices) {
          const glm::dvec4 world =
              scene.instances[0].world_from_object * glm::dvec4(glm::dvec3(scene.meshes[0].positions[i]), 1);
          const glm::dvec3 screen =
              ndc(view, glm::dmat3(view.view_from_world) * (glm::dvec3(world) - view.eye));
          low = glm::min(low, glm::dvec2(screen));
          high = glm::max(high, glm::dvec2(screen));
          EXPECT_GT(screen.z, 0);
          EXPECT_LT(screen.z, 1);
        }
        EXPECT_GT(low.x, -0.95);
        EXPECT_GT(low.y, -0.95);
        EXPECT_LT(high.x, 0.95);
        EXPECT_LT(high.y, 0.95);
        EXPECT_GT(std::max(high.x - low.x, high.y - low.y) / 2, 0.85) << size << " " << image.x;
      }
    }
  }
}

// A line towards the eye has no extent in the image: it is viewed from some distance.
TEST(ChooseCamera, DefaultKeepsItsDistanceFromALine) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {0.62f, 0.45f, 0.78f}, {0.62f, 0.45f, 0.78f}};
  mesh.indices = {0, 1, 2};
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(p);
  scene.instances.push_back({"line", 0, glm::dmat4(1)});
  const Camera camera = choose_camera(scene, "");
  const View view = make_view(camera, 10, 10);
  EXPECT_GT(-(view.view_from_world * glm::dvec4(0.62, 0.45, 0.78, 1)).z, 2 * camera.near_m);
}

// A box of `size` with its floor at y = 0; `inside`: its faces look inwards.
Scene box_of(const glm::dvec3& size, bool inside) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back(i & 1 ? 0.5f : -0.5f, i & 2 ? 1 : 0, i & 4 ? 0.5f : -0.5f);
  mesh.indices = {0, 1, 3, 0, 3, 2, 5, 4, 6, 5, 6, 7, 4, 0, 2, 4, 2, 6,
                  1, 5, 7, 1, 7, 3, 4, 5, 1, 4, 1, 0, 2, 3, 7, 2, 7, 6};
  if (!inside) std::ranges::reverse(mesh.indices);
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(p);
  scene.instances.push_back({"box", 0, glm::scale(glm::dmat4(1), size)});
  return scene;
}

TEST(ChooseCamera, DefaultStandsInARoom) {
  const Camera camera = choose_camera(box_of({20, 4, 8}, true), "");
  EXPECT_EQ(camera.name, "room");
  EXPECT_NEAR(camera.world_from_view[3].y, 1.7, 1e-12) << "an eye's height above the floor";
  EXPECT_GT(std::abs(camera.world_from_view[3].x), 7) << "near an end";
  EXPECT_LT(std::abs(camera.world_from_view[3].x), 10);
  const double towards = -camera.world_from_view[2].x * camera.world_from_view[3].x;
  EXPECT_LT(towards, 0) << "looks along its length";
  EXPECT_EQ(choose_camera(box_of({-20, 4, 8}, true), "").name, "room")
      << "glTF turns a mirrored node's winding";
  EXPECT_EQ(choose_camera(box_of({-20, 4, 8}, false), "").name, "overview");
}

TEST(ChooseCamera, DefaultStaysOutsideOfWhatIsNoRoom) {
  EXPECT_EQ(choose_camera(box_of({20, 4, 8}, false), "").name, "overview") << "a building from outside";
  EXPECT_EQ(choose_camera(box_of({0.2, 0.04, 0.08}, true), "").name, "overview") << "a box on a table";
  EXPECT_EQ(choose_camera(box_of({20, 4, 2.9}, true), "").name, "overview") << "too narrow";
  Scene open = box_of({20, 4, 8}, true);
  open.meshes[0].indices.resize(12);  // two walls
  EXPECT_EQ(choose_camera(open, "").name, "overview");
}

// A box of 10 x 6 x 10 m with walls of 0.2 m: its outer faces face out, its inner ones in.
Scene shell() {
  Scene scene = box_of({10, 6, 10}, false);
  const Scene inside = box_of({9.6, 5.6, 9.6}, true);
  scene.meshes.push_back(inside.meshes[0]);
  scene.instances.push_back(
      {"cavity", 1,
       glm::translate(glm::dmat4(1), glm::dvec3(0, 0.2, 0)) * inside.instances[0].world_from_object});
  return scene;
}

TEST(ChooseCamera, DefaultStaysOutsideOfAHollowObject) {
  EXPECT_EQ(choose_camera(shell(), "").name, "overview");
  Scene two_sided = box_of({10, 6, 10}, true);  // each triangle twice, with both windings
  two_sided.instances.push_back(two_sided.instances[0]);
  two_sided.meshes.push_back(box_of({1, 1, 1}, false).meshes[0]);
  two_sided.instances[1].mesh = 1;
  EXPECT_EQ(choose_camera(two_sided, "").name, "overview");
}

TEST(ChooseCamera, DefaultEntersAHouseWithSomethingInIt) {
  Scene lit = shell();
  lit.lights.push_back({.position = {1, 5, 1}});
  EXPECT_EQ(choose_camera(lit, "").name, "room") << "a lamp";
  lit.lights[0].position.y = 6.5;
  EXPECT_EQ(choose_camera(lit, "").name, "overview") << "a lamp above the roof";
  Scene furnished = shell();
  furnished.meshes.push_back(box_of({1, 1, 1}, false).meshes[0]);
  for (const double x : {-3.5, -1.5, 1.5, 3.5})
    for (const double z : {-2, 2})
      furnished.instances.push_back(
          {"pillar", 2,
           glm::translate(glm::dmat4(1), glm::dvec3(x, 0.2, z)) * glm::scale(glm::dmat4(1), {1, 5.6, 1})});
  EXPECT_EQ(choose_camera(furnished, "").name, "room") << "pillars";
}

// A sphere of this radius around its centre, wound inwards.
Scene inward_sphere(float radius) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  constexpr uint32_t rings = 16, sides = 32;
  for (uint32_t ring = 0; ring <= rings; ++ring)
    for (uint32_t side = 0; side < sides; ++side) {
      const float down = float(ring) * 3.1415927f / rings, turn = float(side) * 6.2831853f / sides;
      mesh.positions.push_back(radius * glm::vec3(std::sin(down) * std::cos(turn), std::cos(down),
                                                  std::sin(down) * std::sin(turn)));
      mesh.bounds.add(mesh.positions.back());
      if (ring == rings) continue;
      const uint32_t a = ring * sides + side, b = ring * sides + (side + 1) % sides;
      for (const uint32_t index : {a, a + sides, b, b, a + sides, b + sides}) mesh.indices.push_back(index);
    }
  scene.instances.push_back({"sphere", 0, glm::dmat4(1)});
  return scene;
}

// Animals whose files have their triangles inside out.
TEST(ChooseCamera, DefaultStaysOutsideOfABodyWithARoundBottom) {
  for (const float radius : {4.0f, 20.0f, 300.0f})
    EXPECT_EQ(choose_camera(inward_sphere(radius), "").name, "overview") << radius;
}

// Margins of the image left, right, below and above of all vertices, as a part of half its size.
glm::dvec4 margins(const Scene& scene, const View& view) {
  glm::dvec2 least(1e9), most(-1e9);
  for (const Instance& instance : scene.instances)
    for (const glm::vec3& p : scene.meshes[size_t(instance.mesh)].positions) {
      const glm::dvec4 clip =
          view.clip_from_view * view.view_from_world * instance.world_from_object * glm::dvec4(p, 1);
      least = glm::min(least, glm::dvec2(clip) / clip.w);
      most = glm::max(most, glm::dvec2(clip) / clip.w);
    }
  return {1 + least.x, 1 - most.x, 1 + least.y, 1 - most.y};
}

// Shapes far smaller than their boxes: one triangle, a fan, and both with others near and far.
TEST(ChooseCamera, OverviewCentresVerticesNotBoxes) {
  Scene scene;
  Mesh triangle;
  triangle.positions = {{0, 0, 0}, {4, 0, 1}, {0.5f, 3, -6}};
  triangle.indices = {0, 1, 2};
  Mesh fan = triangle;
  fan.positions = {{0, 0, 0}, {7, 1, 0}, {6, 2, 5}, {1, 1, 9}};
  fan.indices = {0, 1, 2, 0, 2, 3};
  for (Mesh* mesh : {&triangle, &fan}) {
    for (const glm::vec3& p : mesh->positions) mesh->bounds.add(p);
    scene.meshes.push_back(*mesh);
  }
  const auto expect_centred = [&](double aspect) {
    const View view = make_view(choose_camera(scene, "", aspect), int(aspect * 1000), 1000);
    const glm::dvec4 m = margins(scene, view);
    EXPECT_NEAR(m[0], m[1], 1e-6);
    EXPECT_NEAR(m[2], m[3], 1e-6);
    EXPECT_NEAR(std::min(m[0], m[2]), 0.1, 1e-6) << "nine tenths are filled on one axis";
  };
  scene.instances = {{"triangle", 0, glm::dmat4(1)}};
  expect_centred(1);
  scene.instances = {{"fan", 1, glm::scale(glm::dmat4(1), {-1, 2, 1})}};
  expect_centred(16.0 / 9);
  scene.instances.push_back({"triangle", 0, glm::translate(glm::dmat4(1), glm::dvec3(-9, 1, 4))});
  expect_centred(0.5);
}

TEST(ChooseCamera, EmptySceneStillHasAView) {
  const View view = make_view(choose_camera(Scene(), ""), 1, 1);
  EXPECT_TRUE(std::isfinite(view.view_from_world[3].z));
}

}  // namespace
}  // namespace lightgrid
