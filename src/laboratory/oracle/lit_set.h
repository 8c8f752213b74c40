// Which lights reach which points, pixel by pixel or by blocks of pixels: the oracle for light lists.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/host_shadows.h"
#include "scene/listed_lights.h"
#include "scene/view_lights.h"

namespace lightgrid::lab {

// Nearer than the radius and, for a spot, at less than the outer angle from its axis: exactly where
// attenuation() with its window is positive. The boundary is not lit. Directional lights have no range.
// mask: of the surface there, which has to share a bit with that of the light (scene/effect_terms.h).
bool is_lit(const ViewLight& light, const glm::dvec3& position, uint32_t mask = full_mask);

// Ascending indices.
std::vector<uint32_t> lit_lights(const std::vector<ViewLight>& lights, const glm::dvec3& position);

// (pixel, light) pairs over the covered pixels (depth > 0). Listed counts list entries. Wrong counts entries
// that are no light (index or list out of range) or occur earlier in the list, plus one for a cell out of
// range.
struct LitPairs {
  std::vector<uint32_t> listed_of_pixel, lit_of_pixel, lost_of_pixel;  // width * height; 0 where not covered
  uint64_t listed = 0, lit = 0;
  uint64_t lost = 0;  // lit but not listed
  uint64_t wrong = 0;
  // With shadows, at the pixels where they were decided: pairs in range that are hidden; listed and shaded
  // though hidden; shaded as hidden though seen; pairs in range whose sight turns on rounding, which are not
  // counted as lit, lost or any of these. Directional lights count here alone.
  std::vector<uint32_t> hidden_of_pixel, leaked_of_pixel, acned_of_pixel;  // as above; empty without shadows
  uint64_t hidden = 0, leaked = 0, acned = 0, either = 0;
};

class SeenPairs;

// The shadows of pairs: according to the oracle, and as a frame shaded them (null: unhidden).
struct PairShadows {
  const SeenPairs& truth;
  const HostShadows* shaded = nullptr;
  uint32_t directional = 0;  // lights, which both of these number after those of the lists
};

// `depth` is the buffer that the technique shaded from: width * height, row 0 at the bottom, 0 for
// background. `lights` are the lights that the lists index: omit directional ones if the lists do. Every pair
// is decided by is_lit on positions in double. 1280 x 720 with 1024 lights takes about a second on two cores.
// With shadows, lit pairs are also seen, wherever that was decided. masks: of the surface at each pixel;
// empty: full masks.
LitPairs count_pairs(const View& view, const std::vector<float>& depth, const std::vector<ViewLight>& lights,
                     const ListedLights& lists, const PairShadows* shadows = nullptr,
                     std::span<const uint32_t> masks = {});

// Empty, or a fault of lists (first and count of each) in one array of indices: they must be adjacent without
// gap or overlap, in any order, each sorted without repetition, and contain valid lights.
std::string malformed_lists(std::span<const glm::uvec2> lists, std::span<const uint32_t> indices,
                            size_t lights);

// The lit set of an image, by blocks of pixels. The oracle runs once; the lists of many settings are then
// compared with its result.
struct LitBlocks {
  static constexpr int side = 8;  // every tile size is a multiple
  struct Entry {
    uint32_t light, pixels;  // how many of the block's covered pixels it lights, at least 1
  };
  int blocks_x = 0, blocks_y = 0;  // x fastest, then y from the bottom
  std::vector<uint32_t> covered;   // pixels that show a surface, a block
  std::vector<std::vector<Entry>> lit;
};

// As count_pairs: `depth` is width * height, row 0 at the bottom, 0 for background; is_lit decides.
LitBlocks find_lit_blocks(const View& view, const std::vector<float>& depth,
                          const std::vector<ViewLight>& lights);

// (pixel, light) pairs over the covered pixels, and their distribution over the tiles.
struct ListAccuracy {
  uint64_t listed = 0, lit = 0;
  uint64_t lost = 0;          // lit but not listed
  uint64_t perfect = 0;       // listed, if each tile listed only the lights that light one of its pixels
  uint64_t tiles_lit = 0;     // tiles with a lit pair
  uint64_t tiles_unlit = 0;   // tiles that list lights, none of which lights a pixel
  double p99 = 0, worst = 0;  // listed / lit of a tile, over tiles_lit
};

// `tile` is a multiple of LitBlocks::side; lists.first and .count hold one cell a tile, x fastest, then y
// from the bottom. cell_of_pixel is not read.
ListAccuracy measure_lists(const LitBlocks& blocks, int tile, const ListedLights& lists);

}  // namespace lightgrid::lab
