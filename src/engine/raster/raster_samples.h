// Where the samples of a pixel lie: the standard locations of Vulkan 1.3, "Multisampling", and Direct3D 11,
// whose y goes down.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>

namespace lightgrid {

// From a pixel's centre, 1/256 pixel, x to the right and y up. Their mean is the centre.
constexpr glm::ivec2 raster_samples_of_1[1] = {{0, 0}};
constexpr glm::ivec2 raster_samples_of_2[2] = {{64, -64}, {-64, 64}};
constexpr glm::ivec2 raster_samples_of_4[4] = {{-32, 96}, {96, 32}, {-96, -32}, {32, -96}};
constexpr glm::ivec2 raster_samples_of_8[8] = {{16, 48},   {-16, -48}, {80, -16},  {-48, 80},
                                               {-80, -80}, {-112, 16}, {48, -112}, {112, 112}};

// samples: 1, 2, 4 or 8; empty for others.
constexpr std::span<const glm::ivec2> raster_samples(int samples) {
  if (samples == 1) return raster_samples_of_1;
  if (samples == 2) return raster_samples_of_2;
  if (samples == 4) return raster_samples_of_4;
  if (samples == 8) return raster_samples_of_8;
  return {};
}

// Options for kernels/common/sample_places.h. Empty for one sample; begins with a space otherwise.
inline std::string sample_defines(std::span<const glm::ivec2> of) {
  if (of.size() == 1) return "";
  std::string places;
  for (const glm::ivec2& p : of)
    places += (places.empty() ? "" : ",") + std::to_string(p.x) + ',' + std::to_string(p.y);
  return " -DSAMPLES=" + std::to_string(of.size()) + " -DSAMPLE_PLACES=" + places;
}
inline std::string sample_defines(int samples) { return sample_defines(raster_samples(samples)); }

}  // namespace lightgrid
