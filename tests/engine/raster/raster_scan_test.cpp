// The scan of counts, as places in the lists of the rasteriser: the same from both kernel shapes.
#include "raster/raster_view.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cl/launch.h"
#include "raster/drawn.h"
#include "shared/raster_params.h"

namespace lightgrid {
namespace {

struct ScannedCounts {
  std::vector<uint32_t> places, begins, counters;
  bool operator==(const ScannedCounts&) const = default;
};

// Scans `chunks` chunks, one after the other, each with a count per tile.
ScannedCounts scanned(const char* kernel, size_t items, std::vector<uint32_t> counts, uint32_t tiles_x,
                      uint32_t tiles_y, uint32_t chunks) {
  ClDevice& device = raster_device();
  RasterParams params{};
  params.tiles_x = tiles_x;
  params.tiles_y = tiles_y;
  params.chunks = chunks;
  const auto buffer_of = [&](void* data, size_t bytes) {
    return cl::Buffer(device.context(), CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, bytes, data);
  };
  ScannedCounts all{std::move(counts), std::vector<uint32_t>(tiles_x * tiles_y + 1),
                    std::vector<uint32_t>(RASTER_COUNTERS)};
  std::vector<std::pair<cl::Buffer, std::vector<uint32_t>*>> buffers;
  for (std::vector<uint32_t>* values : {&all.places, &all.begins, &all.counters})
    buffers.emplace_back(buffer_of(values->data(), values->size() * 4), values);
  cl::Kernel scan = raster_programs().kernel(kernel, "");
  launch(device, "raster_scan", scan, cl::NDRange(items), cl::NDRange(items), buffers[0].first,
         buffers[1].first, buffers[2].first, buffer_of(&params, sizeof(params)));
  for (auto& [buffer, values] : buffers)
    device.queue().enqueueReadBuffer(buffer, CL_TRUE, 0, values->size() * 4, values->data());
  return all;
}

TEST(Rasterizer, ScansCountsAlikeForCpusAndGpus) {
  RandomNumbers random(7);
  for (const auto& [tiles_x, tiles_y, chunks] :
       {std::tuple(1u, 1u, 1u), {20u, 12u, 16u}, {67u, 3u, 5u}, {16u, 8u, 1u}}) {
    for (const uint32_t most : {3u, 1u << 29}) {  // past 2^32 too
      std::vector<uint32_t> counts(tiles_x * tiles_y * chunks);
      uint64_t sum = 0;
      for (uint32_t& count : counts) sum += count = uint32_t(random.between(0, most));
      const ScannedCounts of_cpu = scanned("raster/cpu/raster_scan", 1, counts, tiles_x, tiles_y, chunks);
      EXPECT_EQ(of_cpu.counters[RASTER_ENTRIES] | uint64_t(of_cpu.counters[RASTER_ENTRIES + 1]) << 32, sum);
      EXPECT_TRUE(scanned("raster/gpu/raster_scan", RASTER_SCAN_GROUP, counts, tiles_x, tiles_y, chunks) ==
                  of_cpu)
          << tiles_x;
    }
  }
}

}  // namespace
}  // namespace lightgrid
