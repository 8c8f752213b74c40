// What the pointer means over the picture: the line is dragged, the camera is turned, or a pixel is clicked.
#pragma once

#include <optional>

#include "view/controls.h"

namespace lightgrid {

struct PointerResult {
  double turn_x = 0, turn_y = 0;      // pixels since the last frame
  std::optional<double> line;         // where the line now is
  std::optional<PicturePixel> click;  // pressed and let go at one place
};

class Pointer {
 public:
  // The picture fills the window's upper left, width x height. `free`: no panel takes the pointer. A drag
  // that began over the picture goes on over panels.
  PointerResult follow(const Input& input, int width, int height, double line, bool free);

 private:
  enum class Gesture { none, line, look, elsewhere };
  Gesture gesture_ = Gesture::none;
  double x_ = 0, y_ = 0;  // in the last frame
  double moved_px_ = 0;   // since it was pressed
};

}  // namespace lightgrid
