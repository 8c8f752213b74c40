// The references of a comparison's rows, measured once all have run: the reference's picture, its surfaces,
// and the oracle.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "accuracy/shadow_truth.h"
#include "accuracy/surfaces_in_double.h"
#include "compare/runs.h"
#include "measures/flip.h"
#include "plan/settings/samples.h"

namespace lightgrid::lab {

// The triangles that the reference shows, and where some row shows another one.
struct ReferenceTriangles {
  ShownTriangles shown;
  std::vector<bool> contested = std::vector<bool>(shown.opaque.size());
};

// The settings of a row on which its samples' picture of every light depends.
struct SampledBy {
  bool own_surfaces = false;  // drawn in OpenCL
  int samples = 1;
  SampleMasks masks = SampleMasks::centre;          // with one sample: centres
  SamplesResolve resolve = SamplesResolve::linear;  // with one sample: linear
  auto operator<=>(const SampledBy&) const = default;
};
SampledBy sampled_by(bool own_surfaces, const Settings& settings);

// The data that the rows are compared with.
struct Measured {
  Reference& reference;
  std::vector<float> depth;
  ReferenceTriangles triangles;
  ShadowTruth shadows;
  FrameFigures result;
  std::optional<FlipExposures> exposures{};
  bool has_samples = false;       // some row has several a pixel
  bool shown = false;             // the report will have the reference's image
  Image every_light_on_own = {};  // surfaces, where rows have such and the reference has OpenGL's; or empty
  // Every light with other samples a pixel, where rows have such.
  std::map<SampledBy, Image> every_light_with = {};
};

// Takes the reference's image from its run. flip: with exposures for it.
Measured measured(Reference& reference, bool flip);

// Where an own reference is not wanted, the report has no OwnSurfaces; where it cannot be had, it says why
// not.
void draw_every_light_on_own_surfaces(CompareReport& report, const Compared& compared,
                                      const std::vector<ContestantRun>& entries, Measured& m);

// The run's row, its errors and pairs, its image and lists, at this place of the report. All or nothing: the
// lists may not fit in memory. The run's images may hold another run's frame, so it draws once more.
void set_row(CompareReport& report, size_t place, TechniqueRun& run, Measured& m);

// Measures all rows against surfaces in double and the oracle.
void measure_errors(CompareReport& report, const Compared& compared, Measured& m);

// The reference's image becomes the report's, or its row's.
void hand_over_image(CompareReport& report, Measured& m);

}  // namespace lightgrid::lab
