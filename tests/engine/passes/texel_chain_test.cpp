// Mip chains and packed textures as they lie in memory, worked out by hand.
#include "renderer/upload/texel_chain.h"

#include <gmock/gmock.h>

#include "plan/settings/surfaces.h"
#include "renderer/upload/scene_surfaces.h"
#include "scenes/compose.h"

namespace lightgrid {
namespace {

using testing::ElementsAre;
using testing::Eq;

// One channel counts, the others are 0.
TexelImage one_channel(int width, int height, const std::vector<uint16_t>& values) {
  TexelImage image{width, height, 4, std::vector<uint16_t>(values.size() * 4)};
  for (size_t i = 0; i < values.size(); ++i) image.values[4 * i] = values[i];
  return image;
}

std::vector<uint16_t> first_channel(const std::vector<uint16_t>& values) {
  std::vector<uint16_t> channel;
  for (size_t i = 0; i < values.size(); i += 4) channel.push_back(values[i]);
  return channel;
}

TEST(TexelChain, HalvesEvenSidesAndWeightsOddOnesByArea) {
  EXPECT_THAT(first_channel(next_level(one_channel(4, 1, {10, 20, 30, 50})).values), ElementsAre(15, 40));
  EXPECT_THAT(first_channel(next_level(one_channel(3, 1, {10, 20, 60})).values), ElementsAre(30));
  // 2.5 texels each: weights 0.4, 0.4, 0.2 and 0.2, 0.4, 0.4.
  EXPECT_THAT(first_channel(next_level(one_channel(5, 1, {100, 0, 50, 0, 200})).values), ElementsAre(50, 90));
  EXPECT_THAT(first_channel(next_level(one_channel(1, 2, {7, 8})).values), ElementsAre(8))
      << "rounded, not cut off";
}

TEST(TexelChain, RepeatsWhatFollowsByTheWrapMode) {
  const TexelImage image = one_channel(2, 2, {1, 2, 3, 4});
  EXPECT_THAT(first_channel(make_chain(image, Wrap::repeat, Wrap::repeat, false).values),
              ElementsAre(1, 2, 1, 3, 4, 3, 1, 2, 1));
  EXPECT_THAT(first_channel(make_chain(image, Wrap::clamp, Wrap::repeat, false).values),
              ElementsAre(1, 2, 2, 3, 4, 4, 1, 2, 2));
  EXPECT_THAT(first_channel(make_chain(image, Wrap::repeat, Wrap::mirror, false).values),
              ElementsAre(1, 2, 1, 3, 4, 3, 3, 4, 3));
}

TEST(TexelChain, EndsWithOneTexel) {
  const TexelChain chain =
      make_chain(one_channel(5, 2, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1}), Wrap::clamp, Wrap::clamp, true);
  EXPECT_EQ(chain.last_level, 2u);  // 5 x 2, 2 x 1, 1 x 1
  EXPECT_EQ(chain.level_first[1], 18u);
  EXPECT_EQ(chain.level_first[2], 18u + 6u);
  EXPECT_EQ(chain.values.size(), 4u * (18 + 6 + 4));
}

TEST(TexelChain, AlphasOfFourTexelsAreAWord) {
  TexelImage image{2, 1, 4, {0, 0, 0, 65535, 0, 0, 0, 51400}};  // 255 and 200
  const std::vector<uint32_t> quads =
      alpha_quads(make_chain(std::move(image), Wrap::repeat, Wrap::clamp, false));
  EXPECT_EQ(quads[0], 255u | 200u << 8 | 255u << 16 | 200u << 24);
  EXPECT_EQ(quads[1], 200u | 255u << 8 | 200u << 16 | 255u << 24);
}

int add_grey(Scene& scene, int width, uint8_t grey) {
  Bitmap bitmap{.name = "grey", .width = width, .height = 1};
  bitmap.rgba.assign(size_t(width) * 4, grey);
  return add_texture(scene, std::move(bitmap), false);
}

TEST(SurfaceTexels, PackMapsOfOneSizeAndShareThem) {
  Scene scene;
  const int color = add_grey(scene, 1, 255), normal = add_grey(scene, 1, 51), wide = add_grey(scene, 2, 0);
  for (int i = 0; i < 3; ++i) {
    Material& m = scene.materials[add_material(scene, "paint", {1, 1, 1}, 1, 1)];
    m.base_color_map.texture = color;
    m.normal_map.texture = i < 2 ? normal : wide;
  }
  const SurfaceTexels packed = surface_texels(scene, {true, true, true}, TexelLayout::packed);
  EXPECT_TRUE(packed.materials[0].flags & SURFACE_PACKED);
  EXPECT_EQ(packed.materials[0].maps[0].base, packed.materials[1].maps[0].base);
  EXPECT_FALSE(packed.materials[2].flags & SURFACE_PACKED) << "maps of two sizes";
  EXPECT_EQ(packed.texels_8.size(), 8u * 4);  // a texel, its column and its row, once
  EXPECT_THAT(std::vector<uint16_t>(packed.texels_8.begin(), packed.texels_8.begin() + 8),
              ElementsAre(65535, 65535, 65535, 51 * 257, 51 * 257, 51 * 257, 65535, 65535));
  const SurfaceTexels small = surface_texels(scene, {true, true, true}, TexelLayout::packed_8);
  EXPECT_TRUE(small.texels_8.empty());
  ASSERT_EQ(small.small_texels_8.size(), packed.texels_8.size());
  for (size_t i = 0; i < 8; ++i) {
    const double value = packed.texels_8[i] / 65535.0;
    EXPECT_EQ(small.small_texels_8[i], std::lround(255 * (i < 3 ? std::sqrt(value) : value))) << i;
  }
  const SurfaceTexels separate = surface_texels(scene, {true, true, true}, TexelLayout::separate);
  EXPECT_TRUE(separate.texels_8.empty());
  EXPECT_FALSE(separate.materials[0].flags & SURFACE_PACKED);
  EXPECT_EQ(separate.texels_4.size(), 4u * (4 + 4 + (6 + 4)))
      << "each texture once, the wide one with two levels";
  EXPECT_THAT(surface_texels(scene, {false, false, false}, TexelLayout::packed).texels_8, testing::IsEmpty());
}

}  // namespace
}  // namespace lightgrid
