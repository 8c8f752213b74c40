// A frame's shadows, for the oracle: drawn once more by the same shader code, one light after the other.
#include <fmt/format.h>
#include <algorithm>

#include "passes/light_index/index_shadows.h"
#include "plan/settings/shadows.h"

namespace lightgrid {
namespace {

// Draws one light's shares into the bound framebuffer, and reads those in the rectangle.
std::vector<uint8_t> draw_shares(const PixelGrid& grid, const GlProgram& program, const LightVolume& volume) {
  const glm::ivec2 size = volume.end - volume.first;
  glViewport(0, 0, grid.width, grid.height);
  glEnable(GL_SCISSOR_TEST);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glUseProgram(program.name());
  glUniform1ui(program.uniform("light"), volume.light);
  glScissor(volume.first.x, volume.first.y, size.x, size.y);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<uint8_t> shares(size_t(size.x) * size_t(size.y));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(volume.first.x, volume.first.y, size.x, size.y, GL_RED, GL_UNSIGNED_BYTE, shares.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  return shares;
}

struct TileEntry {
  uint32_t light;
  std::vector<uint32_t> bits;
  std::vector<uint8_t> shares;
};
using TileEntries = std::vector<std::vector<TileEntry>>;  // by tile

// Entries of tiles that a light's rectangle touches.
void add_shares(const LightVolume& volume, const std::vector<uint8_t>& shares, int tiles_x, bool keep_shares,
                TileEntries& of_tile) {
  constexpr int side = HostShadows::side;
  const int width = volume.end.x - volume.first.x;
  for (int ty = volume.first.y / side; ty * side < volume.end.y; ++ty) {
    for (int tx = volume.first.x / side; tx * side < volume.end.x; ++tx) {
      std::vector<uint8_t> values(side * side);
      for (int y = std::max(ty * side, volume.first.y); y < std::min((ty + 1) * side, volume.end.y); ++y) {
        for (int x = std::max(tx * side, volume.first.x); x < std::min((tx + 1) * side, volume.end.x); ++x) {
          const int block = y % side / 4 * 4 + x % side / 4, value = block * 16 + y % 4 * 4 + x % 4;
          values[size_t(value)] =
              shares[size_t(y - volume.first.y) * size_t(width) + size_t(x - volume.first.x)];
        }
      }
      std::vector<uint32_t> bits = hidden_bits(values);
      if (!keep_shares) {
        values.clear();
        values.shrink_to_fit();
      }
      of_tile[size_t(ty) * size_t(tiles_x) + size_t(tx)].push_back(
          {volume.light, std::move(bits), std::move(values)});
    }
  }
}

// Lights may be hidden in part.
bool filtered(const ViewState& seen) {
  const LidrShadows way = seen.plan.settings[setting::lidr_shadows];
  return (way == LidrShadows::prepass_soft || way == LidrShadows::final_pass) &&
         seen.plan.settings[setting::shadow_taps] > 1;
}

}  // namespace

HostShadows IndexShadows::read(PassContext& work, const LightVolumes& volumes) const {
  constexpr int side = HostShadows::side;
  HostShadows all;
  all.tiles_x = (work.grid().width + side - 1) / side;
  all.tiles_y = (work.grid().height + side - 1) / side;
  TileEntries of_tile(size_t(all.tiles_x) * size_t(all.tiles_y));
  GlLightLoop loop = input(work);
  if (share_bits_of(work)) loop.defines.push_back(fmt::format("LIDR_SHARE_BITS {}u", share_bits_of(work)));
  const GlProgram& program =
      work.program("shaders/screen.vert", "shaders/index_shadow_probe.frag", loop.defines);
  const GlTexture shares = make_texture_2d(GL_R8, work.grid().width, work.grid().height);
  const GlFramebuffer framebuffer = make_framebuffer({shares.name()}, 0);
  const GlVertexArray nothing = make_vertex_array();
  std::vector<LightVolume> shadowed;
  for (const LightVolume& volume : volumes.volumes())
    if (has_own_shadow(work.plan, volume.light)) shadowed.push_back(volume);
  std::ranges::sort(shadowed, {}, &LightVolume::light);
  for (const LightVolume& volume : shadowed) {
    reset_gl_state();
    loop.bind(work);
    draw_casters(work, {&volume, 1});
    reset_gl_state();
    loop.bind(work);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glBindVertexArray(nothing.name());
    add_shares(volume, draw_shares(work.grid(), program, volume), all.tiles_x, filtered(work), of_tile);
  }
  reset_gl_state();
  for (const auto& entries : of_tile) {
    all.cells.emplace_back(uint32_t(all.indices.size()), uint32_t(entries.size()));
    for (const TileEntry& entry : entries) {
      all.indices.push_back(entry.light);
      all.bits.insert(all.bits.end(), entry.bits.begin(), entry.bits.end());
      all.shares.insert(all.shares.end(), entry.shares.begin(), entry.shares.end());
    }
  }
  all.local_alone = true;
  all.drops_hidden = work.plan.settings[setting::lidr_shadows] != LidrShadows::final_pass;
  return all;
}

}  // namespace lightgrid
