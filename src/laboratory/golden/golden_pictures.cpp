#include "golden/golden_pictures.h"

#include <algorithm>
#include <bit>

#include "base/error.h"
#include "base/log.h"
#include "measures/flip.h"
#include "measures/metrics.h"

namespace lightgrid::lab {
namespace {

std::vector<ExrChannel> channels_of(const GoldenPixels& pixels) {
  std::vector<ExrChannel> channels;
  for (const auto& [name, channel] : {std::pair{"B", 2}, {"G", 1}, {"R", 0}}) {
    channels.push_back({name, false, {}});
    for (const glm::vec4& pixel : pixels.image.pixels)
      channels.back().words.push_back(std::bit_cast<uint32_t>(pixel[channel]));
  }
  channels.push_back({"depth", false, pixels.depth});
  channels.push_back({"lists", true, pixels.lists});
  channels.push_back({"triangles", true, pixels.triangles});
  return channels;
}

GoldenPixels pixels_of(const std::vector<ExrChannel>& channels, int width, int height) {
  GoldenPixels pixels;
  pixels.image = Image(width, height);
  const auto words_of = [&](const std::string& name, bool whole) -> const std::vector<uint32_t>& {
    const auto found = std::ranges::find(channels, name, &ExrChannel::name);
    if (found == channels.end() || found->whole != whole) throw input_error("has no channel {}", name);
    return found->words;
  };
  for (const auto& [name, channel] : {std::pair{"B", 2}, {"G", 1}, {"R", 0}}) {
    const std::vector<uint32_t>& words = words_of(name, false);
    for (size_t i = 0; i < words.size(); ++i)
      pixels.image.pixels[i][channel] = std::bit_cast<float>(words[i]);
  }
  pixels.depth = words_of("depth", false);
  pixels.lists = words_of("lists", true);
  pixels.triangles = words_of("triangles", true);
  return pixels;
}

}  // namespace

void save_golden_pixels(const std::filesystem::path& path, const GoldenPixels& pixels) {
  save_exr(path, pixels.image.width, pixels.image.height, channels_of(pixels));
}

std::optional<GoldenPixels> load_golden_pixels(const std::filesystem::path& path,
                                               const GoldenView& recorded) {
  if (!std::filesystem::exists(path)) return {};
  try {
    GoldenPixels pixels =
        pixels_of(load_exr(path, recorded.width, recorded.height), recorded.width, recorded.height);
    if (!first_difference(recorded, golden_view(pixels))) return pixels;
    log_warning("{}: its pixels are not those of the hashes; going on without", path.string());
  } catch (const Error& error) {
    log_warning("{}; going on without", error.what());
  }
  return {};
}

PicturePixel first_pixel(const GoldenPixels& recorded, const GoldenPixels& drawn, const GoldenView& view,
                         const GoldenDifference& difference) {
  const int left = difference.tile_x * view.tile, low = difference.tile_y * view.tile;
  const int high = std::min(view.height, low + view.tile) - 1;
  for (int y = high; y >= low; --y) {
    for (int x = left; x < std::min(view.width, left + view.tile); ++x) {
      if (!recorded.same(difference.stage, drawn, size_t(y) * size_t(view.width) + size_t(x)))
        return {x, flipped_row(y, view.height)};
    }
  }
  return {left, flipped_row(high, view.height)};  // no recorded pixels of these hashes
}

std::optional<DisplayedFlip> GoldenPictures::flip() const {
  if (!recorded) return {};
  return displayed_flip(drawn.image, recorded->image, exposure);
}

void GoldenPictures::save(const std::filesystem::path& folder, const std::string& name) const {
  const auto path = [&](const std::string& suffix) { return folder / (name + suffix); };
  const int width = drawn_view.width, height = drawn_view.height;
  save_golden_pixels(path(".drawn.exr"), drawn);
  save_png(path(".drawn.png"), drawn.image, exposure);
  Image differs(width, height);
  for (size_t i = 0; i < differs.pixels.size(); ++i) {
    const int x = int(i) % width, y = int(i) / width, tile = drawn_view.tile;
    const size_t hash = size_t(y / tile * drawn_view.across() + x / tile), stage = difference.stage;
    const bool same = recorded ? recorded->same(stage, drawn, i)
                               : recorded_view.stages[stage][hash] == drawn_view.stages[stage][hash];
    if (!same) differs.pixels[i] = glm::vec4(1);
  }
  save_png_as_is(path(std::string(".") + golden_stages[difference.stage] + ".png"), differs);
  if (!recorded) return;
  save_png(path(".expected.png"), recorded->image, exposure);
  save_png_as_is(path(".difference.png"), difference_image(drawn.image, recorded->image));
  save_png_as_is(path(".flip.png"),
                 flip_picture(displayed_flip_map(drawn.image, recorded->image, exposure), width, height));
}

}  // namespace lightgrid::lab
