// Pictures lit by the models' own lights.
#include "conformance/picture.h"

namespace lightgrid {
using namespace lab;
namespace {

#define NEEDS(model) LIGHTGRID_NEEDS_SHARED("scenes/conformance/" model)

TEST(RenderLights, PlaycanvasLightsShineWhereTheirNodesPutThem) {
  NEEDS("PlaycanvasLights");
  Scene scene = load_model("PlaycanvasLights/Lights.glb");
  scene.ambient = glm::vec3(0);
  const Picture p = picture_of(scene);
  // A green spot 0.94 m above the top, its cone 0.39 m wide there; a blue one at 6.2 m, 0.41 m wide.
  EXPECT_EQ(hue_of(p.at({-0.27, 1, 0.35})), Hue::green);
  const float beside = p.at({0.9, 1, -0.9}).b;
  EXPECT_GT(p.at({0.25, 1, -0.15}).b, beside + 0.08f);
  EXPECT_NEAR(p.at({-0.9, 1, -0.9}).b, beside, 0.01f * beside) << "beside both cones alike";
  // A cyan sun on the front, a red lamp to the right.
  const glm::vec3 front = p.at({0, 0, 1}), right = p.at({1, 0, 0});
  EXPECT_EQ(hue_of(front), Hue::cyan);
  EXPECT_EQ(front.g, front.b);
  EXPECT_EQ(hue_of(right), Hue::red);
  EXPECT_LT(right.b, 0.05f * front.b) << "the sun hardly reaches it";
}

TEST(RenderLights, LampIsTheSumOfItsFiveLights) {
  NEEDS("LightsPunctualLamp");
  Scene scene = load_model("LightsPunctualLamp/LightsPunctualLamp.gltf");
  ASSERT_EQ(scene.lights.size(), 5u);
  const View view = make_view(camera_at_the_corner(scene), 160, 120);
  const Image all = render_image(scene, view);
  const std::vector<Light> lights = scene.lights;
  scene.lights.clear();
  const Image none = render_image(scene, view);
  Image sum = none;
  for (const Light& light : lights) {
    scene.lights = {light};
    const Image one = render_image(scene, view);
    EXPECT_GT(compare_images(one, none).rmse, 0.001) << light.name << " lights nothing";
    for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += one.pixels[i] - none.pixels[i];
  }
  EXPECT_EQ(count_nan_pixels(all), 0u);
  EXPECT_LT(compare_images(all, sum).max_rel, 1e-5);
  EXPECT_GT(compare_images(all, none).rmse, 0.1);
}

TEST(RenderLights, LightOrientationShowsFourDiscsOnTheRedPlaneEachWider) {
  NEEDS("LightOrientation");
  const Scene scene = load_model("LightOrientation/LightOrientation.gltf");
  ASSERT_EQ(scene.lights.size(), 4u);
  // Along each light's axis, from where its disc is a circle as wide as the cone.
  std::vector<int> widths;
  for (const double x : {-4.0, -2.0, 0.0, 2.0}) {
    const Light* light = nullptr;
    for (const Light& l : scene.lights) {
      if (std::abs(l.position.x - x) < 0.1) light = &l;
    }
    ASSERT_NE(light, nullptr) << x;
    const glm::dvec3 eye = light->position + glm::dvec3(light->direction) * 0.2;
    const Picture p = picture_of(scene, look_at(eye, eye + glm::dvec3(light->direction)));
    int lit = 0;
    for (int i = 0; i < p.view.width; ++i) lit += p.image.at(i, p.view.height / 2).r > 100;
    widths.push_back(lit);
  }
  for (size_t i = 1; i < widths.size(); ++i) EXPECT_GT(widths[i], 1.5 * widths[i - 1]) << i;
  EXPECT_GT(widths[0], 2);
}

}  // namespace
}  // namespace lightgrid
