// Images: where they lie, what is read of them, what is refused before it is decoded.
#include <algorithm>

#include "base/image.h"
#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A triangle whose material has these maps, of two textures of 2 x 1 and 1 x 3 pixels.
GltfBuilder with_maps(const nlohmann::json& maps) {
  const auto uri = [](int width, int height) {
    const Bytes grey(size_t(width) * size_t(height) * 3, 200);
    return "data:image/png;base64," + base64(encode_png(width, height, 3, grey));
  };
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("TEXCOORD_0", std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2", f32, 3);
  made.root["materials"] = {maps};
  made.primitive()["material"] = 0;
  made.root["images"] = {{{"uri", uri(2, 1)}}, {{"uri", uri(1, 3)}}};
  made.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
  return made;
}

GltfBuilder with_image(const Bytes& file) {
  GltfBuilder made = with_maps({{"normalTexture", {{"index", 0}}}});
  made.root["images"][0] = {{"bufferView", made.view(file)}, {"mimeType", "image/png"}, {"name", "im"}};
  return made;
}

TEST(GltfImage, pixels_are_rgba_with_the_top_row_first) {
  const Bytes file = encode_png(2, 2, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  const Bitmap bitmap = with_image(file).load().bitmaps.at(0);
  EXPECT_THAT(bitmap.rgba, ElementsAre(1, 2, 3, 255, 4, 5, 6, 255, 7, 8, 9, 255, 10, 11, 12, 255));
}

TEST(GltfImage, images_lie_in_files_and_views_of_a_glb_alike) {
  const ModelFolder folder;
  const Bytes file = encode_png(1, 1, 3, {9, 8, 7});
  folder.write("pictures/a b.png", file);
  GltfBuilder made = with_image(file);
  EXPECT_EQ(load_gltf(folder.write("a.glb", made.glb())).bitmaps.at(0).rgba[0], 9);
  made.root["images"][0] = {{"uri", "pictures/a%20b.png"}};
  EXPECT_EQ(load_gltf(folder.write("a.gltf", made.text())).bitmaps.at(0).rgba[0], 9);
  made.root["images"][0] = {{"uri", "pictures/none.png"}};
  EXPECT_THAT(refusal_of(folder.write("a.gltf", made.text())),
              HasSubstr("image 0 \"pictures/none.png\": file \"pictures/none.png\" cannot be read"));
}

TEST(GltfImage, what_is_no_png_or_jpeg_is_refused) {
  EXPECT_THAT(with_image(Bytes{'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0, 0, 0, 0}).refusal(),
              HasSubstr("image 0 \"im\": is neither PNG nor JPEG"));
  Bytes cut = encode_png(16, 16, 3, Bytes(768, 5));
  cut.resize(cut.size() / 2);
  EXPECT_THAT(with_image(cut).refusal(), HasSubstr("image 0 \"im\": cannot be decoded"));
}

// A header without data: if it were decoded first, the message would differ.
Bytes png_header(uint32_t width, uint32_t height) {
  Bytes file = encode_png(1, 1, 3, {0, 0, 0});
  for (int i = 0; i < 4; ++i) {
    file[16 + i] = static_cast<uint8_t>(width >> (24 - 8 * i));
    file[20 + i] = static_cast<uint8_t>(height >> (24 - 8 * i));
  }
  return file;
}

TEST(GltfImage, sizes_are_checked_before_anything_is_decoded) {
  EXPECT_THAT(with_image(png_header(8193, 1)).refusal(),
              HasSubstr("is 8193 x 1; a side of at most 8192 is read"));
  EXPECT_THAT(with_image(png_header(8, 8)).refusal({.max_image_side = 7}),
              HasSubstr("is 8 x 8; a side of at most 7"));
  EXPECT_THAT(with_image(png_header(64, 64)).refusal({.max_image_bytes = 16000}),
              HasSubstr("images take more than 16000"));
  const GltfBuilder two =
      with_maps({{"normalTexture", {{"index", 0}}}, {"occlusionTexture", {{"index", 1}}}});
  EXPECT_EQ(two.load({.max_image_bytes = 1000}).bitmaps.size(), 2u);
  EXPECT_THAT(two.refusal({.max_image_bytes = 150}),
              HasSubstr("image 1: with it, images take more than 150 bytes"));
}

// A PNG of side x side pixels, nearly all black, whose header says 1 x 1.
Bytes png_that_inflates(int side) {
  Bytes pixels(size_t(side) * side * 3, 0);
  for (int i = 0; i < 1000; ++i)
    pixels[i * 3] = static_cast<uint8_t>(i), pixels[i * 3 + 1] = i / 256;  // no palette
  Bytes file = encode_png(side, side, 3, pixels);
  const Bytes header = png_header(1, 1);
  std::copy_n(header.begin(), 24, file.begin());
  return file;
}

TEST(GltfImage, data_that_inflates_to_far_more_than_the_header_says_is_refused) {
  const Bytes bomb = png_that_inflates(6000);  // 108 MB
  ASSERT_LT(bomb.size(), size_t(2) << 20);
  EXPECT_THAT(with_image(bomb).refusal(), HasSubstr("more than 1 x 1 pixels need"));
}

TEST(GltfImage, sixteen_bits_become_eight_with_a_warning) {
  // 1 x 1, 16-bit grey 0x1234, stored without compression.
  const Bytes file = {0x89, 'P',  'N',  'G', 13,   10,   26,   10,   0,    0,    0,   13,   'I', 'H', 'D',
                      'R',  0,    0,    0,   1,    0,    0,    0,    1,    16,   0,   0,    0,   0,   0,
                      0,    0,    0,    0,   0,    0,    14,   'I',  'D',  'A',  'T', 0x78, 1,   1,   3,
                      0,    0xfc, 0xff, 0,   0x12, 0x34, 0x00, 0x59, 0x00, 0x47, 0,   0,    0,   0,   0,
                      0,    0,    0,    'I', 'E',  'N',  'D',  0,    0,    0,    0};
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = with_image(file).load(); }),
              HasSubstr("has 16 bits a channel, reduced to 8"));
  EXPECT_THAT(scene.bitmaps.at(0).rgba, ElementsAre(0x12, 0x12, 0x12, 255));
}

}  // namespace
}  // namespace lightgrid
