#include "passes/build_voxels.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "cl/transfer.h"
#include "passes/read_outs.h"
#include "plan/settings/model.h"

namespace lightgrid {
namespace {

class VoxelLister {
 public:
  VoxelLister(const ViewState& seen, ReadVoxels read)
      : seen_(seen),
        r_(std::move(read)),
        size_(r_.placed.grid.size_x, r_.placed.grid.size_y, r_.placed.grid.size_z) {
    View along;
    along.view_from_world = glm::dmat4(r_.axes.from_world);
    along.eye = r_.axes.origin;
    for (const ViewLight& light :
         lights_in_view(seen.scene, along, ranges_of(seen.plan.settings), seen.plan.lights.local))
      lights_.push_back(bounds_of(light));
  }

  ListedLights listed(const std::vector<float>& depth) {
    ListedLights lists;
    lists.cell_of_pixel.assign(depth.size(), 0);
    lists.count.push_back(0);              // the background's
    std::map<uint64_t, uint32_t> cell_of;  // by brick, then place in it
    for (size_t p = 0; p < depth.size(); ++p) {
      if (!(depth[p] > 0)) continue;
      const auto [found, added] =
          cell_of.try_emplace(key_of(cell_at(p, depth[p])), uint32_t(lists.count.size()));
      if (added) lists.count.push_back(0);
      lists.cell_of_pixel[p] = found->second;
    }
    std::vector<std::vector<uint32_t>> lights(lists.count.size());
    uint64_t brick = ~uint64_t(0);
    std::vector<uint32_t> near;
    for (const auto& [key, cell] : cell_of) {
      if (key / cells_of_brick != brick) {
        brick = key / cells_of_brick;
        near = lights_near(brick);
      }
      lights[cell] = lights_around(cell_of_key(key), near);
      lists.count[cell] = uint32_t(lights[cell].size());
    }
    place_lists(lists);
    for (size_t cell = 0; cell < lights.size(); ++cell)
      std::ranges::copy(lights[cell], lists.indices.begin() + ptrdiff_t(lists.first[cell]));
    return lists;
  }

 private:
  static constexpr uint64_t brick_side = 8, cells_of_brick = brick_side * brick_side * brick_side;

  glm::uvec3 bricks() const { return (size_ + uint(brick_side) - 1u) / uint(brick_side); }

  uint64_t key_of(glm::uvec3 cell) const {
    const glm::uvec3 b = cell / uint(brick_side), in = cell % uint(brick_side);
    return ((uint64_t(b.z) * bricks().y + b.y) * bricks().x + b.x) * cells_of_brick +
           (in.z * brick_side + in.y) * brick_side + in.x;
  }

  glm::uvec3 first_of(uint64_t brick) const {
    const glm::uvec3 n = bricks();
    return glm::uvec3(uint(brick % n.x), uint(brick / n.x % n.y), uint(brick / n.x / n.y)) * uint(brick_side);
  }

  glm::uvec3 cell_of_key(uint64_t key) const {
    const uint in = uint(key % cells_of_brick), side = uint(brick_side);
    return first_of(key / cells_of_brick) + glm::uvec3(in % side, in / side % side, in / side / side);
  }

  // The cell between samples in which a pixel lies, as kernels/voxels/voxel_lookup.h finds it.
  glm::uvec3 cell_at(size_t pixel, float depth) const {
    const ViewParams& p = seen_.params;
    const double x = double(pixel % p.width) + 0.5, y = double(pixel / p.width) + 0.5;
    const double distance = p.orthographic ? (p.depth_b - double(depth)) * p.depth_a
                                           : double(p.depth_b) / (double(depth) + p.depth_a);
    const double scale = p.orthographic || r_.axes.log_depth ? 1 : distance;
    const glm::dvec3 q((x * p.slope_x_scale + p.slope_x_offset) * scale,
                       (y * p.slope_y_scale + p.slope_y_offset) * scale,
                       r_.axes.log_depth ? std::log2(distance) : -distance);
    const VoxelLookup& l = r_.placed.lookup;
    const glm::dvec3 place(l.x_from_x * q.x + l.x_from_y * q.y + l.x_from_z * q.z + l.x_from_1,
                           l.y_from_x * q.x + l.y_from_y * q.y + l.y_from_z * q.z + l.y_from_1,
                           l.z_from_x * q.x + l.z_from_y * q.y + l.z_from_z * q.z + l.z_from_1);
    return glm::uvec3(glm::clamp(glm::floor(place), glm::dvec3(0), glm::dvec3(size_) - 2.0));
  }

  glm::dvec3 sample_at(glm::uvec3 i) const {
    const VoxelGrid& g = r_.placed.grid;
    const double x = double(g.origin_x) + i.x * double(g.spacing_x),
                 y = double(g.origin_y) + i.y * double(g.spacing_y);
    const double place = r_.placed.slices[i.z].place;
    return r_.axes.log_depth ? glm::dvec3(x * place, y * place, -place) : glm::dvec3(x, y, place);
  }

  // True if add_voxel_light of kernels/voxels/voxel_light.h adds anything for this light.
  bool reaches(const LightBounds& light, glm::uvec3 i) const {
    const glm::dvec3 d = light.position - sample_at(i);
    const double squared = glm::dot(d, d), grown = r_.placed.slices[i.z].half_diagonal_squared;
    if (light.radius_m <= 0 || squared >= light.radius_m * light.radius_m + grown) return false;
    if (!light.has_cone() || squared == 0) return true;
    const double past_edge = light.cos_outer + glm::dot(light.direction, d) / std::sqrt(squared);
    return past_edge <= 4 * std::sqrt(std::min(grown / squared, 4.0));
  }

  // Lights that may reach a sample of a brick's cells. Ascending.
  std::vector<uint32_t> lights_near(uint64_t brick) const {
    const glm::uvec3 first = first_of(brick), last = glm::min(first + uint(brick_side), size_ - 1u);
    glm::dvec3 low = sample_at(first), high = low;
    double grown = 0;
    for (int corner = 1; corner < 8; ++corner) {
      const glm::dvec3 p = sample_at(
          {corner & 1 ? last.x : first.x, corner & 2 ? last.y : first.y, corner & 4 ? last.z : first.z});
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    for (uint z = first.z; z <= last.z; ++z)
      grown = std::max(grown, double(r_.placed.slices[z].half_diagonal_squared));
    std::vector<uint32_t> near;
    for (uint32_t i = 0; i < lights_.size(); ++i) {
      const glm::dvec3 d = lights_[i].position - glm::clamp(lights_[i].position, low, high);
      if (glm::dot(d, d) < lights_[i].radius_m * lights_[i].radius_m + grown) near.push_back(i);
    }
    return near;
  }

  std::vector<uint32_t> lights_around(glm::uvec3 cell, const std::vector<uint32_t>& near) const {
    std::vector<uint32_t> around;
    for (const uint32_t i : near) {
      bool any = false;
      for (uint corner = 0; corner < 8 && !any; ++corner)
        any = reaches(lights_[i], cell + glm::uvec3(corner & 1, corner >> 1 & 1, corner >> 2));
      if (any) around.push_back(i);
    }
    return around;
  }

  const ViewState& seen_;
  ReadVoxels r_;
  glm::uvec3 size_;
  std::vector<LightBounds> lights_;
};

}  // namespace

ListedLights list_voxels(PassContext& work, const ReadVoxels& read, const DepthBuffer& shaded_from) {
  std::vector<float> depth(work.grid().pixels());
  if (shaded_from.values()) {
    read_buffer(*work.renderer.cl, "reading depth", shaded_from.values, depth.data(),
                depth.size() * sizeof(float));
  } else {
    depth = read_depth(work);
  }
  return VoxelLister(work, read).listed(depth);
}

}  // namespace lightgrid
