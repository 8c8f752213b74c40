// The options of pictures that are for looking, not for measuring.
#pragma once

#include <string>
#include <vector>

#include "base/display.h"
#include "command_line/command_line.h"
#include "run/scene_choice.h"
#include "techniques/technique.h"

namespace lightgrid::app {

struct LookOptions {
  bool look = false;
  std::string curve;  // neutral or filmic; empty: filmic with `look`, otherwise neutral
  std::string glow;   // share of the light; empty: 0.06 with `look`, otherwise 0
};

void add_look_options(Subcommand& command, LookOptions& options);

// With `look`: the choices that are not given become shadows of all lights, a sky in place of ambient light,
// and four samples if each of the techniques can draw them with shadows. Logs one line. Call it before the
// scene is loaded.
void choose_look(const LookOptions& options, const std::vector<const Technique*>& techniques,
                 SceneChoice& choice);
// chosen_exposure; with `look` built-in scenes, which have none by default, get half of the automatic one's
// stops: all of them would turn their nights into days.
Exposure exposure_of_look(const LookOptions& options, const SceneChoice& choice, const Image& image);

// Throws Error(input) for an unknown curve or a glow that is no share.
Display chosen_display(const LookOptions& options, const Exposure& exposure = {});

}  // namespace lightgrid::app
