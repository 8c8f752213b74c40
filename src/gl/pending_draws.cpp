#include "gl/pending_draws.h"

#include <utility>

namespace lightgrid {
namespace {

constexpr size_t indices_of_portion = size_t(1) << 17;

}  // namespace

PendingDraws::~PendingDraws() {
  if (fence_) glDeleteSync(fence_);
}

void PendingDraws::add(size_t indices) {
  indices_ += indices;
  if (indices_ < indices_of_portion) return;
  indices_ = 0;
  const GLsync before = std::exchange(fence_, glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
  if (!before) return;
  constexpr GLuint64 second = 1'000'000'000;
  while (glClientWaitSync(before, GL_SYNC_FLUSH_COMMANDS_BIT, second) == GL_TIMEOUT_EXPIRED) {
  }
  glDeleteSync(before);
}

}  // namespace lightgrid
