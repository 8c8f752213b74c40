#include "gl/pending_draws.h"

#include <utility>

namespace lightgrid {

// One portion is rasterised while the next is drawn, so that at most two wait. Fewer waits of more draws are
// faster: docs/techniques/forward_multipass.md.
constexpr size_t portion_indices = size_t(5) << 16;

PendingDraws::~PendingDraws() {
  if (drawn_) glDeleteSync(drawn_);
}

void PendingDraws::add(size_t indices) {
  indices_ += indices;
  if (indices_ < portion_indices) return;
  indices_ = 0;
  const GLsync before = std::exchange(drawn_, glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
  glFlush();
  if (!before) return;
  constexpr GLuint64 second = 1'000'000'000;
  while (glClientWaitSync(before, 0, second) == GL_TIMEOUT_EXPIRED) {
  }
  glDeleteSync(before);
}

}  // namespace lightgrid
