// Where a mask is tested in a pixel of several samples (docs/samples.md#masks): the setting samples-masks.
#pragma once

#include <string>

namespace lightgrid {

// centre:   once, at the pixel's centre, for all samples
// samples:  at each sample's place, with the footprint of a sample
// coverage: at each sample's place on the plane through the alpha at the centre and its slope on the screen
enum class SampleMasks { centre, samples, coverage };

// The define for masks in kernels (kernels/raster/raster_masks.h) and in shaders
// (shaders/common/material.glsl). Empty: at centres.
inline std::string mask_define(SampleMasks masks) {
  if (masks == SampleMasks::samples) return "MASKS_AT_SAMPLES";
  return masks == SampleMasks::coverage ? "MASKS_BY_COVERAGE" : "";
}

}  // namespace lightgrid
