// Textures, alpha and colours: the properties in the models' own descriptions, measured in pictures that were
// inspected first.
#include "conformance/picture.h"

#include <algorithm>

namespace lightgrid {
using namespace lab;
namespace {

#define NEEDS(model) LIGHTGRID_NEEDS_SHARED("scenes/conformance/" model)

TEST(RenderMaterials, UnlitTestShowsItsTwoColoursExactlyAndNothingElse) {
  NEEDS("UnlitTest");
  const Picture p = picture_of(load_model("UnlitTest/UnlitTest.glb"));
  const glm::vec3 orange(1, 0.217637640824031f, 0), blue(0, 0.217637640824031f, 1), none(0);
  EXPECT_EQ(p.at({-1.2, 0.5, 0}), orange);
  EXPECT_EQ(p.at({1.2, 0, 0}), blue);
  int others = 0;
  for (const glm::vec4& pixel : p.image.pixels) {
    const glm::vec3 c(pixel);
    others += c != orange && c != blue && c != none;
  }
  EXPECT_EQ(others, 0);
}

TEST(RenderMaterials, AlphaBlendModeTestShowsChecksAndNoRedX) {
  NEEDS("AlphaBlendModeTest");
  const Picture p =
      picture_of(load_model("AlphaBlendModeTest/AlphaBlendModeTest.glb"), facing({0, 1}, 5), 640, 320);
  EXPECT_EQ(p.share(Hue::red), 0);
  // The stripes' height in each box, as a fraction of the opaque one's.
  const auto stripes = [&](double x) {
    return p.share(Hue::green, {x - 0.25, 0.15, 0}, {x + 0.45, 1.9, 0}) +
           p.share(Hue::yellow, {x - 0.25, 0.15, 0}, {x + 0.45, 1.9, 0});
  };
  const double opaque = stripes(-3);
  EXPECT_GT(opaque, 0.2) << "alpha is used in opaque mode";
  EXPECT_NEAR(stripes(0) / opaque, 0.75, 0.1) << "cutoff 0.25";
  EXPECT_NEAR(stripes(1.5) / opaque, 0.5, 0.1) << "default cutoff 0.5";
  EXPECT_NEAR(stripes(3) / opaque, 0.25, 0.1) << "cutoff 0.75";
}

TEST(RenderMaterials, TextureSettingsTestShowsOnlyChecks) {
  NEEDS("TextureSettingsTest");
  const Picture p =
      picture_of(load_model("TextureSettingsTest/TextureSettingsTest.glb"), facing({1.5, -1}, 9));
  const char* rows[8] = {"mirror t", "mirror s", "repeat t",     "repeat s",
                         "clamp t",  "clamp s",  "double sided", "single sided"};
  for (int row = 0; row < 8; ++row) {
    const double y = -5.16 + row * 1.034;
    const auto share = [&](Hue hue, double x) {
      return p.share(hue, {x + 0.05, y + 0.05, 0}, {x + 0.85, y + 0.85, 0});
    };
    for (const double x : {0.0, 2.15}) {
      EXPECT_EQ(share(Hue::red, x), 0) << rows[row];
      EXPECT_GT(share(Hue::green, x), 0.05) << rows[row];
    }
    EXPECT_NEAR(share(Hue::green, 0), share(Hue::green, 2.15), 0.1) << rows[row] << ": as its sample";
  }
}

TEST(RenderMaterials, TextureTransformTestPointsItsArrowsAtTheGreenMarkers) {
  NEEDS("TextureTransformTest");
  const Picture p =
      picture_of(load_model("TextureTransformTest/TextureTransformTest.gltf"), facing({0, 0}, 2.4));
  EXPECT_GT(p.share(Hue::green, {-1.55, 0.1, 0}, {-0.65, 1, 0}), 0.5) << "offset u";
  EXPECT_GT(p.share(Hue::blue, {-0.45, 0.1, 0}, {0.45, 1, 0}), 0.5) << "offset v";
  EXPECT_GT(p.share(Hue::cyan, {0.65, 0.1, 0}, {1.55, 1, 0}), 0.5) << "offset u and v";
  const auto black = [&](double x, double y) {
    return p.share(Hue::dark, {x - 0.02, y - 0.02, 0}, {x + 0.02, y + 0.02, 0}) > 0.3;
  };
  EXPECT_TRUE(black(-1.1 - 0.29, -0.55)) << "half way to the marker of a rotation";
  EXPECT_FALSE(black(-1.1 - 0.11, -0.55 + 0.11)) << "not rotated";
  EXPECT_FALSE(black(-1.1, -0.55 + 0.29)) << "rotated the other way";
  EXPECT_TRUE(black(-0.24, -0.55 + 0.24)) << "half way to the marker of a scale";
  EXPECT_FALSE(black(0.15, -0.55 - 0.15)) << "not scaled";
  EXPECT_TRUE(black(1.1 - 0.195, -0.55 + 0.05)) << "before the marker of all three";
}

TEST(RenderMaterials, VertexColorTestMultipliesItsColoursIn) {
  NEEDS("VertexColorTest");
  const Picture p = picture_of(load_model("VertexColorTest/VertexColorTest.glb"), facing({0, 0}, 2.2));
  // Left out, vertex colours leave marks of the other two channels: cyan, magenta and yellow.
  for (const Hue wrong : {Hue::cyan, Hue::magenta, Hue::yellow}) EXPECT_LT(p.share(wrong), 0.001);
  const Hue colours[3] = {Hue::red, Hue::green, Hue::blue};
  for (int i = 0; i < 3; ++i) {
    const double x = -0.78 + 0.58 * i;
    const double test = p.share(colours[i], {x, 0.13, 0}, {x + 0.43, 0.56, 0});
    const double sample = p.share(colours[i], {x, -0.76, 0}, {x + 0.43, -0.33, 0});
    EXPECT_GT(test, 0.03) << i;
    EXPECT_NEAR(test, sample, 0.05) << i;
  }
}

TEST(RenderMaterials, EmissiveStrengthTestDoublesFromCubeToCube) {
  NEEDS("EmissiveStrengthTest");
  Scene scene = load_model("EmissiveStrengthTest/EmissiveStrengthTest.glb");
  const Camera camera = facing({0, 0}, 14);
  const View view = make_view(camera, 320, 240);
  scene.ambient = glm::vec3(0);
  const Picture p{view, render_image(scene, view)};
  float strength = 1;
  for (const double x : {-6.0, -3.0, 0.0, 3.0, 6.0}) {
    const glm::vec3 c = p.at({x, 0, 0.5}), expected = strength * glm::vec3(0.1f, 0.5f, 0.9f);
    EXPECT_LT(glm::length(c - expected), 1e-6f * strength) << x;
    strength *= 2;
  }
}

TEST(RenderMaterials, MultiUvTestPutsItsLogoByTheSecondSet) {
  NEEDS("MultiUVTest");
  Scene scene = load_model("MultiUVTest/MultiUVTest.glb");
  const Picture p = picture_of(scene);
  int second = 0;
  for (Material& m : scene.materials) {
    for (TextureSlot* slot :
         {&m.base_color_map, &m.emissive_map, &m.occlusion_map, &m.metallic_roughness_map, &m.normal_map}) {
      second += slot->texture >= 0 && slot->uv_set == 1;
      slot->uv_set = 0;
    }
  }
  EXPECT_EQ(second, 1);
  EXPECT_FALSE(compare_images(p.image, picture_of(scene).image).bit_identical)
      << "the first set would do as well";
  // A logo on each visible face, on paint of another colour.
  const glm::vec3 right = p.at({1, 0.7, 0.7});
  EXPECT_GT(right.b, 1.3f * right.g);
  EXPECT_GT(right.g, right.r);
  EXPECT_EQ(hue_of(p.at({-0.8, 0.8, 1})), Hue::yellow);
}

TEST(RenderMaterials, MetalRoughSpheresBlurTheirHighlightsFromSmoothToRough) {
  NEEDS("MetalRoughSpheresNoTextures");
  const Scene scene = load_model("MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb");
  Camera camera = look_at({0.003, 0.003, 0.0085}, {0.003, 0.003, 0});
  camera.near_m = 0.001;  // seven millimetres of spheres
  const Picture p = picture_of(scene, camera);
  const auto peak = [&](double x, double y) {
    const glm::ivec2 low = p.pixel({x - 0.0004, y - 0.0004, 0.0005}),
                     high = p.pixel({x + 0.0004, y + 0.0004, 0.0005});
    float largest = 0;
    for (int j = low.y; j <= high.y; ++j) {
      for (int i = low.x; i <= high.x; ++i) largest = std::max(largest, p.image.at(i, j).g);
    }
    return largest;
  };
  // The roughest two look alike: the lobes of the two lights have merged.
  for (int i = 1; i < 5; ++i) EXPECT_GT(peak(0.001 * i, 0.006), 1.1f * peak(0.001 * (i + 1), 0.006)) << i;
}

TEST(RenderMaterials, TexturesOfAnySizeShowTheSameLogo) {
  NEEDS("BoxTexturedNonPowerOfTwo");
  const Picture any = picture_of(load_model("BoxTexturedNonPowerOfTwo/BoxTexturedNonPowerOfTwo.gltf"));
  const Picture power_of_two = picture_of(load_model("BoxTextured-Embedded/BoxTextured.gltf"));
  for (const Picture* p : {&any, &power_of_two}) {
    EXPECT_GT(p->share(Hue::blue) + p->share(Hue::cyan), 0.08);
    EXPECT_GT(p->share(Hue::green) + p->share(Hue::yellow), 0.05);
    EXPECT_GT(p->share(Hue::mixed), 0.1);
  }
  EXPECT_LT(compare_images(any.image, power_of_two.image).rmse, 0.06);
}

TEST(RenderMaterials, NamesWithSpacesAndUnicodeFindTheirTextures) {
  NEEDS("Box With Spaces");
  const Picture box = picture_of(load_model("Box With Spaces/Box With Spaces.gltf"));
  EXPECT_GT(box.share(Hue::green) + box.share(Hue::yellow), 0.05) << "the logo";
  const Picture plate = picture_of(load_model("Unicode❤♻Test/Unicode❤♻Test.gltf"));
  EXPECT_GT(plate.share(Hue::red), 0.005) << "the heart";
  EXPECT_GT(plate.share(Hue::green), 0.005) << "the arrows";
  EXPECT_GT(plate.share(Hue::blue) + plate.share(Hue::cyan), 0.15) << "the ground";
}

}  // namespace
}  // namespace lightgrid
