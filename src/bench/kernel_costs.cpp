#include "bench/kernel_costs.h"

#include <map>

#include "shared/raster_params.h"

namespace lightgrid {
namespace {

using Formula = KernelCost (*)(const KernelWork&);

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
// Of view_sphere there, with a range of distances from it.
constexpr double range_flops = 28;
double test_flops(const KernelWork& w) {
  return box_flops + (w.exact ? exact_flops : 0) + (w.cones ? cone_flops : 0);
}

// A bin has at least as many candidates as its longest list, and therefore at least its indices / 64.
double least_candidates(const KernelWork& w) { return double(w.indices) / bin_tiles; }
double cell_mark_bytes(const KernelWork& w) { return least_candidates(w) * bin_tiles / 8; }

// The rasteriser: a position, a vertex in clip space, a triangle's corners, the pixels of its box, a pixel of
// the image. An instance's clusters are at least its triangles / 64.
constexpr double position_bytes = 12, clip_bytes = 16, corner_bytes = 12, box_bytes = 8,
                 visible_pixel_bytes = 8;
constexpr double transform_flops = 24;  // twelve multiply-adds
double least_clusters(const KernelWork& w) { return double(w.triangles) / RASTER_CLUSTER; }

// Lower bounds for any kernel with these inputs and outputs: each is read and written once, as if repeated
// accesses hit caches, with one test for each final list entry.
const std::map<std::string, Formula>& formulas() {
  static const std::map<std::string, Formula> table = {
      {"depth_bounds",
       [](const KernelWork& w) {
         return KernelCost{4.0 * w.pixels + interval_bytes * w.tiles, 8.0 * w.tiles};
       }},
      {"project_lights",
       [](const KernelWork& w) {
         return KernelCost{(world_bytes(w) + view_bytes(w)) * w.lights, project_flops * w.lights};
       }},
      // CPU kernels.
      {"cull_lights",
       [](const KernelWork& w) {
         return KernelCost{interval_bytes * w.tiles + view_bytes(w) * least_candidates(w) +
                               count_bytes * w.cells + w.index_bytes,
                           test_flops(w) * w.indices};
       }},
      {"write_lists",
       [](const KernelWork& w) {
         return KernelCost{2.0 * w.index_bytes + (count_bytes + cell_bytes) * w.cells, 0.0};
       }},
      // GPU kernels.
      {"cull_lights",
       [](const KernelWork& w) {
         return KernelCost{interval_bytes * w.tiles + w.lights / 8.0 +
                               (view_bytes(w) + 2 * id_bytes) * least_candidates(w) + cell_mark_bytes(w) +
                               count_bytes * w.cells,
                           test_flops(w) * w.indices};
       }},
      {"write_lists",
       [](const KernelWork& w) {
         return KernelCost{cell_mark_bytes(w) + cell_bytes * w.cells + w.index_bytes, 0.0};
       }},
      // Used only if the settings need their result.
      {"light_z_bins",
       [](const KernelWork& w) {
         const double bytes = (place_bytes + z_bin_word_bytes) * w.lights + interval_bytes * w.z_bins;
         return KernelCost{bytes, range_flops * w.lights};
       }},
      {"lists_to_masks",
       [](const KernelWork& w) {
         return KernelCost{cell_bytes * w.cells + w.index_bytes + w.mask_bytes, 0.0};
       }},
      // CPU kernels; of GPUs the first two and the last.
      {"raster_transform",
       [](const KernelWork& w) {
         return KernelCost{(position_bytes + clip_bytes) * w.vertices, transform_flops * w.vertices};
       }},
      {"raster_clusters",
       [](const KernelWork& w) {
         return KernelCost{sizeof(RasterCluster) * least_clusters(w), 0.0};
       }},
      {"raster_order",
       [](const KernelWork& w) {
         return KernelCost{least_clusters(w) + id_bytes * w.clusters, 0.0};
       }},
      {"raster_setup",
       [](const KernelWork& w) {
         return KernelCost{(corner_bytes + sizeof(RasterRecord)) * w.records, 0.0};
       }},
      {"raster_scan",
       [](const KernelWork& w) {
         return KernelCost{2.0 * count_bytes * w.tiles, 0.0};
       }},
      {"raster_fill",
       [](const KernelWork& w) {
         return KernelCost{box_bytes * w.records + id_bytes * w.tile_entries, 0.0};
       }},
      {"raster_tiles",
       [](const KernelWork& w) {
         return KernelCost{
             id_bytes * w.tile_entries + sizeof(RasterRecord) * w.records + visible_pixel_bytes * w.pixels,
             0.0};
       }},
      {"raster_clear",
       [](const KernelWork& w) {
         return KernelCost{visible_pixel_bytes * w.pixels, 0.0};
       }},
      {"raster_keys",
       [](const KernelWork& w) {
         return KernelCost{2.0 * visible_pixel_bytes * w.pixels, 0.0};
       }},
  };
  return table;
}

}  // namespace

std::optional<KernelCost> kernel_cost(const std::string& label, const KernelWork& work) {
  const auto found = formulas().find(label);
  if (found == formulas().end()) return {};
  return found->second(work);
}

}  // namespace lightgrid
