// `forward` compared with the tests' own ray caster (oracle/ray_caster.h), which shares no code with the
// renderer or its oracle. Spheres are cast as the same triangles that are drawn, with interpolated normals;
// walls as planes.
#include "oracle/ray_caster.h"

#include <algorithm>
#include <numbers>

#include "scenes/compose.h"
#include "scenes/shapes.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

constexpr int width = 192, height = 128;

// The drawn scene, and the caster's planes for the meshes that are not spheres.
struct Room {
  Scene drawn, spheres;
  std::vector<ray_caster::Plane> planes;
  Camera camera;
};

void add_wall(Room& room, glm::vec3 corner, glm::vec3 right, glm::vec3 up, float roughness, float metallic) {
  const int material = add_material(room.drawn, "wall", {0.7f, 0.6f, 0.4f}, metallic, roughness);
  Mesh mesh;
  shapes::add_quad(mesh, corner, right, up);
  add_instance(room.drawn, "wall", add_mesh(room.drawn, shapes::finished(std::move(mesh), "wall", material)));
  room.planes.push_back({corner, glm::normalize(glm::cross(glm::dvec3(right), glm::dvec3(up))), material});
}

// A floor and a back wall that fill the view, and 5 x 4 spheres: metalness grows to the right, roughness
// upwards.
Room make_room() {
  Room room;
  room.drawn.ambient = glm::vec3(0);
  add_wall(room, {-40, -2, 6}, {80, 0, 0}, {0, 0, -10}, 0.6f, 0);
  add_wall(room, {-40, -2, -4}, {80, 0, 0}, {0, 40, 0}, 0.9f, 0.4f);
  Mesh ball;
  shapes::add_sphere(ball, {0, 0, 0}, 0.45f, 16);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 5; ++column) {
      const float roughness[] = {0.15f, 0.4f, 0.7f, 1};
      const int material =
          add_material(room.drawn, "ball", {0.9f, 0.5f, 0.15f}, 0.25f * column, roughness[row]);
      const int mesh = add_mesh(room.drawn, shapes::finished(ball, "ball", material));
      add_instance(room.drawn, "ball", mesh, placed({1.1 * column - 2.2, 1.1 * row - 1.4, -2}));
    }
  }
  room.spheres = room.drawn;
  room.spheres.instances.erase(room.spheres.instances.begin(), room.spheres.instances.begin() + 2);
  room.camera = look_at({0.3, 0.6, 3.5}, {0, 0.2, -2});
  return room;
}

struct RelativeErrors {
  double median = 0, p99 = 0;
  size_t pixels = 0, lit = 0;
};

// For each pixel that is lit in either, the largest channel's error over the caster's largest channel.
RelativeErrors relative_errors(Room& room, const std::vector<Light>& lights) {
  room.drawn.lights = room.spheres.lights = lights;
  const Image image = render(room.drawn, make_view(room.camera, width, height), "forward");
  const ray_caster::Meshes meshes(room.spheres);
  std::vector<double> errors;
  RelativeErrors result;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const ray_caster::Ray ray = ray_caster::ray_through(room.camera, width, height, x, y);
      auto hit = meshes.first_hit(ray);
      for (const ray_caster::Plane& plane : room.planes) {
        const auto on_plane = hit_of(plane, ray);
        if (on_plane && (!hit || on_plane->distance < hit->distance)) hit = on_plane;
      }
      if (!hit) continue;
      const glm::dvec3 want = ray_caster::radiance(room.drawn, ray, *hit), got(image.at(x, y));
      const double largest = std::max({want.r, want.g, want.b});
      const glm::dvec3 apart = glm::abs(got - want);
      const double error = std::max({apart.r, apart.g, apart.b});
      ++result.pixels;
      if (largest > 0 || error > 0) errors.push_back(error / largest);
    }
  }
  result.lit = errors.size();
  std::sort(errors.begin(), errors.end());
  result.median = errors.at(errors.size() / 2);
  result.p99 = errors.at(errors.size() * 99 / 100);
  return result;
}

void expect_the_casters_radiance(Room& room, const std::vector<Light>& lights, double min_lit,
                                 double median = 1e-6) {
  const RelativeErrors errors = relative_errors(room, lights);
  EXPECT_EQ(errors.pixels, size_t(width) * height) << "walls fill the view";
  EXPECT_GT(double(errors.lit), min_lit * double(errors.pixels));
  EXPECT_LT(errors.median, median);
  EXPECT_LT(errors.p99, 1e-4);
  testing::Test::RecordProperty("median", fmt::format("{:.2g}", errors.median));
  testing::Test::RecordProperty("p99", fmt::format("{:.2g}", errors.p99));
}

Light point_light(const glm::dvec3& position, const glm::vec3& color, float candela) {
  return {.position = position, .color = color, .intensity = candela};
}

TEST(RayCaster, ForwardHasItsRadianceUnderPointLights) {
  Room room = make_room();
  expect_the_casters_radiance(
      room, {point_light({-1.5, 2, 1}, {1, 0.9f, 0.8f}, 5), point_light({2, 0.5, 1}, {0.3f, 0.5f, 1}, 3)},
      0.99);
}

TEST(RayCaster, ForwardHasItsRadianceWhereRangesEnd) {
  Room room = make_room();
  std::vector<Light> lights = {point_light({-1.5, 1, 0}, {1, 0.2f, 0.2f}, 5),
                               point_light({1, 0, -1}, {0.2f, 1, 0.2f}, 2),
                               point_light({0.5, -1, 1}, {0.2f, 0.2f, 1}, 4)};
  for (size_t i = 0; i < lights.size(); ++i) lights[i].radius_m = 3.0f + 0.5f * float(i);
  expect_the_casters_radiance(room, lights, 0.3);
}

TEST(RayCaster, ForwardHasItsRadianceUnderSpots) {
  Room room = make_room();
  std::vector<Light> lights;
  for (int i = 0; i < 3; ++i) {
    Light spot = point_light({2.0 * i - 2, 1.5, 2}, {1, 0.7f, 0.4f}, 9);
    spot.type = LightType::spot;
    spot.direction = glm::normalize(glm::vec3(1.0f - float(i), -0.5f, -1));
    spot.inner_cone_rad = 0.2f * float(i);
    spot.outer_cone_rad = 0.3f + 0.2f * float(i);
    if (i == 1) spot.radius_m = 7;
    lights.push_back(spot);
  }
  expect_the_casters_radiance(room, lights, 0.3);
}

// Equal angles of 0.02 rad to 90 degrees, whose cosines differ from 1 by 2e-4 to 1.
TEST(RayCaster, ForwardHasItsRadianceUnderSpotsWithHardEdges) {
  Room room = make_room();
  std::vector<Light> lights;
  for (const float angle : {0.02f, 0.1f, 0.4f, std::numbers::pi_v<float> / 2}) {
    Light spot = point_light({2.0 * double(lights.size()) - 3, 1.5, 2}, {1, 0.7f, 0.4f}, 9);
    spot.type = LightType::spot;
    spot.direction = glm::normalize(glm::vec3(1.5f - float(lights.size()), -0.5f, -1));
    spot.inner_cone_rad = spot.outer_cone_rad = angle;
    lights.push_back(spot);
    expect_the_casters_radiance(room, {spot}, angle * angle / 20);
  }
  expect_the_casters_radiance(room, lights, 0.3);
}

TEST(RayCaster, ForwardHasItsRadianceUnderDirectionalLights) {
  Room room = make_room();
  Light sun{.type = LightType::directional,
            .direction = glm::normalize(glm::vec3(0.4f, -0.6f, -1)),
            .intensity = 2};
  Light sky{.type = LightType::directional,
            .direction = glm::normalize(glm::vec3(-1, -0.2f, -0.5f)),
            .color = {0.2f, 0.4f, 1}};
  expect_the_casters_radiance(room, {sun, sky}, 0.99);
}

// Four centimetres of the floor and a light 5 mm above it. Positions are floats relative to the eye, 0.2 m
// away: a rounding of 2^-24 there is 2.4e-6 of the light's distance, and counts twice in its square.
TEST(RayCaster, ForwardHasItsRadianceNextToALight) {
  Room room = make_room();
  room.camera = look_at({0, -1.8, 0.1}, {0, -2, 0});
  room.camera.fov_y_rad = 0.2;
  room.camera.near_m = 0.01;
  expect_the_casters_radiance(room, {point_light({0, -1.995, 0}, {1, 0.9f, 0.8f}, 1e-3f)}, 0.99, 1e-5);
}

// The same at a ten-thousandth of the size: no length is hard-coded.
TEST(RayCaster, ForwardHasItsRadianceInAMillimetreOfTheWorld) {
  Room room;
  room.drawn.ambient = glm::vec3(0);
  add_wall(room, {-1e-3f, 0, 1e-3f}, {2e-3f, 0, 0}, {0, 0, -2e-3f}, 0.5f, 0.5f);
  room.spheres = room.drawn;
  room.spheres.instances.clear();
  room.camera = look_at({0, 2e-5, 1e-5}, {0, 0, 0});
  room.camera.fov_y_rad = 0.2;
  room.camera.near_m = 1e-6;
  expect_the_casters_radiance(room, {point_light({0, 5e-7, 0}, {1, 0.9f, 0.8f}, 1e-11f)}, 0.99, 1e-5);
}

}  // namespace
}  // namespace lightgrid
