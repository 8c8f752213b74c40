#include "session/oracle.h"

#include "cl/transfer.h"
#include "reference/position.h"
#include "shared/light_grid.h"
#include "results/metrics.h"
#include "session/oracle_sample.h"
#include "capture/grid_lists.h"

namespace lightgrid {
namespace {

std::vector<ViewLight> local_lights(const RenderView& v) {
  const std::vector<ViewLight> all = lights_in_view(v.scene, v.view, v.plan.settings.ranges);
  std::vector<ViewLight> local;
  for (int i : v.plan.local) local.push_back(all[i]);
  return local;
}

template <typename T>
std::vector<T> read_shared(const RenderView& v, SharedTexture& shared, size_t count) {
  std::vector<T> values(count);
  if (count)
    read_buffer(*v.renderer.cl, "reading the light grid", shared.buffer->cl_buffer(), values.data(),
                count * sizeof(T));
  return values;
}

void add_lists(RenderView& v, const LightGrid& grid, ListedLights& lists) {
  SharedGridStorage& storage = v.opaque_grid();
  const size_t count = size_t(grid.cells_x) * grid.cells_y * grid.slices;
  for (const glm::uvec2& cell : read_shared<glm::uvec2>(v, storage.cells_, count)) {
    lists.first.push_back(cell.x), lists.count.push_back(cell.y);
  }
  if (grid.index_bits == 16) {
    const auto narrow = read_shared<uint16_t>(v, storage.indices_, grid.index_count);
    lists.indices.assign(narrow.begin(), narrow.end());
  } else {
    lists.indices = read_shared<uint32_t>(v, storage.indices_, grid.index_count);
  }
}

// A row of pixels as an image, for the metrics.
Image as_image(const std::vector<glm::dvec3>& colors) {
  Image image(int(colors.size()), 1);
  for (size_t i = 0; i < colors.size(); ++i) image.pixels[i] = glm::vec4(glm::vec3(colors[i]), 1);
  return image;
}

}  // namespace

Surface surface_of(const SurfaceImages& s, uint32_t pixel) {
  Surface surface;
  surface.normal = glm::normalize(glm::dvec3(s.normal_roughness.pixels[pixel]));
  surface.roughness = s.normal_roughness.pixels[pixel].w;
  surface.base_color = s.base_color_metallic.pixels[pixel];
  surface.metallic = s.base_color_metallic.pixels[pixel].w;
  surface.emissive = s.emissive_occlusion.pixels[pixel];
  surface.occlusion = s.emissive_occlusion.pixels[pixel].w;
  surface.unlit = surface.occlusion < 0;
  if (!s.model.pixels.empty()) {
    const MaterialModel& model = s.models.at(size_t(s.model.pixels[pixel].r));
    surface.subsurface_color = model.subsurface_color, surface.roll_off = model.roll_off,
    surface.minnaert_k = model.minnaert_k;
  }
  if (!s.specular.pixels.empty())
    surface.f0 = s.specular.pixels[pixel], surface.f90 = s.specular.pixels[pixel].w;
  if (s.coat_factor.pixels.empty() || s.coat_factor.pixels[pixel].r == 0) return surface;
  surface.coat = s.coat_factor.pixels[pixel].r;
  surface.coat_roughness = s.coat_normal_roughness.pixels[pixel].w;
  surface.coat_normal = glm::normalize(glm::dvec3(s.coat_normal_roughness.pixels[pixel]));
  return surface;
}

std::vector<uint32_t> cells_of_pixels(const RenderView& v, const std::vector<float>& depth) {
  const CullView view = cull_view(v.view, v.plan);
  const auto edges = slice_keys(view);
  std::vector<uint32_t> cells;
  cells.reserve(depth.size());
  for (int y = 0; y < v.view.height; ++y) {
    for (int x = 0; x < v.view.width; ++x) {
      const uint slice = slice_of_key(depth_key(view, depth[cells.size()]), edges.data());
      const uint first = cell_of_pixel(x, y, v.params.tile_size, v.params.tiles_x);
      cells.push_back(cell_in_slice(first, slice, v.params.tiles_x, v.params.tiles_y));
    }
  }
  return cells;
}

std::vector<uint32_t> z_bins_of_pixels(const RenderView& v, const std::vector<float>& depth) {
  const CullView view = cull_view(v.view, v.plan);
  const auto edges = z_bin_keys(view);
  std::vector<uint32_t> bins;
  bins.reserve(depth.size());
  for (const float value : depth) bins.push_back(z_bin_of_key(depth_key(view, value), edges.data()));
  return bins;
}

std::vector<float> read_depth(TechniqueRun& run) {
  RenderView& v = run.view();
  if (!run.frame().depth) return read_depth(v);
  std::vector<float> depth(v.pixels());
  read_buffer(*v.renderer.cl, "reading depth", run.frame().depth->values, depth.data(),
              depth.size() * sizeof(float));
  return depth;
}

ListedLights listed_lights(TechniqueRun& run, const std::vector<float>& depth) {
  RenderView& v = run.view();
  if (run.technique().listed && !run.frame().grid) return run.technique().listed(v);
  if (run.technique().listed_at) return run.technique().listed_at(v, depth);
  if (!v.plan.light_grid) return list_every_light(uint32_t(v.plan.local.size()));
  const LightGrid& grid = *run.frame().grid;
  ListedLights lists;
  lists.cell_of_pixel = cells_of_pixels(v, depth);
  if (v.plan.settings.grid_lists == GridLists::masks) {
    const size_t cells = size_t(grid.cells_x) * grid.cells_y * grid.slices;
    add_masks(read_shared<uint32_t>(v, v.opaque_grid().masks_, cells * grid.mask_words), cells, lists);
  } else {
    add_lists(v, grid, lists);
  }
  if (grid.z_bin_bytes == 0) return lists;
  return in_z_bins(lists, z_bins_of_pixels(v, depth),
                   read_shared<uint32_t>(v, v.opaque_grid().z_bins_, grid.z_bin_bytes / 4));
}

LitPairs count_listed_pairs(TechniqueRun& run, const std::vector<float>& depth) {
  return count_pairs(run.view().view, depth, local_lights(run.view()), listed_lights(run, depth));
}

ReferenceErrors measure_reference_errors(const SurfaceOracle& oracle, const Image& every_light,
                                         const std::vector<uint32_t>& pixels) {
  const Image with_window = as_image(oracle.shade(pixels, true)),
              without = as_image(oracle.shade(pixels, false));
  Image in_float(int(pixels.size()), 1);
  for (size_t i = 0; i < pixels.size(); ++i) in_float.pixels[i] = every_light.pixels[pixels[i]];
  return {compare_images(with_window, without), compare_images(in_float, with_window),
          oracle.pixels_left_out()};
}

ReferenceErrors measure_reference_errors(RenderView& v, const Image& every_light,
                                         const std::vector<float>& depth, size_t samples) {
  const SurfaceOracle oracle(v, depth);
  return measure_reference_errors(oracle, every_light, sample_pixels(oracle.pixels(), samples));
}

}  // namespace lightgrid
