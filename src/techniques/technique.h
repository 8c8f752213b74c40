// A technique: a name, and a sequence of passes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "passes/common/frame.h"
#include "scene/listed_lights.h"

namespace lightgrid {

struct Technique {
  const char* name;
  const char* summary;  // one line
  const char* source;   // paper or article, year
  TechniqueNeeds needs;
  std::vector<const char*> settings;  // keys of the settings that it reads (plan/settings.h)
  Frame (*render)(RenderView& v);
  // The lights that the last frame used at each pixel of opaque surfaces, if the frame has no light grid.
  // Null: every light.
  ListedLights (*listed)(RenderView& v) = nullptr;
  // The same for techniques whose lists follow from a pixel's depth: that of the frame's surfaces, row 0 at
  // the bottom.
  ListedLights (*listed_at)(RenderView& v, const std::vector<float>& depth) = nullptr;
  // A pixel holds a limited number of lights; further ones are left out.
  bool limited_lists = false;
  // Its picture is not forward's, by nature: lists and images need not be exact.
  bool approximate = false;
};

// Whether the technique with these settings rasterises and filters by its own code, in OpenCL: at
// silhouettes, where surfaces share a depth and in minified textures its image differs from one that OpenGL
// draws.
inline bool own_surfaces(const Technique& technique, const Settings& settings) {
  return !draws_with_opengl(technique.needs, settings);
}

// The frame of techniques that shade from a light grid: depth prepass, depth bounds, cull, shade, blended
// surfaces.
Frame shade_from_light_grid(RenderView& v);

// Blends blended surfaces over the frame's image. With depth bounds, they get a grid of their own, stored in
// the frame; without, they use that of opaque surfaces.
void shade_blended_from_grid(RenderView& v, const DepthBounds& bounds, Frame& frame);

// The same over an image in OpenCL, from triangles that OpenCL rasterises.
void blend_resolved_from_grid(RenderView& v, const DepthBounds& bounds, Frame& frame);

const std::vector<const Technique*>& techniques();

// Keys of the settings that every technique reads.
const std::vector<const char*>& common_settings();
bool reads_setting(const Technique& technique, const std::string& key);

// The subset of `settings` that the technique reads, as to_strings returns them.
std::map<std::string, std::string> settings_of(const Technique& technique, const Settings& settings);

std::string technique_names();  // "forward, forward_plus, …"

// Throws Error(input) that lists the known names.
const Technique& find_technique(const std::string& name);

}  // namespace lightgrid
