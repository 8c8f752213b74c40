// EXT_texture_webp.
#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// 3 x 2 pixels, lossless, by libwebp's encoder.
constexpr const char* small_webp =
    "UklGRkoAAABXRUJQVlA4TD4AAAAvAkAAEC9AkG2zQdzr/jLTIJO2yV//dmZtZNI2rYf986+yBNk2U5/"
    "NjI7zQI94SK73bSAQoIwVD2wT0f8YLw==";
// 1 x 1, black.
constexpr const char* small_png =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNgYGAAAAAEAAH2FzhVAAAAAElFTkSuQmCC";

// A base colour texture: a PNG as its source and a WebP image by the extension.
GltfBuilder with_webp() {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("TEXCOORD_0", std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2", f32, 3);
  made.primitive()["material"] = 0;
  made.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  made.root["images"] = {{{"name", "png"}, {"uri", std::string("data:image/png;base64,") + small_png}},
                         {{"name", "webp"}, {"uri", std::string("data:image/webp;base64,") + small_webp}}};
  made.root["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
  made.root["extensionsUsed"] = {"EXT_texture_webp"};
  return made;
}

// The WebP file with one byte changed, or cut off.
std::string changed_webp(size_t at, uint8_t value, size_t size = 0) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  Bytes bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char* c = small_webp; *c && *c != '='; ++c) {
    bits = bits << 6 | uint32_t(digits.find(*c));
    count += 6;
    if (count >= 8) bytes.push_back(uint8_t(bits >> (count -= 8)));
  }
  bytes.at(at) = value;
  if (size > 0) bytes.resize(size);
  return "data:image/webp;base64," + base64(bytes);
}

TEST(GltfWebp, the_extensions_image_comes_before_the_source) {
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = with_webp().load(); }), IsEmpty());
  ASSERT_EQ(scene.bitmaps.size(), 1u);
  const Bitmap& bitmap = scene.bitmaps[0];
  EXPECT_EQ(bitmap.name, "webp");
  EXPECT_EQ(bitmap.width, 3);
  EXPECT_EQ(bitmap.height, 2);
  EXPECT_THAT(bitmap.rgba, ElementsAre(255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255,  //
                                       10, 20, 30, 40, 200, 100, 50, 255, 255, 255, 255, 128));
}

TEST(GltfWebp, a_texture_without_another_source_and_a_required_extension_are_read) {
  GltfBuilder made = with_webp();
  made.root["textures"][0].erase("source");
  made.root["extensionsRequired"] = {"EXT_texture_webp"};
  EXPECT_EQ(made.load().bitmaps.at(0).width, 3);
  made.root["images"].erase(0);
  made.root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 0;
  EXPECT_EQ(made.load().bitmaps.at(0).width, 3);
}

TEST(GltfWebp, content_counts_not_where_the_image_is_named) {
  GltfBuilder made = with_webp();
  made.root["textures"][0] = {{"source", 1}};
  EXPECT_EQ(made.load().bitmaps.at(0).width, 3) << "the file uses the extension elsewhere";
  made.root["extensionsUsed"].clear();
  EXPECT_THAT(
      made.broken_images(),
      HasSubstr("made.gltf: image 1 \"webp\": is WebP, but extensionsUsed does not name EXT_texture_webp"));
  made = with_webp();
  made.root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 0;
  EXPECT_EQ(made.load().bitmaps.at(0).width, 1) << "a PNG image";
}

TEST(GltfWebp, limits_hold_before_anything_is_decoded) {
  EXPECT_THAT(with_webp().broken_images({.max_image_side = 2}),
              HasSubstr("image 1 \"webp\": is 3 x 2; a side of at most 2 is read"));
  EXPECT_THAT(with_webp().refusal({.max_image_bytes = 20}), HasSubstr("images take"));
}

TEST(GltfWebp, broken_files_and_indices_are_refused) {
  GltfBuilder made = with_webp();
  made.root["images"][1]["uri"] = changed_webp(20, 0);  // the lossless format's own signature
  EXPECT_THAT(made.broken_images(),
              HasSubstr("made.gltf: image 1 \"webp\": cannot be decoded: its WebP header is broken"));
  made.root["images"][1]["uri"] = changed_webp(0, 'R', 60);
  EXPECT_THAT(made.broken_images(),
              HasSubstr("made.gltf: image 1 \"webp\": cannot be decoded: its WebP data is broken"));
  made.root["images"][1]["uri"] =
      "data:image/webp;base64," + base64(Bytes{'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0, 0, 0});
  EXPECT_THAT(made.broken_images(), HasSubstr("image 1 \"webp\": is neither PNG nor JPEG nor WebP"));
  made = with_webp();
  made.root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 7;
  EXPECT_EQ(made.refusal(), "made.gltf: texture 0: EXT_texture_webp.source is 7, but there are 2");
}

}  // namespace
}  // namespace lightgrid
