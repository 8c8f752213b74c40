// What the user of the window chose. Panels, the mouse, keys and scripts change it; the viewer follows it in
// the next frame.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "plan/settings.h"
#include "scene/light_motion.h"

namespace lightgrid {

// What a side shows instead of its picture.
enum class SideMap { picture, listed, lit, lost, difference };

const std::array<const char*, 5>& map_names();  // by SideMap
// Throws Error(input) that lists the names.
SideMap parse_map(const std::string& name);

struct SideControls {
  std::string technique;
  Settings settings;
  SideMap map = SideMap::picture;
};

// A pixel of the full picture, from the lower left as in `lightgrid inspect --pixel`.
struct PicturePixel {
  int x = 0, y = 0;
  bool operator==(const PicturePixel&) const = default;
};

struct Controls {
  std::array<SideControls, 2> sides;  // left, right
  double line = 0.5;                  // where the two meet, as a fraction of the picture's width
  double rate = 30;  // frames a second to hold while the camera moves; 0: the picture is always full
  std::optional<std::string> camera;  // to go to, in the form of --camera
  LightMotion lights = LightMotion::none;
  bool playing = false;
  bool step = false;              // one frame of time, then pause
  std::optional<double> seconds;  // time to go to
  bool draw_always = false;       // also when nothing changed
  bool measure_passes = true;
  std::optional<PicturePixel> pixel;  // that is inspected
  bool screenshot = false;
  bool quit = false;
};

// What the window or a script feeds in one frame.
struct Input {
  std::array<bool, 7> held{};  // by FlightKey
  double x = -1, y = -1;       // of the pointer: pixels of the window from its upper left
  bool button = false;         // the left one
  double scroll = 0;
};

enum class FlightKey { forward, left, back, right, down, up, fast };  // W A S D Q E shift

}  // namespace lightgrid
