// The conformance models as pictures: each was compared with its README, and the positions that distinguish
// right from wrong were chosen. We may not redistribute the models, so these are samples, not golden images.
#include <gmock/gmock.h>

#include <cmath>

#include "conformance/picture.h"
#include "scene/light_rigs.h"
#include "scene/load_gltf.h"
#include "support/render.h"
#include "support/shared_files.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr int width = 400, height = 300;

struct Spot {
  float u, v;   // relative to the image's width and height, v from the top
  int r, g, b;  // sRGB bytes
};

struct Model {
  const char* file;    // below scenes/conformance
  const char* camera;  // empty: as `render` chooses
  std::vector<Spot> spots;
};

// As `lightgrid render` shows a model: with the default lights if it has none.
std::vector<uint8_t> picture_of(const std::string& file, const std::string& camera) {
  Scene scene = load_gltf(shared_folder() / "scenes/conformance" / file);
  const View view =
      make_view(camera.empty() ? camera_at_the_corner(scene) : choose_camera(scene, camera), width, height);
  if (scene.lights.empty()) {
    DefaultLights added = default_lights(view);
    scene.lights = std::move(added.lights);
    scene.ambient = added.ambient;
  }
  return srgb_bytes(render_image(scene, view));
}

class ConformanceModel : public testing::TestWithParam<Model> {};

TEST_P(ConformanceModel, ShowsWhatItsReadmeSays) {
  LIGHTGRID_NEEDS_SHARED(std::filesystem::path("scenes/conformance") / GetParam().file);
  const std::vector<uint8_t> bytes = picture_of(GetParam().file, GetParam().camera);
  for (const Spot& spot : GetParam().spots) {
    const uint8_t* pixel = &bytes[3 * (size_t(spot.v * height) * width + size_t(spot.u * width))];
    // Tolerance in steps for filtering and rounding inside an even area; a wrong texture, colour, winding or
    // transform differs by more.
    constexpr int steps = 14;
    SCOPED_TRACE(fmt::format("at {}, {}: {} {} {}", spot.u, spot.v, pixel[0], pixel[1], pixel[2]));
    EXPECT_NEAR(pixel[0], spot.r, steps);
    EXPECT_NEAR(pixel[1], spot.g, steps);
    EXPECT_NEAR(pixel[2], spot.b, steps);
  }
}

const std::vector<Model> models = {
    {"02_node_hierarchy/02_node_hierarchy.gltf",
     "",
     {{.40f, .62f, 131, 131, 131}, {.66f, .30f, 159, 159, 159}}},
    // Opaque: alpha ignored, black stays. Masks: cut out above the mark, where the wall behind is visible.
    {"AlphaBlendModeTest/AlphaBlendModeTest.glb",
     "eye:0,1.2,6,target:0,1.2,0,fov:45",
     {{.0625f, .36f, 14, 14, 11},
      {.5175f, .4067f, 192, 181, 162},
      {.745f, .45f, 195, 187, 171},
      {.93f, .50f, 200, 194, 183}}},
    {"Box With Spaces/Box With Spaces.gltf", "", {{.38f, .62f, 6, 6, 6}, {.67f, .53f, 35, 58, 4}}},
    {"BoxInterleaved/BoxInterleaved.glb", "", {{.40f, .60f, 151, 0, 0}, {.70f, .50f, 131, 0, 0}}},
    {"BoxTextured-Embedded/BoxTextured.gltf", "", {{.42f, .42f, 70, 128, 169}, {.696f, .55f, 54, 85, 8}}},
    {"BoxTexturedNonPowerOfTwo/BoxTexturedNonPowerOfTwo.gltf", "", {{.42f, .42f, 70, 128, 169}}},
    {"Cameras/Cameras.gltf", "", {{.50f, .50f, 172, 172, 172}}},
    {"CesiumMan/CesiumMan.gltf", "", {{.50f, .12f, 68, 127, 169}, {.48f, .45f, 201, 201, 201}}},
    {"CesiumMilkTruck/CesiumMilkTruck.glb", "", {{.36f, .45f, 6, 50, 36}}},
    {"EmissiveStrengthTest/EmissiveStrengthTest.glb",
     "",
     {{.70f, .525f, 218, 237, 255}, {.60f, .53f, 150, 150, 150}}},
    {"InterpolationTest/InterpolationTest.glb", "", {{.45f, .55f, 175, 175, 175}}},
    {"LightOrientation/LightOrientation.gltf", "", {{.50f, .45f, 0, 39, 0}, {.67f, .60f, 39, 0, 0}}},
    {"LightsPunctualLamp/LightsPunctualLamp.gltf", "", {{.45f, .40f, 255, 235, 230}}},
    {"MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb", "", {{.20f, .35f, 0, 0, 0}}},
    {"MultiUVTest/MultiUVTest.glb", "", {{.42f, .75f, 158, 152, 81}, {.60f, .70f, 46, 75, 108}}},
    {"MultipleScenes/MultipleScenes.gltf", "", {{.50f, .50f, 154, 154, 154}}},
    {"OrientationTest/OrientationTest.glb", "", {{.60f, .27f, 0, 140, 0}, {.665f, .54f, 206, 4, 4}}},
    {"PlaycanvasLights/Lights.glb", "", {{.40f, .60f, 6, 135, 135}, {.66f, .60f, 43, 8, 8}}},
    {"RecursiveSkeletons/RecursiveSkeletons.glb", "", {{.50f, .50f, 154, 154, 154}}},
    {"SimpleSkin/SimpleSkin.gltf", "", {{.50f, .50f, 154, 154, 154}}},
    // The sparse values lift three corners into peaks; between them it is dark.
    {"SimpleSparseAccessor/SimpleSparseAccessor.gltf",
     "",
     {{.50f, .65f, 156, 156, 156}, {.45f, .35f, 0, 0, 0}}},
    {"TextureTransformTest/TextureTransformTest.gltf",
     "",
     {{.40f, .30f, 4, 150, 4}, {.50f, .33f, 4, 4, 150}}},
    {"TriangleWithoutIndices/TriangleWithoutIndices.gltf",
     "",
     {{.40f, .60f, 158, 158, 158}, {.60f, .30f, 0, 0, 0}}},
    {"Unicode❤♻Test/Unicode❤♻Test.gltf", "", {{.43f, .52f, 181, 7, 23}, {.58f, .60f, 13, 148, 5}}},
    // #FF7F00 and #007FFF, through the tone map alone.
    {"UnlitTest/UnlitTest.glb", "", {{.40f, .60f, 241, 125, 33}, {.66f, .65f, 33, 125, 241}}},
    {"VertexColorTest/VertexColorTest.glb",
     "",
     {{.40f, .36f, 200, 5, 5}, {.50f, .40f, 5, 200, 5}, {.66f, .43f, 4, 4, 200}}},
};

INSTANTIATE_TEST_SUITE_P(Of, ConformanceModel, testing::ValuesIn(models), [](const auto& info) {
  std::string name;
  for (const char* c = info.param.file; *c && *c != '/'; ++c) {
    if (std::isalnum(static_cast<unsigned char>(*c))) name += *c;
  }
  return name;
});

// These two draw a green tick for right and a red cross for wrong.
class TickedModel : public testing::TestWithParam<std::pair<const char*, int>> {};

TEST_P(TickedModel, HasTicksAndNoCross) {
  const auto& [file, min_green] = GetParam();
  LIGHTGRID_NEEDS_SHARED(std::filesystem::path("scenes/conformance") / file);
  const std::vector<uint8_t> bytes = picture_of(file, "eye:0,0,14,target:0,0,0,fov:50");
  int green = 0, red = 0;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    green += bytes[i + 1] > 100 && bytes[i] < 60 && bytes[i + 2] < 60;
    red += bytes[i] > 100 && bytes[i + 1] < 60 && bytes[i + 2] < 60;
  }
  EXPECT_EQ(red, 0);
  EXPECT_GT(green, min_green);
}

INSTANTIATE_TEST_SUITE_P(Of, TickedModel,
                         testing::Values(std::pair("TextureSettingsTest/TextureSettingsTest.glb", 1800),
                                         std::pair("NegativeScaleTest/NegativeScaleTest.glb", 200)),
                         [](const auto& info) { return std::string(info.param.first, 12); });

}  // namespace
}  // namespace lightgrid
