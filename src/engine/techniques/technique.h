// A technique: a name, and a sequence of passes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "effects/effects.h"
#include "passes/surfaces.h"

namespace lightgrid {

// The unit that has a list in Frame::listed: an estimate of its memory. cell: or fewer.
enum class ListedBy { cell, object, pixel };

struct Technique {
  const char* name;
  const char* summary;  // one line
  const char* source;   // paper or article, year
  TechniqueNeeds needs;
  std::vector<const char*> settings;  // keys of the settings that it reads (plan/settings.h)
  Frame (*render)(RenderView& v);
  ListedBy listed_by = ListedBy::cell;
  // A pixel holds a limited number of lights; further ones are left out.
  bool limited_lists = false;
  // Its picture is not forward's, by nature: lists and images need not be exact.
  bool approximate = false;
};

// Returns whether the technique with these settings rasterises and filters by its own code, in OpenCL: at
// silhouettes, where surfaces share a depth and in minified textures its image differs from one that OpenGL
// draws.
inline bool own_surfaces(const Technique& technique, const Settings& settings) {
  return !draws_with_opengl(technique.needs, settings);
}

const std::vector<const Technique*>& techniques();

// Keys of the settings that every technique reads.
const std::vector<const char*>& common_settings();
bool reads_setting(const Technique& technique, const std::string& key);

// Returns whether with these settings lists may lack lights by design.
bool limits_lists(const Technique& technique, const Settings& settings);

// Returns whether its pictures are random with these settings: by the lights' ranges, or by sampled lists.
bool is_random(const Technique& technique, const Settings& settings);

// Returns whether with these settings its picture differs from forward's by design, or shadows are inexact.
bool is_approximate(const Technique& technique, const Settings& settings);

// The technique's frame, its image of one sample per pixel, with its shadows.
Frame draw_frame(const Technique& technique, RenderView& v);

// The most samples a pixel that the technique can take with these settings.
int max_samples(const Technique& technique, const Settings& settings);
// Throws Error(input) where the setting samples is more.
void check_samples(const Technique& technique, const Settings& settings);

// The subset of `settings` that the technique reads, as to_strings returns them.
std::map<std::string, std::string> settings_of(const Technique& technique, const Settings& settings);

std::string technique_names();  // "forward, forward_plus, …"

// Throws Error(input) that lists the known names.
const Technique& find_technique(const std::string& name);

}  // namespace lightgrid
