#include "passes/shadows/shadow_lists.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "cl/transfer.h"
#include "passes/shadows/shadow_lights.h"
#include "plan/settings/shadows.h"
#include "renderer/upload/culler_input.h"
#include "renderer/upload/lights.h"
#include "shared/shadow_bits.h"

namespace lightgrid {
namespace {

CullerOptions options_of(const FramePlan& plan) {
  CullerOptions options = culler_options(plan);
  options.cull_test = default_cull_test;
  options.depth_bounds = DepthBoundsMode::minmax;
  options.tile = SHADOW_TILE;
  options.samples = 1;
  options.blend = false;
  options.index_bits = 0;
  options.lists = GridLists::lists;
  return options;
}

}  // namespace

void ShadowLists::look(PassContext& work, const std::vector<CullLight>& lights) {
  if (!culler_) culler_.emplace(*work.renderer.cl, *work.renderer.kernels, options_of(work.plan));
  if (lights != lights_) {
    culler_->set_lights(lights);
    lights_ = lights;
  }
  culler_->set_view(cull_view(work.view));
}

void ShadowLists::list(PassContext& work, std::span<const cl::Buffer> depths) {
  images_.resize(std::min(images_.size(), depths.size()));
  while (images_.size() < depths.size()) images_.push_back(std::make_unique<Image>(*work.renderer.cl));
  size_t entries = 0;
  for (size_t i = 0; i < depths.size(); ++i) {
    Image& image = *images_[i];
    image.grid = culler_->cull(culler_->depth_bounds({depths[i]}).opaque, image.storage);
    image.first_entry = entries;
    entries += image.grid.index_count;
  }
  if (entries > 0xffffffffu) throw machine_error("shadows: more than 2^32 pairs of a tile and a light");
}

size_t ShadowLists::tiles() const {
  return size_t(images_[0]->grid.cells_x) * size_t(images_[0]->grid.cells_y);
}

size_t ShadowLists::pairs() const {
  size_t pairs = 0;
  for (const auto& image : images_) pairs += image->grid.index_count;
  return pairs;
}

size_t ShadowLists::bytes() const {
  size_t bytes = 0;
  for (const auto& image : images_) bytes += image->grid.cell_bytes + image->grid.index_bytes;
  return bytes;
}

HostGrid ShadowLists::read(ClDevice& device, size_t image) {
  return read_grid(device, images_[image]->grid, images_[image]->storage);
}

ShadowBands ShadowLists::bands(PassContext& work, ShadowRoom& room) {
  const FramePlan& plan = work.plan;
  const size_t max_bytes = plan.settings[setting::shadow_memory], entry = shadow_entry_bytes(plan),
               words = shadow_table_words(plan) * images();
  const auto most = [&](GLenum format) {
    return plan.opengl ? max_texture_bytes(format) : std::numeric_limits<size_t>::max();
  };
  room = {tiles(), shadow_table_bytes(tiles(), words), pairs() * entry};
  if (room.table_bytes + room.bit_bytes <= max_bytes && room.table_bytes <= most(GL_RG32UI) &&
      room.bit_bytes <= most(GL_R32UI))
    return {{{0, tiles(), pairs()}}, {}};
  room = shadow_room(tiles(), words, size_t(std::ranges::count(plan.shadows.shadowed, 1)) * images(), entry,
                     max_bytes, most(GL_RG32UI), most(GL_R32UI));
  std::vector<std::vector<glm::uvec2>> listed;
  std::vector<glm::uvec2> together(tiles());
  for (size_t i = 0; i < images(); ++i) {
    auto& here = listed.emplace_back(tiles());
    read_buffer(*work.renderer.cl, "reading lists of shadows", cells(i), here.data(),
                here.size() * sizeof here[0]);
    for (size_t tile = 0; tile < tiles(); ++tile) together[tile].y += here[tile].y;
  }
  ShadowBands bands = shadow_bands(together, room, entry);
  for (size_t i = 1; i < images(); ++i) {
    for (size_t tile = 0; tile < tiles(); ++tile)
      bands.first_entries.push_back(bands.first_entries[(i - 1) * tiles() + tile] + listed[i - 1][tile].y);
  }
  return bands;
}

}  // namespace lightgrid
