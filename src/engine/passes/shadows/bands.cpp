#include "passes/shadows/bands.h"

#include <array>

#include "base/error.h"
#include "cl/error.h"
#include "shared/shadow_bits.h"

namespace lightgrid {
namespace {

size_t tiles_in(size_t bytes, size_t words) { return (bytes / sizeof(cl_uint2) - 1) / words - 1; }

// Pixels, from the lower left.
struct Rectangle {
  size_t x, y, width, height;
};

// A band's tiles: the end of a row of tiles, whole rows, and the beginning of another.
std::vector<Rectangle> rectangles_of(const ShadowBand& band, const PixelGrid& grid) {
  const size_t width = size_t(grid.width), height = size_t(grid.height),
               across = (width + SHADOW_TILE - 1) / SHADOW_TILE;
  std::vector<Rectangle> all;
  for (size_t tile = band.first, end = band.first + band.tiles; tile < end;) {
    const size_t column = tile % across, row = tile / across;
    const size_t rows = column == 0 ? std::max<size_t>((end - tile) / across, 1) : 1;
    const size_t columns = std::min(across - column, end - tile);
    const size_t x = column * SHADOW_TILE, y = row * SHADOW_TILE;
    all.push_back(
        {x, y, std::min(columns * SHADOW_TILE, width - x), std::min(rows * SHADOW_TILE, height - y)});
    tile += rows == 1 ? columns : rows * across;
  }
  return all;
}

void copy_rectangles(PassContext& work, const ShadowBand& band, const cl::Buffer& from,
                     const cl::Buffer& to) {
  constexpr const char* what = "copying a band of the image";
  constexpr size_t pixel = sizeof(cl_float4);
  const size_t pitch = size_t(work.grid().width) * pixel;
  for (const Rectangle& r : rectangles_of(band, work.grid())) {
    const std::array<size_t, 3> at{r.x * pixel, r.y, 0}, size{r.width * pixel, r.height, 1};
    try {
      work.renderer.cl->queue().enqueueCopyBufferRect(from, to, at, at, size, pitch, 0, pitch, 0, nullptr,
                                                      work.renderer.cl->profiler().event(what));
    } catch (const cl::Error& error) {
      throw cl_machine_error(error, what);
    }
  }
}

void copy_rectangles(PassContext& work, const ShadowBand& band, GLuint from, GLuint to) {
  glDisable(GL_SCISSOR_TEST);
  for (const Rectangle& r : rectangles_of(band, work.grid())) {
    const GLint x = GLint(r.x), y = GLint(r.y), right = GLint(r.x + r.width), top = GLint(r.y + r.height);
    glBlitNamedFramebuffer(from, to, x, y, right, top, x, y, right, top, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
}

GLuint kept_in_gl(PassContext& work) {
  return work.targets.framebuffer({work.targets.texture("image of bands", GL_RGBA32F)}, 0);
}

}  // namespace

size_t shadow_table_bytes(size_t tiles, size_t words) { return (1 + (tiles + 1) * words) * sizeof(cl_uint2); }

ShadowRoom shadow_room(size_t tiles, size_t words, size_t lights, size_t entry_bytes, size_t max_bytes,
                       size_t max_table, size_t max_bits) {
  const size_t min_bits = lights * entry_bytes,
               needed = std::max(shadow_table_bytes(1, words) + min_bits, 2 * shadow_table_bytes(1, words));
  if (needed > max_bytes)
    throw input_error(
        "shadows: a tile with {} lights that cast needs {} bytes, more than shadow-memory allows ({}); raise "
        "shadow-memory, or let fewer lights cast",
        lights, needed, max_bytes);
  if (shadow_table_bytes(1, words) > max_table || min_bits > max_bits)
    throw input_error(
        "shadows: a tile with {} lights that cast needs a table of {} bytes and bits of {}, more than the "
        "device allows ({} and {}); let fewer lights cast",
        lights, shadow_table_bytes(1, words), min_bits, max_table, max_bits);
  ShadowRoom room;
  const size_t whole = shadow_table_bytes(tiles, words), half = std::min(max_bytes / 2, max_table);
  room.tiles = whole <= half ? tiles : tiles_in(half, words);
  room.table_bytes = shadow_table_bytes(room.tiles, words);
  room.bit_bytes = std::min(max_bytes - room.table_bytes, max_bits);
  if (room.bit_bytes >= min_bits) return room;
  // Half of the memory does not suffice for the bits of one tile.
  room.tiles = std::min(room.tiles, tiles_in(max_bytes - min_bits, words));
  room.table_bytes = shadow_table_bytes(room.tiles, words);
  room.bit_bytes = std::min(max_bytes - room.table_bytes, max_bits);
  return room;
}

ShadowBands shadow_bands(std::span<const glm::uvec2> cells, const ShadowRoom& room, size_t entry_bytes) {
  ShadowBands all;
  const size_t max_entries = room.bit_bytes / entry_bytes;
  for (size_t tile = 0; tile < cells.size(); ++tile) {
    ShadowBand* band = all.bands.empty() ? nullptr : &all.bands.back();
    if (!band || band->tiles == room.tiles || band->entries + cells[tile].y > max_entries)
      band = &all.bands.emplace_back(ShadowBand{tile});
    all.first_entries.push_back(uint32_t(band->entries));
    ++band->tiles;
    band->entries += cells[tile].y;
  }
  return all;
}

void BandedImage::keep(PassContext& work, const ShadedImage& image, const ShadowBand& band) {
  if (image.in_cl) {
    const cl::Buffer& kept = in_cl_.at_least(*work.renderer.cl, work.grid().pixels() * sizeof(cl_float4));
    return copy_rectangles(work, band, image.in_cl->cl_buffer(), kept);
  }
  copy_rectangles(work, band, image.framebuffer, kept_in_gl(work));
}

void BandedImage::restore(PassContext& work, const ShadedImage& image, std::span<const ShadowBand> bands) {
  for (const ShadowBand& band : bands) {
    if (image.in_cl)
      copy_rectangles(work, band, in_cl_.get(), image.in_cl->cl_buffer());
    else
      copy_rectangles(work, band, kept_in_gl(work), image.framebuffer);
  }
}

}  // namespace lightgrid
