#include "passes/find_edges.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "cl/transfer.h"
#include "plan/settings/kernels.h"
#include "plan/settings/samples.h"
#include "plan/settings/shadows.h"
#include "raster/raster_samples.h"

namespace lightgrid {
namespace {

constexpr size_t run_pixels = 4096, item_pixels = 16, group = 64;  // sizes of kernels/resolve/*/find_edges.cl

}  // namespace

class PixelEdges : public PassCache {
 public:
  explicit PixelEdges(PassContext& work) : kernels_(work, "resolve") {}
  bool follow(PassContext&) override { return true; }
  size_t memory_bytes() const override { return triangles_.bytes() + depths_.bytes() + edges_.bytes(); }

  PixelSurfaces find(PassContext& work, const Visibility& image, const RasterBuffers& raster) {
    ClDevice& device = *work.renderer.cl;
    const size_t pixels = work.grid().pixels(), room = pixels + PassContext::spare_pixels;
    const PixelSurfaces found{triangles_.at_least(device, room * 4), depths_.at_least(device, room * 4),
                              edges_.at_least(device, (pixels + 15) / 16 * 2)};
    const Settings& settings = work.plan.settings;
    // Whatever shadows the plan leaves out, which changes no image.
    const bool shadowed = settings[setting::shadows] != ShadowMethod::none &&
                          std::ranges::any_of(work.scene.lights, &Light::casts_shadow);
    kernels_.use(sample_defines(settings[setting::samples]) + (shadowed ? " -DSHADOWED" : "") +
                 (kernels_.lanes && settings[setting::portable] ? " -DPORTABLE" : ""));
    const auto items = [&](size_t of) { return (pixels + of - 1) / of; };
    kernels_.of("find_edges")
        .launch(device, "find_edges",
                kernels_.lanes ? cl::NDRange(items(run_pixels))
                               : cl::NDRange((items(item_pixels) + group - 1) / group * group),
                kernels_.lanes ? cl::NDRange(1) : cl::NDRange(group),
                {{"triangles", image.triangle},
                 {"depths", image.depth},
                 {"triangle_instance", raster.triangle_instance},
                 {"instances", raster.instances},
                 {"indices", raster.indices},
                 {"clip", raster.clip},
                 {"width", cl_uint(work.grid().width)},
                 {"height", cl_uint(work.grid().height)},
                 {"pixel_triangles", found.triangles},
                 {"pixel_depths", found.depths},
                 {"edges", found.edges}});
    return found;
  }

 private:
  PassKernels kernels_;
  GrowingBuffer triangles_, depths_, edges_;
};

PixelSurfaces find_edges(PassContext& work, Cached<PixelEdges>& cache, const Visibility& image,
                         const RasterBuffers& raster) {
  PixelEdges& edges = cache.of(work);
  auto pass = work.timer.pass("find_edges", "cl");
  pass.moves(work.grid().values() * 8, work.grid().pixels() * 8 + work.grid().pixels() / 8);
  return edges.find(work, image, raster);
}

SampleFigures sample_figures(PassContext& work, const Visibility& image, const PixelSurfaces& surfaces) {
  const PixelGrid grid = work.grid();
  const auto read = [&](const cl::Buffer& buffer, auto& values) {
    read_buffer(*work.renderer.cl, "counting pixels at edges", buffer, values.data(),
                values.size() * sizeof values[0]);
  };
  std::vector<uint16_t> edges((grid.pixels() + 15) / 16);
  std::vector<uint32_t> seen(grid.values());
  read(surfaces.edges, edges);
  read(image.triangle, seen);
  SampleFigures figures;
  for (size_t i = 0; i < grid.pixels(); ++i) {
    const std::span<const uint32_t> of(seen.data() + i * size_t(grid.samples), size_t(grid.samples));
    const bool edge = edges[i / 16] >> (i % 16) & 1;
    figures.edge_pixels += edge;
    std::set<uint32_t> distinct(of.begin(), of.end());
    figures.surfaces.push_back(edge ? uint32_t(distinct.size()) : 0);
    distinct.erase(no_triangle);
    figures.shadings += distinct.size();
    figures.covered += of.size() - size_t(std::ranges::count(of, no_triangle));
  }
  figures.bytes =
      grid.values() * 8 + bytes_of(surfaces.triangles) + bytes_of(surfaces.depths) + bytes_of(surfaces.edges);
  return figures;
}

}  // namespace lightgrid
