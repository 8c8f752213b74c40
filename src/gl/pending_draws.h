// A limit on draws that wait to be rasterised, for passes of very many draws.
#pragma once

#include <cstddef>

namespace lightgrid {

// llvmpipe stores the vertices and triangles of all draws that it has not rasterised yet, hundreds of
// megabytes if a scene is drawn once a light, and keeps this memory until the context ends.
class PendingDraws {
 public:
  // After each draw. Waits for all of them once they have many indices.
  void add(size_t indices);

 private:
  size_t indices_ = 0;  // since the last wait
};

}  // namespace lightgrid
