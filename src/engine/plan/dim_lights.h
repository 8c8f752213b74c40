// Lights whose shadows the 8-bit display cannot show, with the setting shadow-threshold.
#pragma once

#include "plan/frame_plan.h"
#include "plan/settings/shadows.h"

namespace lightgrid {

// The least change of linear radiance that moves a picture's channel by a step of the display, 1/255, at this
// exposure, wherever it begins. sRGB is steepest at black (12.92). The tone map (base/image.h) changes a
// channel by no more than 1.15 of the largest change of any: what it subtracts, the darkest channel's, grows
// by less than that channel; the compressed peak and the scale of the others to it move against each other;
// and the mix with white moves by 0.15 of the peak at most.
double display_step(double ev);

// The largest product of BRDF and cosine over all directions, of any channel. Infinite where no bound was
// derived: coats, other reflectances than glTF's default, skin, Minnaert, vertex colours, Blinn-Phong. With
// GGX, D <= 1 / (pi alpha^2), V n.l <= 1 / (2 alpha), F <= 1; a roughness map may reach ROUGHNESS_FLOOR.
double max_reflected(const Scene& scene, int instance, Brdf brdf);

// The irradiance that a point or spot light brings no nearer than this, of its brightest channel.
double max_irradiance(const Light& light, double range_m, const LightRanges& ranges, double nearest_m);

// Those of `casting` whose need is `rays` become too_dim, the dimmest first, as long as all of them together
// add less than shadow-threshold steps to any instance in view. Returns how many steps they may
// add. light_prepass's own reflection is not bounded by it. Throws Error(input) if the exposure is not known.
double leave_out_dim_lights(const Scene& scene, const View& view, const Settings& settings,
                            const std::vector<int>& opaque, const std::vector<int>& blended,
                            std::vector<LightShadow>& casting);

}  // namespace lightgrid
