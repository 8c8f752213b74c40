// Interprets the pointer over the picture: dragging the line, turning the camera, or clicking a pixel.
#pragma once

#include <optional>

#include "view/controls.h"

namespace lightgrid {

struct PointerResult {
  double turn_x = 0, turn_y = 0;      // pixels since the last frame
  std::optional<double> line;         // new position of the line
  std::optional<PicturePixel> click;  // pressed and released at one position
};

class Pointer {
 public:
  // The picture fills the window's upper left, width x height. `free`: no panel takes the pointer. A drag
  // that began over the picture continues over panels.
  PointerResult follow(const Input& input, int width, int height, double line, bool free);

 private:
  enum class Gesture { none, line, look, elsewhere };
  Gesture gesture_ = Gesture::none;
  double x_ = 0, y_ = 0;  // in the last frame
  double moved_px_ = 0;   // since it was pressed
};

}  // namespace lightgrid
