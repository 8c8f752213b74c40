#include "passes/sample_edges.h"

#include <algorithm>
#include <span>

#include "cl/buffers.h"
#include "cl/launch.h"
#include "passes/common/surface_numbers.h"
#include "plan/settings/samples.h"
#include "raster/raster_samples.h"

namespace lightgrid {

// The kernel and its result.
class SampleEdges : public PassCache {
 public:
  explicit SampleEdges(PassContext& work) : kernels_(work, "resolve") {}

  bool follow(PassContext&) override { return true; }
  size_t memory_bytes() const override { return edges_.bytes(); }

  cl::Buffer find(PassContext& work, const StoredSurfaces& surfaces, const DepthBuffer& depth) {
    constexpr size_t group = 64;
    const size_t pixels = work.grid().pixels(), groups = pixels / group + 1;
    const size_t values = groups * group / 16;
    const bool lanes = kernels_.lanes;
    ClDevice& device = *work.renderer.cl;
    const std::string defines =
        fmt::format(" -DWORDS={}u{}{}", surfaces.bytes / 4, sample_defines(work.sample_places()),
                    surfaces.surface_numbers ? surface_number_define(work.plan) : "");
    NamedKernel& kernel = kernels_.of("sample_edges", defines);
    auto pass = work.timer.pass("sample_edges", "cl");
    const auto image = [&](size_t i) {
      return i < surfaces.images.size() ? surfaces.images[i]->cl_buffer() : cl::Buffer();
    };
    kernel.launch(
        device, "sample_edges", cl::NDRange(lanes ? values : groups * group),
        lanes ? cl::NullRange : cl::NDRange(group),
        ClArguments{{"first", image(0)}, {"second", image(1)}, {"third", image(2)}, {"fourth", image(3)}} +
            surface_number_arguments(work.plan, surfaces.surface_numbers) +
            ClArguments{{"depths", depth.values},
                        {"pixels", cl_uint(pixels)},
                        {"edges", edges_.at_least(device, values * sizeof(cl_ushort))}});
    pass.moves(work.grid().values() * (surfaces.bytes * surfaces.images.size() + 4),
               values * sizeof(cl_ushort));
    return edges_.get();
  }

 private:
  PassKernels kernels_;
  GrowingBuffer edges_;
};

// The figures of these edges; null: all pixels are at one. bytes: of all images. Waits.
static SampleFigures figures_of_edges(PassContext& work, const cl::Buffer& edges, const DepthBuffer& depth,
                                      size_t bytes) {
  const PixelGrid grid = work.grid();
  const size_t samples = size_t(grid.samples);
  std::vector<uint16_t> bits((grid.pixels() + 15) / 16, 0xffff);
  std::vector<float> depths(grid.values());
  const auto read = [&](const cl::Buffer& buffer, auto& values) {
    read_buffer(*work.renderer.cl, "counting pixels at edges", buffer, values.data(),
                values.size() * sizeof values[0]);
  };
  if (edges()) read(edges, bits);
  read(depth.values, depths);
  SampleFigures figures;
  for (size_t i = 0; i < grid.pixels(); ++i) {
    const std::span<const float> of(depths.data() + i * samples, samples);
    const size_t covered = samples - size_t(std::ranges::count(of, 0.0f));
    const bool edge = bits[i / 16] >> (i % 16) & 1;
    figures.edge_pixels += edge;
    figures.shadings += edge ? covered : covered > 0;
    figures.covered += covered;
    figures.surfaces.push_back(edge ? uint32_t(samples) : 0);
  }
  figures.bytes = bytes + (edges() ? bits.size() * 2 : 0);
  return figures;
}

cl::Buffer sample_edges(PassContext& work, Cached<SampleEdges>& cache, const StoredSurfaces& surfaces,
                        const DepthBuffer& depth, size_t bytes_a_sample, Frame& frame) {
  if (work.grid().samples == 1) return {};
  cl::Buffer edges;
  if (work.plan.settings[setting::samples_shading] == SamplesShading::edges)
    edges = surfaces.edges() ? surfaces.edges : cache.of(work).find(work, surfaces, depth);
  size_t bytes = work.grid().values() * bytes_a_sample;
  // find_edges adds a triangle a sample, and a triangle and a depth a pixel.
  if (surfaces.edges()) bytes += work.grid().values() * 4 + work.grid().pixels() * 8;
  frame.sample_figures = [&work, edges, depth, bytes] { return figures_of_edges(work, edges, depth, bytes); };
  return edges;
}

}  // namespace lightgrid
