// Shadows (docs/shadows.md).
#pragma once

#include "plan/settings.h"
#include "scene/blended_casters.h"

namespace lightgrid {

// How shadows are found: exactly, from shadow maps (docs/shadow_maps.md), whose pictures are approximate, or
// not at all: light then goes through what hides it.
enum class ShadowMethod { exact, map, none };

// Who finds the shadows of point and spot lights: find_shadows, as for every technique; nobody; or lidr
// itself, by shadow volumes or shadow maps (docs/techniques/lidr.md#shadows).
enum class LidrShadows { pass, none, volumes, prepass, prepass_soft, final_pass };

inline bool filters_maps(const Settings& s);
inline bool has_maps(const Settings& s);
// A share of a light may be hidden from a point.
inline bool picks_shadows(const Settings& s);
inline bool soft_shadows(const Settings& s);
// With shadows found exactly: of a reference.
inline Settings with_exact_shadows(Settings settings);

}  // namespace lightgrid

namespace lightgrid::setting {

inline const Setting<LidrShadows> lidr_shadows{
    380,
    "lidr-shadows",
    "how lidr finds shadows of point and spot lights: exactly, by the shared pass; not at all; by shadow "
    "volumes or shadow maps as light volumes are drawn, hard or with four bits of shadow next to each index; "
    "or by shadow maps of a few lights as surfaces are shaded",
    {{"pass", LidrShadows::pass},
     {"none", LidrShadows::none},
     {"volumes", LidrShadows::volumes},
     {"prepass", LidrShadows::prepass},
     {"prepass-soft", LidrShadows::prepass_soft},
     {"final", LidrShadows::final_pass}},
    {.approximate = [](const Settings& s) { return s[lidr_shadows] != LidrShadows::pass; }}};

inline const Setting<ShadowMethod> shadows{
    550,
    "shadows",
    "exact shadows by rays, approximate ones from shadow maps, or none",
    {{"exact", ShadowMethod::exact}, {"map", ShadowMethod::map}, {"none", ShadowMethod::none}},
    {.common = true,
     .approximate = [](const Settings& s) { return s[shadows] != ShadowMethod::exact; },
     .mean = [](Settings& s) { s = with_exact_shadows(s); }}};

inline const Setting<int> shadow_size{
    560,
    "shadow-size",
    "texels per side of a shadow map's face, for the light with the largest share of the screen",
    {"256", "16", "32", "64", "128", "512", "1024", "2048"},
    {.common = true, .shown = has_maps}};

inline const Setting<int> shadow_bits{570,
                                      "shadow-bits",
                                      "bits per texel of a shadow map; 32 is float",
                                      {"32", "16", "24"},
                                      {.common = true, .shown = has_maps}};

// Texels a side.
inline const Setting<int> shadow_taps{
    580,
    "shadow-filter",
    "texels of a shadow map that a pixel reads: one, or the mean of 3 x 3 or 5 x 5",
    {{"none", 1}, {"pcf3", 3}, {"pcf5", 5}},
    {.common = true, .shown = filters_maps}};

inline const Setting<int> shadow_rays{590,
                                      "shadow-rays",
                                      "rays for each pixel and casting light: one to its centre, or several "
                                      "to a sphere around it, for soft shadows",
                                      {"1", "4", "16", "64", "256"},
                                      {.common = true, .approximate = soft_shadows}};

inline const Setting<double> shadow_source_m{
    600,
    "shadow-source",
    "with shadow-rays: radius of the sphere in metres",
    {"0.05", "0", "0.01", "0.02", "0.1", "0.2", "0.5"},
    {.common = true,
     .shown = [](const Settings& s) { return s[shadows] == ShadowMethod::exact && s[shadow_rays] > 1; }}};

inline const Setting<int> shadow_pick{
    610,
    "shadow-pick",
    "rays per pixel in all, to lights drawn from its list, instead of rays to each light: one estimate of "
    "the hidden share of all its light",
    {{"off", 0}, {"1", 1}, {"4", 4}, {"16", 16}},
    {.common = true, .approximate = picks_shadows, .mean = [](Settings& s) { s.reset(shadow_pick); }}};

inline const Setting<BlendedCasters> shadow_blended{
    620,
    "shadow-blended",
    "how much light blended surfaces hide: none, all, or according to alpha",
    {{"none", BlendedCasters::none}, {"opaque", BlendedCasters::opaque}, {"alpha", BlendedCasters::alpha}},
    {.model = true, .common = true}};

inline const Setting<int> shadow_threshold{
    630,
    "shadow-threshold",
    "lights that together add less than this many steps of the 8-bit display to any surface cast no shadow "
    "on it",
    {{"off", 0}, {"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}, {"16", 16}},
    {.common = true, .shown_if_given = true, .approximate = [](const Settings& s) {
       return s[shadow_threshold] > 0;
     }}};

// In bytes.
inline const Setting<size_t> shadow_memory{
    640,
    "shadow-memory",
    "limit for the memory of a frame's shadows, and again for shadow maps or light cells; beyond it the "
    "frame is shaded in bands, and maps get smaller",
    {{"256M", size_t(256) << 20},
     {"1M", size_t(1) << 20},
     {"4M", size_t(4) << 20},
     {"16M", size_t(16) << 20},
     {"64M", size_t(64) << 20},
     {"1G", size_t(1) << 30}},
    {.common = true, .shown_if_given = true}};

}  // namespace lightgrid::setting

namespace lightgrid {

// LidrShadows::prepass has no filter: one texel decides.
inline bool filters_maps(const Settings& s) {
  const LidrShadows in_lidr = s[setting::lidr_shadows];
  return s[setting::shadows] == ShadowMethod::map || in_lidr == LidrShadows::prepass_soft ||
         in_lidr == LidrShadows::final_pass;
}
inline bool has_maps(const Settings& s) {
  return filters_maps(s) || s[setting::lidr_shadows] == LidrShadows::prepass;
}

inline bool picks_shadows(const Settings& s) {
  return s[setting::shadows] == ShadowMethod::exact && s[setting::shadow_pick] > 0;
}
inline bool soft_shadows(const Settings& s) {
  return s[setting::shadows] == ShadowMethod::exact && s[setting::shadow_rays] > 1 &&
         s[setting::shadow_source_m] > 0;
}

// A shadow map has no share of a light for alpha to hide.
inline BlendedCasters blended_casters(const Settings& s) {
  const BlendedCasters chosen = s[setting::shadow_blended];
  const bool shares = chosen == BlendedCasters::alpha && s[setting::shadows] == ShadowMethod::map;
  return shares ? BlendedCasters::none : chosen;
}

inline Settings with_exact_shadows(Settings settings) {
  return settings.set(setting::shadows, ShadowMethod::exact).set(setting::shadow_threshold, 0);
}

}  // namespace lightgrid
