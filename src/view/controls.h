// The choices of the window's user. Panels, the mouse, keys and scripts change them; the viewer applies them
// in the next frame.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "plan/settings.h"
#include "scene/light_motion.h"

namespace lightgrid {

// What a side shows.
enum class SideMap { picture, listed, lit, lost, difference };

const std::array<const char*, 5>& map_names();  // by SideMap
// Throws Error(input) that lists the names.
SideMap parse_map(const std::string& name);

struct SideControls {
  std::string technique;
  Settings settings;
  SideMap map = SideMap::picture;
};

// A pixel of the full picture, from the lower left, as in `lightgrid inspect --pixel`.
struct PicturePixel {
  int x = 0, y = 0;
  bool operator==(const PicturePixel&) const = default;
};

struct Controls {
  std::array<SideControls, 2> sides;  // left, right
  double line = 0.5;                  // position of the dividing line, as a fraction of the picture's width
  double rate = 30;  // frames a second to hold while the camera moves; 0: always the full picture
  std::optional<std::string> camera;  // target of a jump, in the form of --camera
  LightMotion lights = LightMotion::none;
  bool playing = false;
  bool step = false;              // advance one frame, then pause
  std::optional<double> seconds;  // jump to this time
  bool draw_always = false;       // even if nothing changed
  bool measure_passes = true;
  std::optional<PicturePixel> pixel;  // the inspected pixel
  std::string pixel_file;             // its lights are written there in this frame; empty: not
  bool screenshot = false;
  bool quit = false;
};

// Input of one frame, from the window or a script.
struct Input {
  std::array<bool, 7> held{};  // by FlightKey
  double x = -1, y = -1;       // pointer, pixels of the window from its upper left
  bool button = false;         // the left one
  // Where the button went down in this frame; without it, at the position of the frame before.
  std::optional<std::array<double, 2>> pressed;
};

enum class FlightKey { forward, left, back, right, down, up, fast };  // W A S D Q E shift

}  // namespace lightgrid
