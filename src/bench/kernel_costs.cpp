#include "bench/kernel_costs.h"

#include <map>

#include "shared/raster_params.h"

namespace lightgrid {
namespace {

constexpr double interval_bytes = 8, cell_bytes = 8, count_bytes = 4, id_bytes = 4;
constexpr double place_bytes = 16, z_bin_word_bytes = 4;
constexpr double bin_tiles = 64;

// Bytes of a light: position and radius, and with cones an axis and a cosine; in view space also its tile
// rectangle and index.
double world_bytes(const KernelWork& w) { return 4.0 * (w.cones ? 8 : 4); }
double view_bytes(const KernelWork& w) { return 4.0 * (w.cones ? 11 : 7); }

// Operations of kernels/culling/project.h and light_cell_tests.h, counted in their text: to view space with
// two pairs of tangents; sphere against box; additionally three Newton steps; additionally cone against
// sphere.
constexpr double project_flops = 100, box_flops = 18, exact_flops = 110, cone_flops = 60;
// view_sphere there takes these, with a range of distances from it.
constexpr double range_flops = 28;
double test_flops(const KernelWork& w) {
  return box_flops + (w.exact ? exact_flops : 0) + (w.cones ? cone_flops : 0);
}

// A bin has at least as many candidates as its longest list, and therefore at least its indices / 64.
double least_candidates(const KernelWork& w) { return double(w.indices) / bin_tiles; }

// The rasteriser: a position, a vertex in clip space, a triangle's corners, the pixels of its box, a pixel of
// the image. An instance's clusters are at least its triangles / 64.
constexpr double position_bytes = 12, clip_bytes = 16, corner_bytes = 12, box_bytes = 8,
                 visible_pixel_bytes = 8;
constexpr double transform_flops = 24;  // twelve multiply-adds
double least_clusters(const KernelWork& w) { return double(w.triangles) / RASTER_CLUSTER; }

}  // namespace

// Lower bounds for any kernel with these inputs and outputs: each is read and written once, as if repeated
// accesses hit caches, with one test for each final list entry.
std::optional<KernelCost> kernel_cost(const std::string& label, const KernelWork& w) {
  const std::map<std::string, KernelCost> costs = {
      {"depth_bounds", {4.0 * w.pixels + interval_bytes * w.tiles, 8.0 * w.tiles}},
      {"project_lights", {(world_bytes(w) + view_bytes(w)) * w.lights, project_flops * w.lights}},
      // Those of the CPU's form.
      {"cull_lights",
       {interval_bytes * w.tiles + view_bytes(w) * least_candidates(w) + count_bytes * w.cells +
            w.index_bytes,
        test_flops(w) * w.indices}},
      {"write_lists", {2.0 * w.index_bytes + (count_bytes + cell_bytes) * w.cells, 0}},
      // Launched only if the settings need their result.
      {"light_z_bins",
       {(place_bytes + z_bin_word_bytes) * w.lights + interval_bytes * w.z_bins, range_flops * w.lights}},
      {"lists_to_masks", {cell_bytes * w.cells + w.index_bytes + w.mask_bytes, 0}},
      // The rasteriser's on CPUs; GPUs launch the first two and the last two of them.
      {"raster_transform", {(position_bytes + clip_bytes) * w.vertices, transform_flops * w.vertices}},
      {"raster_clusters", {sizeof(RasterCluster) * least_clusters(w), 0}},
      {"raster_order", {least_clusters(w) + id_bytes * w.clusters, 0}},
      {"raster_setup", {(corner_bytes + sizeof(RasterRecord)) * w.records, 0}},
      {"raster_scan", {2.0 * count_bytes * w.tiles, 0}},
      {"raster_fill", {box_bytes * w.records + id_bytes * w.tile_entries, 0}},
      {"raster_tiles",
       {id_bytes * w.tile_entries + sizeof(RasterRecord) * w.records + visible_pixel_bytes * w.pixels, 0}},
      {"raster_clear", {visible_pixel_bytes * w.pixels, 0}},
      {"raster_keys", {2.0 * visible_pixel_bytes * w.pixels, 0}},
  };
  const auto found = costs.find(label);
  return found == costs.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace lightgrid
