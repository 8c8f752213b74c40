// visibility on the conformance models: no further from surfaces in double than forward.
#include <gmock/gmock.h>

#include "conformance/double_errors.h"
#include "conformance/picture.h"
#include "plan/settings/kernels.h"

namespace lightgrid {
using namespace lab;
namespace {

// Mean errors, of the brightest channel: float's rounding alone, and that of a depth whose corners are
// rounded to 1/256 pixel, which OpenGL's are not. It shows where a light's edge falls on a surface:
// LightOrientation, PlaycanvasLights.
constexpr double rounding = 1e-6, snapped_depth = 5e-6;

struct VisibilityModel : testing::TestWithParam<const char*> {};

TEST_P(VisibilityModel, IsNoFurtherFromDoubleThanForward) {
  LIGHTGRID_NEEDS_SHARED(std::filesystem::path("scenes/conformance") / GetParam());
  Scene scene = load_model(GetParam());
  for (Material& m : scene.materials) {
    if (m.alpha_mode == AlphaMode::blend) m.alpha_mode = AlphaMode::opaque;
  }
  const View view = make_view(camera_at_the_corner(scene), 160, 120);
  if (scene.lights.empty()) {
    DefaultLights added = default_lights(view);
    scene.lights = std::move(added.lights);
    scene.ambient = added.ambient;
  }
  const DoubleErrors e = errors_against_double(scene, view, {{setting::everything_on, true}});
  fmt::print(
      "{}: {} of {} pixels compared; mean error {:.2g} ({:.2g} at its own depth), forward's {:.2g}; largest "
      "{:.2g}, {:.2g}; other "
      "triangles {}, {}\n",
      GetParam(), e.compared, e.pixels, e.mean, e.own_depth_mean, e.forward_mean, e.largest,
      e.forward_largest, e.elsewhere, e.forward_elsewhere);
  EXPECT_GT(e.compared, e.pixels / 50);
  EXPECT_LE(e.own_depth_mean, std::max(e.forward_mean, rounding));
  EXPECT_LE(e.mean, std::max(e.forward_mean, snapped_depth));
  EXPECT_LT(double(e.elsewhere), 0.005 * double(e.pixels));
}

INSTANTIATE_TEST_SUITE_P(
    Of, VisibilityModel,
    testing::Values(
        "02_node_hierarchy/02_node_hierarchy.gltf", "AlphaBlendModeTest/AlphaBlendModeTest.glb",
        "Box With Spaces/Box With Spaces.gltf", "BoxInterleaved/BoxInterleaved.glb",
        "BoxTextured-Embedded/BoxTextured.gltf", "BoxTexturedNonPowerOfTwo/BoxTexturedNonPowerOfTwo.gltf",
        "Cameras/Cameras.gltf", "CesiumMan/CesiumMan.gltf", "CesiumMilkTruck/CesiumMilkTruck.glb",
        "EmissiveStrengthTest/EmissiveStrengthTest.glb", "InterpolationTest/InterpolationTest.glb",
        "LightOrientation/LightOrientation.gltf", "LightsPunctualLamp/LightsPunctualLamp.gltf",
        "MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb", "MultiUVTest/MultiUVTest.glb",
        "NegativeScaleTest/NegativeScaleTest.glb", "OrientationTest/OrientationTest.glb",
        "PlaycanvasLights/Lights.glb", "SimpleSkin/SimpleSkin.gltf",
        "SimpleSparseAccessor/SimpleSparseAccessor.gltf", "TextureSettingsTest/TextureSettingsTest.glb",
        "TextureTransformTest/TextureTransformTest.gltf",
        "TriangleWithoutIndices/TriangleWithoutIndices.gltf", "UnlitTest/UnlitTest.glb",
        "VertexColorTest/VertexColorTest.glb"),
    [](const auto& info) {
      std::string name;
      for (const char* c = info.param; *c && *c != '/'; ++c) {
        if (std::isalnum(static_cast<unsigned char>(*c))) name += *c;
      }
      return name;
    });

}  // namespace
}  // namespace lightgrid
