#include <gmock/gmock.h>
#include <png.h>
#include <tinyexr.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

#include "base/error.h"
#include "base/image.h"
#include "base/write_file.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<uint8_t> decoded_png(const std::vector<uint8_t>& file, int channels) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&png, file.data(), file.size())) << png.message;
  png.format = channels == 1 ? PNG_FORMAT_GRAY : channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  std::vector<uint8_t> bytes(PNG_IMAGE_SIZE(png));
  EXPECT_TRUE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr)) << png.message;
  return bytes;
}

std::vector<uint8_t> noise(size_t size, int distinct) {
  std::vector<uint8_t> bytes(size);
  uint32_t state = 1;
  for (auto& byte : bytes)
    byte = static_cast<uint8_t>(((state = state * 1664525u + 1013904223u) >> 24) % distinct);
  return bytes;
}

std::vector<uint8_t> content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Image gradient(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at(x, y) = glm::vec4(x * 0.25f, y * 0.5f, x - 3.5f * y, 1);
  }
  return image;
}

TEST(EncodePng, GivesBackTheBytesOfAwkwardSizes) {
  for (auto [width, height] : {std::pair{1, 1}, {17, 9}, {129, 65}}) {
    for (int channels : {1, 3, 4}) {
      for (int distinct : {2, 256}) {  // with a palette and without
        const auto bytes = noise(size_t(width) * height * channels, distinct);
        EXPECT_EQ(decoded_png(encode_png(width, height, channels, bytes), channels), bytes)
            << width << "x" << height << ", " << channels << " channels, " << distinct << " values";
      }
    }
  }
}

TEST(EncodePng, PaletteHoldsExactly256ColoursAnd257GoWithout) {
  std::vector<uint8_t> bytes;
  for (int i = 0; i < 256; ++i) bytes.insert(bytes.end(), {uint8_t(i), uint8_t(i), 7});
  EXPECT_EQ(decoded_png(encode_png(256, 1, 3, bytes), 3), bytes);
  bytes.insert(bytes.end(), {1, 2, 3});
  EXPECT_EQ(decoded_png(encode_png(257, 1, 3, bytes), 3), bytes);
}

TEST(EncodePng, IsTheSameEachTime) {
  const auto bytes = noise(64 * 64 * 3, 256);
  EXPECT_EQ(encode_png(64, 64, 3, bytes), encode_png(64, 64, 3, bytes));
}

TEST(SaveExr, KeepsEveryFloatIncludingNanAndInfinity) {
  const TempFolder folder;
  auto image = gradient(17, 9);
  image.at(3, 0) =
      glm::vec4(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e-40f, 1);
  save_exr(folder.path / "a.exr", image);

  float* loaded = nullptr;
  int width = 0, height = 0;
  const char* why = nullptr;
  ASSERT_EQ(LoadEXR(&loaded, &width, &height, (folder.path / "a.exr").c_str(), &why), TINYEXR_SUCCESS) << why;
  ASSERT_EQ(width, 17);
  ASSERT_EQ(height, 9);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float* pixel = &loaded[4 * (size_t(height - 1 - y) * width + x)];
      for (int c = 0; c < 3; ++c) {
        const float expected = image.at(x, y)[c];
        EXPECT_TRUE(pixel[c] == expected || (std::isnan(pixel[c]) && std::isnan(expected))) << x << "," << y;
      }
    }
  }
  std::free(loaded);
}

std::vector<ExrChannel> channels_of(int width, int height) {
  std::vector<ExrChannel> channels = {{"R", false, {}}, {"depth", false, {}}, {"lists", true, {}}};
  for (ExrChannel& channel : channels) {
    for (int i = 0; i < width * height; ++i) channel.words.push_back(uint32_t(i) * 0x9e3779b9u);
  }
  return channels;
}

TEST(LoadExr, ReadsTheBitsThatWereSaved) {
  const TempFolder folder;
  for (const auto& [width, height] : {std::pair{17, 9}, {1, 1}, {33, 65}}) {
    const auto saved = channels_of(width, height);
    save_exr(folder.path / "a.exr", width, height, saved);
    const auto loaded = load_exr(folder.path / "a.exr", width, height);
    ASSERT_EQ(loaded.size(), saved.size());
    for (size_t c = 0; c < saved.size(); ++c) {
      EXPECT_EQ(loaded[c].name, saved[c].name);
      EXPECT_EQ(loaded[c].whole, saved[c].whole);
      EXPECT_EQ(loaded[c].words, saved[c].words);
    }
    EXPECT_THROW(load_exr(folder.path / "a.exr", width + 1, height), Error);
  }
}

TEST(LoadExr, RefusesBrokenFiles) {
  const TempFolder folder;
  save_exr(folder.path / "a.exr", 33, 20, channels_of(33, 20));
  const std::vector<uint8_t> right = content(folder.path / "a.exr");
  const auto refused = [&](const std::vector<uint8_t>& bytes) {
    write_file(folder.path / "broken.exr", bytes);
    try {
      load_exr(folder.path / "broken.exr", 33, 20);
      return false;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return true;
    }
  };
  for (size_t size = 0; size < right.size(); size += 1 + size / 16)
    EXPECT_TRUE(refused({right.begin(), right.begin() + ptrdiff_t(size)})) << size;
  // A changed byte may leave a file with other pixels, but ends neither the program nor in another error.
  size_t refusals = 0;
  for (size_t at = 0; at < std::min<size_t>(right.size(), 600); ++at) {
    std::vector<uint8_t> bytes = right;
    bytes[at] ^= uint8_t(1u << at % 8);
    refusals += refused(bytes);
  }
  EXPECT_GT(refusals, 20u);
}

TEST(SaveImage, ChoosesByExtensionWhateverItsCase) {
  const TempFolder folder;
  save_image(folder.path / "a.PNG", gradient(2, 2));
  save_image(folder.path / "a.exr", gradient(2, 2));
  EXPECT_EQ(content(folder.path / "a.PNG")[1], 'P');
  EXPECT_EQ(content(folder.path / "a.exr")[0], 0x76);
}

TEST(SaveImage, RefusesOtherExtensionsNamingThem) {
  EXPECT_THAT(error_of([&] { save_image("picture.jpg", gradient(1, 1)); }), HasSubstr("picture.jpg"));
  EXPECT_THROW(save_image("picture", gradient(1, 1)), Error);
}

TEST(SavePng, ReplacesWhatWasThereAndLeavesNothingElse) {
  const TempFolder folder;
  const auto path = folder.path / "a.png";
  std::ofstream(path) << "old";
  save_png(path, gradient(3, 2));
  EXPECT_EQ(content(path), encode_png(3, 2, 3, srgb_bytes(gradient(3, 2))));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), {}), 1);
}

TEST(SavePng, SaysWhichFolderIsMissing) {
  const TempFolder folder;
  EXPECT_THAT(error_of([&] { save_png(folder.path / "none" / "a.png", gradient(1, 1)); }),
              HasSubstr((folder.path / "none" / "a.png").string()));
}

TEST(SavePng, RefusesAFolder) {
  const TempFolder folder;
  EXPECT_THROW(save_png(folder.path, gradient(1, 1)), Error);
  EXPECT_TRUE(fs::is_directory(folder.path));
}

TEST(SavePng, SaysThatTheDiskIsFullAndLeavesTheDeviceThere) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THAT(error_of([&] { save_png("/dev/full", gradient(1, 1)); }, ErrorKind::machine),
              HasSubstr("/dev/full"));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(SavePng, ReplacesALinkRatherThanWhatItPointsTo) {
  const TempFolder folder;
  std::ofstream(folder.path / "elsewhere") << "keep";
  fs::create_symlink(folder.path / "elsewhere", folder.path / "a.png");
  save_png(folder.path / "a.png", gradient(1, 1));
  EXPECT_THAT(content(folder.path / "elsewhere"), ElementsAre('k', 'e', 'e', 'p'));
  EXPECT_FALSE(fs::is_symlink(folder.path / "a.png"));
}

}  // namespace
}  // namespace lightgrid
