// Images: where they lie, what is read of them, what is refused before it is decoded.
#include <algorithm>

#include "base/image.h"
#include "base/resident.h"
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
  EXPECT_THAT(warnings_of([&] { load_gltf(folder.write("a.gltf", made.text())); }),
              HasSubstr("image 0 \"pictures/none.png\": file \"pictures/none.png\" cannot be read"));
}

bool is_checkerboard(const Bitmap& bitmap) {
  const auto pixel = [&](int x, int y) {
    return Bytes(bitmap.rgba.begin() + 4 * (y * bitmap.width + x),
                 bitmap.rgba.begin() + 4 * (y * bitmap.width + x) + 4);
  };
  return bitmap.width == 64 && pixel(0, 0) == Bytes{255, 0, 255, 255} &&
         pixel(8, 0) == Bytes{64, 64, 64, 255} && pixel(8, 8) == pixel(0, 0) && pixel(0, 8) == pixel(8, 0);
}

TEST(GltfImage, a_missing_image_is_a_checkerboard_and_its_other_maps_are_left_out) {
  GltfBuilder made =
      with_maps({{"pbrMetallicRoughness",
                  {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 0}}}}},
                 {"emissiveTexture", {{"index", 0}}},
                 {"emissiveFactor", {1, 1, 1}},
                 {"normalTexture", {{"index", 0}}},
                 {"occlusionTexture", {{"index", 1}}}});
  made.root["images"][0] = {{"uri", "gone.png"}};
  Scene scene;
  const std::string warnings = warnings_of([&] { scene = made.load(); });
  EXPECT_THAT(
      warnings,
      HasSubstr("image 0 \"gone.png\": file \"gone.png\" cannot be read: No such file or directory; a "
                "checkerboard is drawn in its place"));
  const Material& material = scene.materials.at(0);
  const auto bitmap_of = [&](const TextureSlot& slot) {
    return scene.bitmaps.at(size_t(scene.textures.at(size_t(slot.texture)).bitmap));
  };
  EXPECT_TRUE(is_checkerboard(bitmap_of(material.base_color_map)));
  EXPECT_EQ(bitmap_of(material.occlusion_map).height, 3) << "the other image";
  for (const TextureSlot* slot :
       {&material.metallic_roughness_map, &material.normal_map, &material.emissive_map})
    EXPECT_EQ(slot->texture, -1);
  EXPECT_EQ(material.metallic, 0);
  EXPECT_EQ(material.emissive, glm::vec3(0));
}

// Its pixels would be both the specular colour and the roughness.
TEST(GltfImage, a_missing_specular_glossiness_image_is_named_once_and_leaves_no_mirror) {
  GltfBuilder made = with_maps(
      {{"extensions",
        {{"KHR_materials_pbrSpecularGlossiness", {{"specularGlossinessTexture", {{"index", 0}}}}}}}});
  made.root["images"][0] = {{"uri", "gone.png"}};
  Scene scene;
  const std::string warnings = warnings_of([&] { scene = made.load(); });
  EXPECT_EQ(std::count(warnings.begin(), warnings.end(), '\n'), 1) << warnings;
  EXPECT_EQ(scene.materials.at(0).specular_color_map.texture, -1);
  EXPECT_EQ(scene.materials.at(0).metallic_roughness_map.texture, -1);
  EXPECT_EQ(dielectric_f0(scene.materials.at(0)), glm::vec3(0.04f));
  EXPECT_EQ(scene.materials.at(0).roughness, 1);
}

TEST(GltfImage, each_missing_image_is_named_up_to_eight) {
  GltfBuilder made = with_maps(nlohmann::json::object());
  made.root["materials"] = nlohmann::json::array();
  const nlohmann::json primitive = made.primitive();
  made.root["meshes"][0]["primitives"] = nlohmann::json::array();
  for (int i = 0; i < 10; ++i) {
    made.root["images"][i] = {{"uri", fmt::format("gone{}.png", i)}};
    made.root["textures"][i] = {{"source", i}};
    made.root["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    made.root["meshes"][0]["primitives"].push_back(primitive);
    made.root["meshes"][0]["primitives"][i]["material"] = i;
  }
  const std::string warnings = warnings_of([&] { made.load(); });
  for (int i = 0; i < 8; ++i) EXPECT_THAT(warnings, HasSubstr(fmt::format("\"gone{}.png\"", i)));
  EXPECT_THAT(warnings, Not(HasSubstr("gone8")));
  EXPECT_THAT(warnings, HasSubstr("2 more images are missing or broken"));
}

TEST(GltfImage, an_image_outside_the_folder_is_not_read_and_the_option_is_named) {
  const ModelFolder folder;
  folder.write("outside.png", encode_png(1, 1, 3, {9, 8, 7}));
  GltfBuilder made = with_maps({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  made.root["images"][0] = {{"uri", "../outside.png"}};
  const auto path = folder.write("models/a.gltf", made.text());
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = load_gltf(path); }), HasSubstr("--files anywhere reads it"));
  EXPECT_TRUE(is_checkerboard(scene.bitmaps.at(0)));
  EXPECT_EQ(load_gltf(path, -1, {.files_anywhere = true}).bitmaps.at(0).rgba[0], 9);
}

TEST(GltfImage, an_empty_uri_is_named_as_such) {
  GltfBuilder made = with_maps({{"normalTexture", {{"index", 0}}}});
  made.root["images"][0] = {{"uri", ""}};
  EXPECT_THAT(made.broken_images(), HasSubstr("images[0].uri is empty"));
  made.root["images"][0] = {{"uri", 3}};
  EXPECT_THAT(made.broken_images(), HasSubstr("images[0].uri is not a string"));
}

TEST(GltfImage, what_is_no_png_or_jpeg_is_named) {
  EXPECT_THAT(with_image(Bytes{'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0, 0, 0, 0}).broken_images(),
              HasSubstr("image 0 \"im\": is neither PNG nor JPEG"));
  Bytes cut = encode_png(16, 16, 3, Bytes(768, 5));
  cut.resize(cut.size() / 2);
  EXPECT_THAT(with_image(cut).broken_images(), HasSubstr("image 0 \"im\": cannot be decoded"));
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
  EXPECT_THAT(with_image(png_header(32769, 1)).broken_images(),
              HasSubstr("is 32769 x 1; a side of at most 32768 is read"));
  EXPECT_THAT(with_image(png_header(8, 8)).broken_images({.max_image_side = 7}),
              HasSubstr("is 8 x 8; a side of at most 7"));
  EXPECT_THAT(with_image(png_header(64, 64)).refusal({.max_image_bytes = 16000}),
              HasSubstr("1 images take 16384 bytes decoded, but may take 16000 bytes"));
  const GltfBuilder two =
      with_maps({{"normalTexture", {{"index", 0}}}, {"occlusionTexture", {{"index", 1}}}});
  EXPECT_EQ(two.load({.max_image_bytes = 1000}).bitmaps.size(), 2u);
  EXPECT_THAT(two.refusal({.max_image_bytes = 15}), HasSubstr("2 images take"));
}

// A PNG of side x side pixels, nearly all black, whose header says 1 x 1.
Bytes png_that_inflates(int side) {
  Bytes pixels(size_t(side) * side * 3, 0);
  for (int i = 0; i < 1000; ++i) {
    pixels[i * 3] = static_cast<uint8_t>(i);
    pixels[i * 3 + 1] = i / 256;  // no palette
  }
  Bytes file = encode_png(side, side, 3, pixels);
  const Bytes header = png_header(1, 1);
  std::copy_n(header.begin(), 24, file.begin());
  return file;
}

TEST(GltfImage, data_that_inflates_to_far_more_than_the_header_says_is_refused) {
  const Bytes bomb = png_that_inflates(6000);  // 108 MB
  ASSERT_LT(bomb.size(), size_t(2) << 20);
  EXPECT_THAT(with_image(bomb).broken_images(), HasSubstr("more than 1 x 1 pixels need"));
}

// Two materials whose base colours are these two files.
GltfBuilder with_two_files(const Bytes& a, const Bytes& b) {
  GltfBuilder made = with_maps({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                {"occlusionTexture", {{"index", 1}}}});
  made.root["images"][0] = {{"bufferView", made.view(a)}, {"mimeType", "image/png"}, {"name", "a"}};
  made.root["images"][1] = {{"bufferView", made.view(b)}, {"mimeType", "image/png"}, {"name", "b"}};
  return made;
}

TEST(GltfImage, images_of_the_same_bytes_are_decoded_once) {
  const Bytes file = encode_png(2, 1, 3, {1, 2, 3, 4, 5, 6});
  const Scene same = with_two_files(file, file).load();
  EXPECT_EQ(same.bitmaps.size(), 1u);
  EXPECT_EQ(same.textures.size(), 2u) << "colours and data";
  EXPECT_EQ(with_two_files(file, encode_png(2, 1, 3, {1, 2, 3, 4, 5, 7})).load().bitmaps.size(), 2u);
}

// Colours are averaged in linear light: black and white become sRGB 188; data become 128 (127.5).
TEST(GltfImage, larger_images_than_the_texture_size_are_averaged_down) {
  const Bytes stripes = encode_png(4, 2, 3, {0,   0,   0,   255, 255, 255, 0,   0,   0,   255, 255, 255,
                                             255, 255, 255, 0,   0,   0,   255, 255, 255, 0,   0,   0});
  const Scene scene = with_two_files(stripes, stripes).load({.texture_side = 2});
  ASSERT_EQ(scene.bitmaps.size(), 2u) << "as colours and as data";
  for (const Bitmap& bitmap : scene.bitmaps)
    EXPECT_EQ(std::pair(bitmap.width, bitmap.height), std::pair(2, 1));
  EXPECT_THAT(scene.bitmaps[0].rgba, ElementsAre(188, 188, 188, 255, 188, 188, 188, 255));
  EXPECT_THAT(scene.bitmaps[1].rgba, ElementsAre(128, 128, 128, 255, 128, 128, 128, 255));
}

// 3 x 1 to 2 x 1: each pixel covers one and a half.
TEST(GltfImage, averages_are_by_area) {
  const Bytes file = encode_png(3, 1, 3, {30, 0, 0, 90, 3, 0, 240, 9, 0});
  const Scene scene = with_image(file).load({.texture_side = 2});
  EXPECT_THAT(scene.bitmaps.at(0).rgba, ElementsAre(50, 1, 0, 255, 190, 7, 0, 255));
}

TEST(GltfImage, too_much_memory_is_refused_before_decoding_with_the_size_that_fits) {
  const GltfBuilder made = with_two_files(png_header(4096, 4096), png_header(4096, 2048));
  const std::string refusal = made.refusal({.max_image_bytes = size_t(40) << 20});
  EXPECT_THAT(refusal, HasSubstr("made.gltf: 2 images take 96.0 MiB decoded, but may take 40.0 MiB"));
  EXPECT_THAT(refusal, HasSubstr("--texture-size 2048 fits (24.0 MiB)"));
  EXPECT_THAT(refusal, HasSubstr("--image-memory 97M allows them"));
}

TEST(GltfImage, more_memory_than_there_is_is_not_offered) {
  if (usable_memory() > uint64_t(74) << 30) GTEST_SKIP() << "the machine could hold these images (25 GiB)";
  GltfBuilder made = with_image({});
  for (int i = 0; i < 25; ++i) {
    made.root["images"][i] = {{"bufferView", made.view(png_header(32768, 8192 - i))},
                              {"mimeType", "image/png"}};
    made.root["textures"][i] = {{"source", i}};
    made.root["materials"][i] = {{"normalTexture", {{"index", i}}}};
    nlohmann::json& primitives = made.root["meshes"][0]["primitives"];
    primitives[i] = made.primitive();
    primitives[i]["material"] = i;
  }
  const std::string refusal = made.refusal({.texture_side = 32768, .max_image_bytes = 1 << 30});
  EXPECT_THAT(refusal, HasSubstr("25 images take 25.0 GiB decoded"));
  EXPECT_THAT(refusal, HasSubstr("--texture-size"));
  EXPECT_THAT(refusal, Not(HasSubstr("--image-memory")));
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
