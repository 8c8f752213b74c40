#include "gl/pending_draws.h"

#include "gl/gl.h"

namespace lightgrid {

// Fewer waits of more draws are faster: each begins llvmpipe's work on the image anew.
constexpr size_t most_pending_indices = size_t(5) << 17;

void PendingDraws::add(size_t indices) {
  indices_ += indices;
  if (indices_ < most_pending_indices) return;
  glFinish();
  indices_ = 0;
}

}  // namespace lightgrid
