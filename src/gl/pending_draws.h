// A limit on draws that wait to be rasterised, for passes of very many draws.
#pragma once

#include <cstddef>

#include "gl/gl.h"

namespace lightgrid {

// llvmpipe stores the vertices and triangles of all draws that it has not rasterised yet, hundreds of
// megabytes if a scene is drawn once a light, and keeps this memory until the context ends.
class PendingDraws {
 public:
  PendingDraws() = default;
  ~PendingDraws();
  PendingDraws(const PendingDraws&) = delete;
  PendingDraws& operator=(const PendingDraws&) = delete;

  // After each draw. At the end of each portion of many indices, waits for the portions before it.
  void add(size_t indices);

 private:
  size_t indices_ = 0;      // of this portion
  GLsync drawn_ = nullptr;  // signalled when the portion before is
};

}  // namespace lightgrid
