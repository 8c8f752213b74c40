// The surfaces that a frame draws, and what they require of passes.
#pragma once

#include "plan/decision.h"
#include "plan/material_features.h"
#include "plan/settings.h"
#include "scene/camera.h"

namespace lightgrid {

// The instances that a plan is for. All but the first serve to build in advance what other views of the scene
// need (RenderView::prepare).
enum class PlannedInstances {
  in_view,
  every,
  plain,            // opaque, unmasked, without base lighting and without a coat
  plain_or_masked,  // and masked ones
  plain_or_coated,  // and those under a coat
  uncoated          // all but those under a coat
};

struct SurfaceNeeds {
  bool opengl = true;               // draws with OpenGL; false: only with OpenCL
  bool chosen_raster = false;       // draws with OpenGL, or with the setting raster=opencl without
  bool stencil = false;             // next to the depth buffer
  bool reversed_triangles = false;  // a second index buffer, with each mesh's triangles last to first
  bool stored = false;              // where OpenCL draws, light passes read surfaces that another pass stored
};

struct SurfacePlan {
  // The instances this view may see (conservative frustum test), in scene order; blended ones back to front.
  std::vector<int> opaque, blended;
  std::vector<uint32_t> features_of_instance;  // one for each of the scene's instances; 0 if not in view
  uint32_t features = 0;  // union over the instances in view: decides which vertex streams and textures exist
  double farthest_m = 0;  // of the instances in view
  bool blend = false;     // the blended pass
  bool base_lighting = false;  // an opaque surface shows more than point, spot and plain ambient light
  bool mask = false;
  bool clearcoat = false;  // an opaque surface has a coat
  // An opaque surface of the scene, in view or not, is skin or Minnaert's, or has a specular reflectance of
  // its own: what light passes over all surfaces are built for, so that a camera that turns builds nothing.
  bool skin = false, minnaert = false, specular = false;
};

SurfacePlan plan_surfaces(const Scene& scene, const View& view, const Settings& settings,
                          PlannedInstances instances, Decisions& decisions);
void plan_every_feature(const Settings& settings, SurfacePlan& surfaces);

// The first opaque instance that is emissive, unlit or has an occlusion map; -1: none has.
int first_with_base_lighting(const Scene& scene, const SurfacePlan& surfaces);

// `material 3 "glass" on node 12 "window"`.
std::string instance_witness(const Scene& scene, int instance);
std::string blend_witness(const Scene& scene, const SurfacePlan& surfaces);  // if there is one

}  // namespace lightgrid
