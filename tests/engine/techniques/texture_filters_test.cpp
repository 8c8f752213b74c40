// glTF's six minification filters, distinguished by a texture of two texels seen from half way between its
// two levels.
#include <algorithm>

#include "scenes/compose.h"
#include "scenes/shapes.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

// Red of every pixel of an unlit wall with 2^0.5 texels a pixel, black and white in turn along x. Level 1 is
// grey.
std::vector<float> wall_through(Filter filter) {
  Scene scene;
  Bitmap bitmap{.name = "stripes", .width = 2, .height = 2};
  for (const int byte : {0, 255, 0, 255}) {
    for (int channel = 0; channel < 4; ++channel) bitmap.rgba.push_back(uint8_t(channel == 3 ? 255 : byte));
  }
  const int texture = add_texture(scene, std::move(bitmap), false);
  scene.textures[texture].min_filter = filter;
  const int material = add_material(scene, "stripes", {1, 1, 1}, 0, 1);
  scene.materials[material].unlit = true;
  scene.materials[material].base_color_map = repeat_every(texture, std::sqrt(2.0f));
  Mesh mesh;
  shapes::add_quad(mesh, {-40, -40, -1}, {80, 0, 0}, {0, 80, 0});
  add_instance(scene, "wall", add_mesh(scene, shapes::finished(std::move(mesh), "wall", material)));
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  camera.orthographic = true;
  camera.half_width_m = camera.half_height_m = 32;
  camera.far_m = 10;  // a metre a pixel
  const Image image = render(scene, make_view(camera, 64, 64), "forward");
  std::vector<float> reds;
  for (const glm::vec4& pixel : image.pixels) reds.push_back(pixel.r);
  return reds;
}

bool each_is_near(const std::vector<float>& values, const std::vector<float>& places) {
  return std::all_of(values.begin(), values.end(), [&](float value) {
    return std::any_of(places.begin(), places.end(),
                       [&](float place) { return std::abs(value - place) < 0.1f; });
  });
}

bool some_is_near(const std::vector<float>& values, float place) {
  return std::any_of(values.begin(), values.end(),
                     [&](float value) { return std::abs(value - place) < 0.1f; });
}

TEST(TextureFilters, NearestTakesATexelOfOneLevelOrMixesThoseOfTwo) {
  EXPECT_TRUE(each_is_near(wall_through(Filter::nearest), {0, 1}));
  EXPECT_TRUE(each_is_near(wall_through(Filter::nearest_mipmap_nearest), {0, 0.5f, 1}));
  const std::vector<float> mixed = wall_through(Filter::nearest_mipmap_linear);
  EXPECT_TRUE(each_is_near(mixed, {0.25f, 0.75f}));
  EXPECT_TRUE(some_is_near(mixed, 0.25f) && some_is_near(mixed, 0.75f));
}

TEST(TextureFilters, LinearReachesBlackAndWhiteInLevelZeroAlone) {
  const auto least = [](const std::vector<float>& values) {
    return *std::min_element(values.begin(), values.end());
  };
  EXPECT_LT(least(wall_through(Filter::linear)), 0.1f);
  const std::vector<float> one_level = wall_through(Filter::linear_mipmap_nearest);
  EXPECT_TRUE(least(one_level) < 0.1f || each_is_near(one_level, {0.5f})) << least(one_level);
  const std::vector<float> mixed = wall_through(Filter::linear_mipmap_linear);
  EXPECT_NEAR(least(mixed), 0.25f, 0.1f);
  EXPECT_FALSE(each_is_near(mixed, {0.25f, 0.75f})) << "linear within a level";
}

}  // namespace
}  // namespace lightgrid
