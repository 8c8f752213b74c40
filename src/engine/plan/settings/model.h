// Which picture is meant: the specular lobe, and where lights end.
#pragma once

#include "plan/settings.h"
#include "scene/light_ranges.h"
#include "scene/material_model.h"

namespace lightgrid {

inline bool ranges_are_random(const Settings& s);

}  // namespace lightgrid

namespace lightgrid::setting {

inline const Setting<Brdf> brdf{
    10,
    "brdf",
    "the specular lobe: GGX, Blinn-Phong of the same width, or none: base colour / pi",
    {{"ggx", Brdf::ggx}, {"blinn", Brdf::blinn}, {"lambert", Brdf::lambert}},
    {.model = true}};

inline const Setting<LightRange> range{
    20,
    "range",
    "where a light ends: at the scene's range; where its irradiance falls to cutoff; at a random distance, "
    "so that the mean picture has no ranges (see alpha); or nowhere",
    {{"scene", LightRange::scene},
     {"cutoff", LightRange::cutoff},
     {"stochastic", LightRange::stochastic},
     {"infinite", LightRange::infinite}},
    {.model = true, .common = true, .random = ranges_are_random}};

inline const Setting<double> cutoff{
    30,
    "cutoff",
    "with range=cutoff: the irradiance (intensity over squared distance) at which lights end",
    {"0.01", "1", "0.5", "0.2", "0.1", "0.05", "0.02", "0.005", "0.002", "0.001", "0.0005", "0.0002",
     "0.0001"},
    {.model = true,
     .common = true,
     .shown = [](const Settings& s) { return s[range] == LightRange::cutoff; },
     .any_number = true}};

inline const Setting<RangeWindow> window{
    40,
    "window",
    "how a light fades towards its range: 1 - (d / range)^4, its square, or not at all",
    {{"khr", RangeWindow::khr}, {"smooth", RangeWindow::smooth}, {"none", RangeWindow::none}},
    {.model = true, .common = true, .shown = [](const Settings& s) {
       return s[range] == LightRange::scene || s[range] == LightRange::cutoff;
     }}};

inline const Setting<double> alpha{
    50,
    "alpha",
    "with range=stochastic: irradiance below which a light reaches a point only with some probability",
    {"0.01", "1", "0.5", "0.2", "0.1", "0.05", "0.02", "0.005", "0.002", "0.001", "0.0005", "0.0002",
     "0.0001"},
    {.model = true, .common = true, .shown = ranges_are_random, .any_number = true}};

inline const Setting<uint32_t> light_seed{
    60,
    "light-seed",
    "with range=stochastic: seed of the random ranges",
    {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16"},
    {.model = true, .common = true, .shown = ranges_are_random}};

}  // namespace lightgrid::setting

namespace lightgrid {

inline bool ranges_are_random(const Settings& s) { return s[setting::range] == LightRange::stochastic; }

// With the values of the rows `of_lights`.
LightRanges ranges_of(const Settings& s);
void set_ranges(Settings& s, const LightRanges& ranges);

}  // namespace lightgrid
