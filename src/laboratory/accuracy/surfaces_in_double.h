// Images against light and surfaces both in double: whose attributes, textures and light are nearer to the
// scene's. The oracle (oracle_sample.h) shades surfaces that OpenGL drew, and so does not show their errors.
#pragma once

#include "accuracy/shadow_truth.h"
#include "measures/results.h"
#include "run/frames.h"

namespace lightgrid::lab {

struct SurfacesInDouble {
  std::vector<uint32_t> pixels;
  std::vector<glm::dvec3> radiance;
};

// At those of `pixels` whose centre the triangle that `shown` has there covers in double too, and where no
// shadow turns on rounding; a triangle a pixel, row 0 at the bottom. shadows: null: it finds them itself.
SurfacesInDouble surfaces_in_double(const RenderView& v, const std::vector<SceneTriangle>& shown,
                                    const std::vector<uint32_t>& pixels, ShadowTruth* shadows = nullptr);

// brightest: the reference's brightest channel.
SurfacesError surfaces_error(const Image& image, const SurfacesInDouble& in_double, double brightest);

// `own` and `shown`: of each pixel of the image and of the reference. Relative to the reference's brightest
// channel.
SilhouetteError silhouette_error(const Image& image, const std::vector<SceneTriangle>& own,
                                 const Image& reference, const ShownTriangles& shown);

}  // namespace lightgrid::lab
