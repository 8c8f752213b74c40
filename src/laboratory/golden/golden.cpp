#include "golden/golden.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <functional>

#include "accuracy/oracle.h"
#include "accuracy/surfaces_in_double.h"
#include "base/error.h"

namespace lightgrid::lab {
namespace {

// FNV-1a with a word a step. A pixel has the lower half of a hash.
struct Hash {
  uint64_t value = 0xcbf29ce484222325;
  void add(uint64_t word) {
    value = (value ^ word) * 0x100000001b3;
    value ^= value >> 32;
  }
};

constexpr size_t max_tiles = 64;

std::vector<std::string> hash_tiles(const GoldenView& view,
                                    const std::function<void(Hash& hash, size_t pixel)>& add) {
  std::vector<std::string> hashes;
  for (int ty = 0; ty < view.down(); ++ty) {
    for (int tx = 0; tx < view.across(); ++tx) {
      Hash hash;
      for (int y = ty * view.tile; y < std::min(view.height, (ty + 1) * view.tile); ++y)
        for (int x = tx * view.tile; x < std::min(view.width, (tx + 1) * view.tile); ++x)
          add(hash, size_t(y) * size_t(view.width) + size_t(x));
      hashes.push_back(fmt::format("{:016x}", hash.value));
    }
  }
  return hashes;
}

// The hash of each cell's list, in the order in which its lights are summed.
std::vector<uint32_t> hashes_of_lists(const ListedLights& lists) {
  std::vector<uint32_t> hashes;
  for (size_t cell = 0; cell < lists.count.size(); ++cell) {
    Hash hash;
    for (uint32_t i = 0; i < lists.count[cell]; ++i) hash.add(lists.indices[lists.first[cell] + i]);
    hash.add(lists.count[cell]);
    hashes.push_back(uint32_t(hash.value));
  }
  return hashes;
}

uint32_t hash_of(const SceneTriangle& triangle) {
  Hash hash;
  hash.add(uint32_t(triangle.instance));
  for (const uint32_t vertex : triangle.vertices) hash.add(vertex);
  return uint32_t(hash.value);
}

}  // namespace

bool GoldenPixels::same(size_t stage, const GoldenPixels& other, size_t pixel) const {
  const auto bits = [pixel](const Image& image) {
    return std::bit_cast<std::array<uint32_t, 3>>(glm::vec3(image.pixels[pixel]));
  };
  switch (stage) {
    case 0:
      return triangles[pixel] == other.triangles[pixel];
    case 1:
      return depth[pixel] == other.depth[pixel];
    case 2:
      return lists[pixel] == other.lists[pixel];
    default:
      return bits(image) == bits(other.image);
  }
}

GoldenPixels golden_pixels(TechniqueRun& run) {
  const std::vector<float> depth = read_depth(run);
  const ListedLights lists = listed_lights(run, depth);
  const std::vector<uint32_t> of_lists = hashes_of_lists(lists);
  GoldenPixels pixels;
  pixels.image = run.image();
  for (const SceneTriangle& triangle : shown_triangles(run)) pixels.triangles.push_back(hash_of(triangle));
  for (size_t pixel = 0; pixel < depth.size(); ++pixel) {
    const uint32_t cell = lists.cell_of_pixel.empty() ? 0 : lists.cell_of_pixel[pixel];
    pixels.depth.push_back(std::bit_cast<uint32_t>(depth[pixel]));
    pixels.lists.push_back(depth[pixel] != 0 && cell < of_lists.size() ? of_lists[cell] : 0);
  }
  return pixels;
}

GoldenView golden_view(const GoldenPixels& pixels) {
  const Image& image = pixels.image;
  GoldenView view{.width = image.width, .height = image.height, .stages = {}};
  while (size_t(view.across()) * size_t(view.down()) > max_tiles) view.tile *= 2;
  size_t stage = 0;
  for (const std::vector<uint32_t>* words : {&pixels.triangles, &pixels.depth, &pixels.lists})
    view.stages[stage++] = hash_tiles(view, [&](Hash& hash, size_t pixel) { hash.add((*words)[pixel]); });
  view.stages[stage] = hash_tiles(view, [&](Hash& hash, size_t pixel) {
    for (int channel = 0; channel < 3; ++channel)
      hash.add(std::bit_cast<uint32_t>(image.pixels[pixel][channel]));
  });
  return view;
}

std::optional<GoldenDifference> first_difference(const GoldenView& recorded, const GoldenView& drawn) {
  if (recorded.width != drawn.width || recorded.height != drawn.height || recorded.tile != drawn.tile)
    throw input_error("width {}, height {}, tile {}: the view that is drawn has {}, {} and {}",
                      recorded.width, recorded.height, recorded.tile, drawn.width, drawn.height, drawn.tile);
  for (size_t stage = 0; stage < golden_stages.size(); ++stage) {
    const std::vector<std::string>&a = recorded.stages[stage], &b = drawn.stages[stage];
    const auto first = size_t(std::ranges::mismatch(a, b).in1 - a.begin());
    if (first == a.size()) continue;
    GoldenDifference found{stage, int(first) % drawn.across(), int(first) / drawn.across(), 0};
    for (size_t i = first; i < a.size(); ++i) found.tiles += a[i] != b[i];
    return found;
  }
  return {};
}

// A string for a row of tiles.
nlohmann::ordered_json to_json(const GoldenView& view) {
  nlohmann::ordered_json object = {{"width", view.width}, {"height", view.height}, {"tile", view.tile}};
  for (size_t stage = 0; stage < golden_stages.size(); ++stage) {
    auto row = view.stages[stage].begin();
    for (int y = 0; y < view.down(); ++y, row += view.across())
      object[golden_stages[stage]].push_back(fmt::format("{}", fmt::join(row, row + view.across(), " ")));
  }
  return object;
}

GoldenView golden_view(const JsonFields& fields) {
  std::vector<std::string> known = {"width", "height", "tile"};
  known.insert(known.end(), golden_stages.begin(), golden_stages.end());
  fields.check_fields(known);
  GoldenView view{fields.whole("width", 1), fields.whole("height", 1), fields.whole("tile", 1), {}};
  if (view.width > 16384 || view.height > 16384) throw input_error("width or height: more than 16384");
  for (size_t stage = 0; stage < golden_stages.size(); ++stage) {
    const nlohmann::json& rows = fields.at(golden_stages[stage]);
    if (!rows.is_array()) throw input_error("{}: is not a list", golden_stages[stage]);
    for (const nlohmann::json& row : rows) {
      if (!row.is_string()) throw input_error("{}: a row is not a text", golden_stages[stage]);
      const std::string& text = row.get_ref<const std::string&>();
      for (size_t at = 0; at <= text.size(); at += 17) view.stages[stage].push_back(text.substr(at, 16));
    }
    for (const std::string& hash : view.stages[stage]) {
      if (hash.size() != 16 || hash.find_first_not_of("0123456789abcdef") != std::string::npos)
        throw input_error("{}: \"{}\" is not 16 hexadecimal digits", golden_stages[stage], hash);
    }
    const size_t tiles = size_t(view.across()) * size_t(view.down());
    if (view.stages[stage].size() != tiles)
      throw input_error("{}: {} hashes, not one for each of {} tiles", golden_stages[stage],
                        view.stages[stage].size(), tiles);
  }
  return view;
}

}  // namespace lightgrid::lab
