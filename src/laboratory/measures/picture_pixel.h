// A pixel as users name it, from the upper left as in files and viewers. Images in memory have row 0 at the
// bottom.
#pragma once

namespace lightgrid::lab {

struct PicturePixel {
  int x = 0, y = 0;
  bool operator==(const PicturePixel&) const = default;
};

// Row counted from the other side.
constexpr int flipped_row(int row, int height) { return height - 1 - row; }

}  // namespace lightgrid::lab
