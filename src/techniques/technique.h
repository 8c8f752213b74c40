// A technique: a name, and a recipe over passes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "passes/passes.h"
#include "scene/listed_lights.h"

namespace lightgrid {

struct Technique {
  const char* name;
  const char* summary;  // one line
  const char* source;   // paper or article, year
  TechniqueNeeds needs;
  std::vector<const char*> settings;  // keys of those that it reads (plan/settings.h)
  Frame (*render)(RenderView& v);
  // What the last frame shaded each pixel of its opaque surfaces with. Null: the frame's light grid or, without one,
  // every light.
  ListedLights (*listed)(RenderView& v) = nullptr;
  // A pixel has places for a limited number of lights; those past it are left out.
  bool limited_lists = false;
};

// The recipe of techniques that shade from a light grid: depth prepass, depth bounds, cull, shade, blended surfaces.
Frame shade_from_light_grid(RenderView& v);

// Blended surfaces over the frame's image, from a grid of their own, which the frame gets, or, where there are no depth
// bounds, from that of opaque ones.
void shade_blended_from_grid(RenderView& v, const DepthBounds& bounds, Frame& frame);

const std::vector<const Technique*>& techniques();

// Keys of the settings that every technique reads.
const std::vector<const char*>& common_settings();
bool reads_setting(const Technique& technique, const std::string& key);

// Those of `settings` that the technique reads, as to_strings has them.
std::map<std::string, std::string> settings_of(const Technique& technique, const Settings& settings);

std::string technique_names();  // "forward, forward_plus, …"

// Throws Error(input) that lists the names there are.
const Technique& find_technique(const std::string& name);

}  // namespace lightgrid
