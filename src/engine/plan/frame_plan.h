// The requirements of this scene, view and settings for a frame, and their reasons. A pure function: features
// that the plan does not name are not compiled, allocated or run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plan/effect.h"
#include "plan/settings.h"
#include "plan/shadow_plan.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "scene/view_lights.h"

namespace lightgrid {

// The features that a material requires of the shaders, as bits; each is one #define (defines_of).
enum MaterialFeature : uint32_t {
  feature_textured = 1,  // any map at all: first UV set
  feature_uv1 = 2,
  feature_uv_transform = 4,
  feature_vertex_color = 8,
  feature_base_color_map = 16,
  feature_metallic_roughness_map = 32,
  feature_normal_map = 64,
  feature_occlusion_map = 128,
  feature_emissive_map = 256,
  feature_mask = 512,
  feature_unlit = 1024,
  feature_clearcoat = 2048,
  feature_clearcoat_map = 4096,
  feature_clearcoat_roughness_map = 8192,
  feature_clearcoat_normal_map = 16384,
  feature_skin = 32768,
  feature_minnaert = 65536,
  feature_specular = 131072,
  feature_specular_map = 262144,
  feature_specular_color_map = 524288,
  feature_all = 1048575,
  // Base colour and alpha depend on these.
  features_of_base_color =
      feature_textured | feature_uv1 | feature_uv_transform | feature_vertex_color | feature_base_color_map,
};

// The features that shading with this BRDF reads: Lambert has no coat and no specular reflectance.
uint32_t features_read(uint32_t features, Brdf brdf);

std::vector<std::string> defines_of(uint32_t features);

// The features that a mesh with its material requires of shaders and vertex streams.
uint32_t material_features(const Scene& scene, const Mesh& mesh);

struct Decision {
  std::string effect;  // "blend", "spot lights", "normal maps", ...
  bool needed = false;
  std::string why;  // the witness: `material 3 "glass" on node 12 "window"`, or why not
};

// The requirements of a technique for the plan.
struct TechniqueNeeds {
  Effects effects{};  // that its light can have
  bool light_grid = false;
  bool slices = false;              // tiles are cut into depth slices
  bool stencil = false;             // beside the depth buffer
  bool lists = false;               // light code reads lists only, not masks
  bool z_bins = false;              // shading skips lights by z-bins, if the setting z-bins says so
  bool reversed_triangles = false;  // a second index buffer, with each mesh's triangles last to first
  bool opengl = true;               // draws with OpenGL; false: OpenCL alone
  bool chosen_raster = false;       // draws with OpenGL, or with the setting raster=opencl without
  bool world_grid = false;          // light lists in cells of the world
  bool shadows = true;              // light loops ask for shadows
  bool group_tiles = false;         // its tiles may have the light groups of their surfaces
  bool group_stencil = false;       // that of light volumes may test them in the stencil
  bool capped_lists = false;        // its lists and its view may end at a number of lights
  bool sampled_lists = false;       // of these lists, each light may count several times
  int most_samples = 1;             // a pixel, that its passes can take
  bool stored_surfaces = false;     // where OpenCL draws, light passes read surfaces that another pass stored
  bool opengl_samples = true;       // OpenGL on this machine can draw as many as the scene asks for
  // The technique finds those of point and spot lights itself, of so many lights at most; the pass that all
  // techniques share is then left those of directional lights.
  bool own_shadows = false;
  size_t most_own_shadows = SIZE_MAX;
  // Changes these, and the plan's settings, by the technique's own settings. Null: nothing changes.
  void (*adapt)(TechniqueNeeds& needs, Settings& settings) = nullptr;
  // Why the plan has none of them, if it is not the view.
  const char* no_light_grid = "the technique reads none";
  const char* no_slices = "the technique uses none";
  const char* no_shadows = "";
  const char* groups_of = "";       // which lights' groups light loops ask for, if not all lights'
  const char* shadows_by = "rays";  // what finds shadows, in words
};

// Returns whether a technique with these settings draws with OpenGL.
bool draws_with_opengl(const TechniqueNeeds& needs, const Settings& settings);

// The point and spot lights that a plan counts as in view. All but the first serve to build in advance, as
// PlannedInstances do: what passes draw depends on the kinds of lights that they see.
enum class PlannedLights { in_view, every, points, spots, none };

struct FramePlan {
  Settings settings;
  bool opengl = true;  // OpenGL draws the surfaces; else OpenCL does

  // The instances this view may see (conservative frustum test), in scene order; blended ones back to front.
  std::vector<int> opaque, blended;
  std::vector<uint32_t> features_of_instance;  // one for each of the scene's instances; 0 if not in view

  bool light_grid = false;      // culling kernels and the grid's buffers
  bool light_tree = false;      // samples from a tree of all lights, in place of culling
  bool sampled_lists = false;   // longer lists than list-cap become samples
  bool world_grid = false;      // lists in cells of the world
  bool local_lights = false;    // at least one point or spot light
  bool spots = false;           // compile cone code
  bool virtual_lights = false;  // at least one light is a virtual point light
  // Some light of the scene casts a shadow: light loops ask whether it reaches a point
  // (shared/light_table.h). The same for every view and time, so that a camera that moves compiles nothing.
  bool light_reaches = false;
  // Some light or instance of the scene lacks a group: light loops ask whether groups meet
  // (scene/light_groups.h). The same for every view.
  bool groups = false;
  std::vector<uint32_t> group_masks;        // with them: all different masks of instances, and
  std::vector<uint32_t> group_of_instance;  // of each of the scene's instances the index of its own
  bool group_tiles = false;                 // tiles of the light grid have the groups of their surfaces
  int group_stencil = 0;                    // bits of the stencil that have groups; 0: shaders test them
  bool shadows = false;                     // shadows of some light must be found in this frame
  std::vector<LightShadow> casting;         // all lights that cast, in scene order
  // By index into `local` and then into `directional_lights`, 1: of this light. Empty if `shadows` is false.
  std::vector<uint8_t> shadowed;
  // Point and spot lights whose shadows the technique finds itself, likewise by index into `local`; empty if
  // there are none. own_shadows: some light of the scene may be one, as light_reaches.
  std::vector<uint8_t> own_shadowed;
  bool own_shadows = false;
  const char* shadows_by = "rays";  // what finds shadows, in words
  // The most that lights too dim for a shadow (shadow-threshold) add to any pixel, in steps of the 8-bit
  // display.
  double dim_steps = 0;
  bool directional_shadows = false;  // as light_reaches, of directional lights alone
  bool shadow_bytes = false;         // a share of a light may be hidden: a byte a pixel and light, not a bit
  bool directional = false;
  std::vector<const Effect*> effects;  // that the frame needs
  bool blend = false;                  // the blended pass
  bool blend_grid = false;             // a light grid for blended surfaces
  bool base_lighting = false;  // an opaque surface shows more than point, spot and plain ambient light
  bool mask = false;
  bool clearcoat = false;  // an opaque surface has a coat
  // An opaque surface of the scene, in view or not, is skin or Minnaert's, or has a specular reflectance of
  // its own: what light passes over all surfaces are built for, so that a camera that turns builds nothing.
  bool skin = false, minnaert = false, specular = false;
  bool stencil = false;  // 8 bits beside depth
  bool reversed_triangles = false;
  int index_bits = 16;
  int z_bins = 1;                            // 1: off
  int slices = 1;                            // cells a tile, ...
  double slice_near_m = 0, slice_far_m = 0;  // ... between these distances
  uint32_t features = 0;  // union over the instances in view: decides which vertex streams and textures
                          // exist

  std::vector<int> local, directional_lights;  // light indices by kind, in scene order
  int virtual_count = 0;                       // of the scene's lights: virtual point lights
  PlannedLights planned_lights = PlannedLights::in_view;
  int lights_in_view = 0;  // lights whose range touches the view's frustum
  // By index into `local`, 1: left out, since the view has more than view-cap. Empty: none is.
  std::vector<uint8_t> left_out;

  std::vector<Decision> decisions;
};

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

FramePlan plan_frame(const Scene& scene, const View& view, const Settings& settings, TechniqueNeeds needs,
                     PlannedInstances instances = PlannedInstances::in_view,
                     PlannedLights lights = PlannedLights::in_view);

// Returns whether the plan counts a point or spot light as in view; in_view: whether it is.
bool counts_as_seen(PlannedLights planned, const ViewLight& light, bool in_view);

// The plan as `lightgrid plan` prints it.
std::string describe(const FramePlan& plan, const Scene& scene);

}  // namespace lightgrid
