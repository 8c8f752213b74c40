#include "measures/flip.h"

#include <gmock/gmock.h>
#include <tinyexr.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <sstream>

#include "support/paths.h"
#include "support/png_pixels.h"
#include "support/shared_files.h"

namespace lightgrid::lab {
namespace {

double linear_of_byte(uint8_t byte) {
  const double s = byte / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

Image png_image(const std::filesystem::path& path) {
  const PngPixels png = read_png(path);
  Image image(png.width, png.height);
  for (int y = 0; y < png.height; ++y) {
    for (int x = 0; x < png.width; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, png.height - 1 - y)[c] = float(linear_of_byte(png.at(x, y, c)));
    }
  }
  return image;
}

Image exr_image(const std::filesystem::path& path) {
  float* rgba = nullptr;
  int width = 0, height = 0;
  const char* why = nullptr;
  if (LoadEXR(&rgba, &width, &height, path.c_str(), &why) != TINYEXR_SUCCESS) return {};
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, height - 1 - y)[c] = rgba[4 * (size_t(y) * width + x) + c];
    }
  }
  std::free(rgba);
  return image;
}

// A line of values.csv by its heading's names.
using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  const auto fields_of = [](const std::string& text) {
    std::vector<std::string> fields;
    std::stringstream stream(text);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
  };
  std::getline(file, line);
  const std::vector<std::string> names = fields_of(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = fields_of(line);
    Row& row = rows.emplace_back();
    for (size_t i = 0; i < names.size(); ++i) row[names[i]] = fields[i];
  }
  return rows;
}

TEST(FlipOfTheAuthors, IsThatOfTheirProgram) {
  LIGHTGRID_NEEDS_SHARED("flip/values.csv");
  const std::filesystem::path folder = shared_folder() / "flip";
  const std::vector<Row> rows = rows_of(folder / "values.csv");
  ASSERT_EQ(rows.size(), 9u);
  const Image ldr = png_image(folder / "reference.png"), hdr = exr_image(folder / "reference.exr");
  const FlipExposures chosen = flip_exposures(hdr).value();
  for (const Row& row : rows) {
    const std::string name = row.at("kind") + " " + row.at("test") + " " + row.at("exposures");
    const auto number = [&](const char* key) { return std::stod(row.at(key)); };
    const double ppd = number("ppd");
    std::vector<float> map;
    if (row.at("kind") == "ldr") {
      map = flip_map(png_image(folder / (row.at("test") + ".png")), ldr, ppd);
    } else {
      FlipExposures exposures{number("start"), number("stop"), std::stoi(row.at("exposures"))};
      if (exposures.count == 9) {
        EXPECT_NEAR(chosen.start, exposures.start, 1e-4);
        EXPECT_NEAR(chosen.stop, exposures.stop, 1e-4);
        EXPECT_EQ(chosen.count, 9);
        exposures = chosen;
      }
      map = hdr_flip_map(exr_image(folder / (row.at("test") + ".exr")), hdr, exposures, ppd);
    }
    EXPECT_NEAR(mean_of(map), number("mean"), 1e-4) << name;
    EXPECT_NEAR(std::ranges::min(map), number("min"), 1e-4) << name;
    EXPECT_NEAR(std::ranges::max(map), number("max"), 1e-4) << name;
  }
}

// The middle of each is the pixel that the authors' program gives for the whole pictures, their largest one.
TEST(FlipOfTheAuthors, IsThatOfTheirProgramOnTheCommittedCases) {
  const std::filesystem::path folder =
      std::filesystem::path(source_folder) / "tests/laboratory/measures/flip";
  const size_t middle = 10 * 21 + 10;
  const Image ldr = png_image(folder / "reference.png"), hdr = exr_image(folder / "reference.exr");
  const Image ldr_test = png_image(folder / "test.png"), hdr_test = exr_image(folder / "test.exr");
  for (const Image* image : {&ldr, &hdr, &ldr_test, &hdr_test}) ASSERT_EQ(image->pixels.size(), 21u * 21u);
  EXPECT_NEAR(flip_map(ldr_test, ldr, 67)[middle], 0.164487, 1e-4);
  EXPECT_NEAR(hdr_flip_map(hdr_test, hdr, {-3, 4, 8}, 67)[middle], 0.145485, 1e-4);
  // Other filters give other values: the cases can tell.
  EXPECT_GT(std::abs(flip_map(ldr_test, ldr, 60)[middle] - 0.164487), 1e-3);
  EXPECT_GT(std::abs(hdr_flip_map(hdr_test, hdr, {-3, 4, 8}, 60)[middle] - 0.145485), 1e-3);
}

Image noise(int width, int height, uint32_t seed) {
  Image image(width, height);
  for (glm::vec4& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c)
      pixel[c] = float((seed = seed * 1664525u + 1013904223u) >> 8) / float(1 << 24);
  }
  return image;
}

TEST(Flip, OfEqualImagesIsZero) {
  for (const auto& [width, height] : {std::pair(1, 1), {17, 9}, {64, 1}}) {
    const Image image = noise(width, height, 7);
    EXPECT_EQ(std::ranges::max(flip_map(image, image)), 0.0f);
    EXPECT_EQ(std::ranges::max(hdr_flip_map(image, image, {-3, 3, 4})), 0.0f);
  }
}

// Flat images have no edges and no points. Green and blue are the pair that sets the scale of colour
// differences.
TEST(Flip, OfFlatImagesIsTheColourDifferenceAlone) {
  Image black(40, 40), green(40, 40), blue(40, 40);
  for (glm::vec4& pixel : green.pixels) pixel = {0, 1, 0, 1};
  for (glm::vec4& pixel : blue.pixels) pixel = {0, 0, 1, 1};
  const std::vector<float> map = flip_map(green, blue);
  EXPECT_NEAR(std::ranges::min(map), 1, 1e-6);
  EXPECT_NEAR(std::ranges::max(map), 1, 1e-6);
  EXPECT_GT(mean_of(flip_map(green, black)), 0.5);
}

TEST(Flip, MapAsDisplayedHasRow0AtTheBottom) {
  Image image(9, 5);
  const Image reference = image;
  image.at(7, 1) = glm::vec4(1);
  const std::vector<float> map = displayed_flip_map(image, reference, {});
  const auto worst = size_t(std::ranges::max_element(map) - map.begin());
  EXPECT_EQ(worst, size_t(1 * 9 + 7));
  const DisplayedFlip flip = displayed_flip(image, reference);
  EXPECT_NEAR(displayed_flip_of(map).mean, flip.mean, 1e-7);
  EXPECT_EQ(displayed_flip_of(map).visible, flip.visible);
}

TEST(Flip, CountsNanAsOne) {
  Image image = noise(9, 9, 1);
  const Image reference = image;
  image.at(4, 4).g = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> map = flip_map(image, reference);
  EXPECT_EQ(map[4 * 9 + 4], 1.0f);
  for (const float value : map) EXPECT_TRUE(value >= 0 && value <= 1);
}

TEST(Flip, HasNoExposuresForABlackReference) {
  EXPECT_FALSE(flip_exposures(Image(4, 4)));
  EXPECT_FALSE(flip_exposures(Image()));
}

// Changes that no byte shows are no difference; a pixel in four that turns from black to white is one.
TEST(Flip, AsDisplayedComparesTheBytesOfThePictures) {
  Image reference(8, 8), near = reference, far = reference;
  for (glm::vec4& pixel : near.pixels) pixel.r = 1e-5f;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) far.at(x, y) = glm::vec4(5);
  }
  EXPECT_EQ(displayed_flip(near, reference).mean, 0);
  EXPECT_EQ(displayed_flip(near, reference).visible, 0);
  EXPECT_GT(displayed_flip(near, reference, {.ev = 16}).visible, 0) << "exposed";
  EXPECT_GT(displayed_flip(far, reference).mean, 0.2);
  EXPECT_GE(displayed_flip(far, reference).visible, 0.25);
}

}  // namespace
}  // namespace lightgrid::lab
