// A limit on draws that wait to be rasterised, for passes of very many draws.
#pragma once

#include <cstddef>

#include "gl/gl.h"

namespace lightgrid {

// At most two portions of draws wait. llvmpipe stores the vertices and triangles of all draws that it has not
// rasterised yet, hundreds of megabytes if a scene is drawn once a light, and keeps this
// memory until the context ends.
class PendingDraws {
 public:
  PendingDraws() = default;
  ~PendingDraws();
  PendingDraws(const PendingDraws&) = delete;

  // After each draw. May wait for an earlier one.
  void add(size_t indices);

 private:
  size_t indices_ = 0;      // since the last fence
  GLsync fence_ = nullptr;  // after the portion before
};

}  // namespace lightgrid
