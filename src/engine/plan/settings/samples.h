// Several samples per pixel (docs/samples.md).
#pragma once

#include "plan/settings.h"
#include "shared/sample_masks.h"

namespace lightgrid {

// How the light of a pixel's samples is averaged (docs/samples.md#averages).
enum class SamplesShading { edges, all };
enum class SamplesResolve { linear, tonemapped, weighted };

inline bool several_samples(const Settings& s);

}  // namespace lightgrid

namespace lightgrid::setting {

inline const Setting<int> samples{420,
                                  "samples",
                                  "samples per pixel; 1 is the pixel's centre. Each surface that the samples "
                                  "see is shaded once and weighted by its share of them",
                                  {"1", "2", "4", "8"}};

inline const Setting<SamplesShading> samples_shading{
    430,
    "samples-shading",
    "if surfaces are stored for each sample: samples are shaded separately only at edges, or everywhere",
    {{"edges", SamplesShading::edges}, {"all", SamplesShading::all}},
    {.shown = several_samples}};

inline const Setting<SampleMasks> samples_masks{
    440,
    "samples-masks",
    "where alpha masks are tested with several samples: at the pixel's centre, at each sample, or by "
    "coverage, from alpha at the centre and its slope",
    {{"centre", SampleMasks::centre}, {"samples", SampleMasks::samples}, {"coverage", SampleMasks::coverage}},
    {.shown = several_samples}};

inline const Setting<SamplesResolve> samples_resolve{
    450,
    "samples-resolve",
    "how a pixel's samples are averaged: their light, their light after the tone map, or their light "
    "weighted by the tone map's derivative",
    {{"linear", SamplesResolve::linear},
     {"tonemapped", SamplesResolve::tonemapped},
     {"weighted", SamplesResolve::weighted}},
    {.shown = several_samples}};

}  // namespace lightgrid::setting

namespace lightgrid {

inline bool several_samples(const Settings& s) { return s[setting::samples] > 1; }

// With this number of samples per pixel, whatever the scene requests.
inline Settings with_samples(Settings settings, int samples) {
  return settings.set(setting::samples, samples).give(setting::samples);
}

}  // namespace lightgrid
