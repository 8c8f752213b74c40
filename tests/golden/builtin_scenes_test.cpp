// The built-in scenes against images in assets/golden (docs/testing.md). UPDATE_GOLDEN=1 rewrites them.
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/image.h"
#include "base/write_file.h"
#include "scenes/builtin.h"
#include "support/paths.h"
#include "support/render.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;

constexpr int width = 320, height = 180;

// Tolerances for another vector width or Mesa: docs/testing.md has the measurements.
constexpr double allowed_mean = 0.05;        // steps of 255, over all channels
constexpr int allowed_step = 2;              // steps of 255 in a channel
constexpr double allowed_share_off = 0.002;  // share of pixels that may differ more, at edges of triangles,
constexpr int allowed_beyond = 18;           // but by no more than this past their neighbours: steps of 255

using Bytes = std::vector<uint8_t>;

// RGB, row 0 at the top; empty where the file is missing, broken or of another size.
Bytes load_golden(const fs::path& path) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&header, path.c_str())) return {};
  header.format = PNG_FORMAT_RGB;
  Bytes bytes(PNG_IMAGE_SIZE(header));
  const bool right_size = header.width == width && header.height == height;
  if (!png_image_finish_read(&header, nullptr, bytes.data(), 0, nullptr) || !right_size) return {};
  return bytes;
}

struct Difference {
  double mean = 0, share_off = 0;
  int largest = 0, beyond = 0;
  Bytes picture;  // each channel's difference, eight times as bright
};

// How far a channel lies outside the range of the expected image's pixels within one pixel. At an edge,
// rasterisers may disagree about which of two surfaces a pixel shows; none may show a third.
int beyond_neighbours(const Bytes& actual, const Bytes& expected, int x, int y, int channel) {
  int low = 255, high = 0;
  for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
      const int value = expected[(size_t(v) * width + u) * 3 + channel];
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  const int value = actual[(size_t(y) * width + x) * 3 + channel];
  return std::max({low - value, value - high, 0});
}

Difference difference_of(const Bytes& actual, const Bytes& expected) {
  Difference d;
  d.picture.resize(actual.size());
  size_t pixels_off = 0;
  for (size_t i = 0; i < actual.size(); i += 3) {
    int of_pixel = 0;
    for (size_t c = i; c < i + 3; ++c) {
      const int apart = std::abs(int(actual[c]) - int(expected[c]));
      d.mean += apart;
      d.picture[c] = uint8_t(std::min(255, 8 * apart));
      of_pixel = std::max(of_pixel, apart);
      const int x = int(i / 3) % width, y = int(i / 3) / width;
      d.beyond = std::max(d.beyond, beyond_neighbours(actual, expected, x, y, int(c - i)));
    }
    d.largest = std::max(d.largest, of_pixel);
    pixels_off += of_pixel > allowed_step;
  }
  d.mean /= double(actual.size());
  d.share_off = double(pixels_off) / (actual.size() / 3);
  return d;
}

class GoldenImage : public testing::TestWithParam<std::tuple<const char*, const char*>> {
};  // scene, technique

TEST_P(GoldenImage, IsWhatTheSceneLooksLike) {
  const auto [scene_name, technique] = GetParam();
  const std::string name =
      scene_name + std::string(technique == std::string("forward_plus") ? "" : std::string(".") + technique);
  const fs::path golden = fs::path(source_folder) / "assets/golden" / (name + ".png");
  const Scene scene = find_builtin_scene(scene_name)->make();
  const View view = make_view(choose_camera(scene, ""), width, height);
  const Bytes actual = srgb_bytes(render_image(scene, view, technique));
  const Bytes actual_png = encode_png(width, height, 3, actual);
  if (const char* update = std::getenv("UPDATE_GOLDEN"); update && std::string(update) == "1") {
    write_file(golden, actual_png);
    GTEST_SKIP() << "wrote " << golden;
  }
  const Bytes expected = load_golden(golden);
  ASSERT_EQ(expected.size(), actual.size()) << golden << " is missing or no image of " << width << "x"
                                            << height << "; UPDATE_GOLDEN=1 makes it (docs/testing.md)";
  const Difference d = difference_of(actual, expected);
  const bool near_enough = d.share_off <= allowed_share_off && d.beyond <= allowed_beyond;
  const bool equal = d.mean <= allowed_mean && near_enough;
  if (!equal) {
    const fs::path folder = fs::path(test_output_folder) / "golden";
    make_folder(folder);
    write_file(folder / (name + ".actual.png"), actual_png);
    write_file(folder / (name + ".expected.png"), encode_png(width, height, 3, expected));
    write_file(folder / (name + ".difference.png"), encode_png(width, height, 3, d.picture));
    const Renderer& devices = software_devices();
    const std::string device =
        devices.gl->renderer + ", " + devices.gl->version + "\n" + devices.cl->info().name + "\n";
    write_file(folder / (name + ".device.txt"), device);
    ADD_FAILURE() << "mean " << d.mean << " (allowed " << allowed_mean << "), off by more than "
                  << allowed_step << ": " << d.share_off << " of pixels (allowed " << allowed_share_off
                  << "), largest " << d.largest << ", beyond the neighbours by " << d.beyond << " (allowed "
                  << allowed_beyond << ")\non " << device << "see " << folder / (name + ".*.png");
  }
}

constexpr auto name_of_scene = [](const auto& info) { return std::string(std::get<0>(info.param)); };
INSTANTIATE_TEST_SUITE_P(Of, GoldenImage,
                         testing::Combine(testing::Values("hall", "spheres", "terrain", "street", "gallery"),
                                          testing::Values("forward_plus")),
                         name_of_scene);
// Without gallery, which would only compile a further variant of its largest kernels: passes/resolve_test has
// skin and Minnaert.
INSTANTIATE_TEST_SUITE_P(Visibility, GoldenImage,
                         testing::Combine(testing::Values("hall", "spheres", "terrain", "street"),
                                          testing::Values("visibility")),
                         name_of_scene);

}  // namespace
}  // namespace lightgrid
