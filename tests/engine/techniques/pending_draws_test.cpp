// Passes of very many draws let few of them wait (renderer/drawing/draw.h): llvmpipe keeps what waits in
// memory.
#include "renderer/drawing/draw.h"

#include <map>
#include <utility>

#include "gl/gl.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

constexpr size_t portion = size_t(5) << 16;  // indices

// While it lives, counts the indices of draws that no wait has covered yet.
class DrawCounter {
 public:
  DrawCounter() {
    counter = this;
    std::swap(glMultiDrawElementsBaseVertex, multi_draw_);
    std::swap(glDrawElementsBaseVertex, draw_);
    std::swap(glFenceSync, fence_);
    std::swap(glClientWaitSync, wait_);
    std::swap(glDeleteSync, delete_);
  }
  ~DrawCounter() {
    glMultiDrawElementsBaseVertex = multi_draw_;
    glDrawElementsBaseVertex = draw_;
    glFenceSync = fence_;
    glClientWaitSync = wait_;
    glDeleteSync = delete_;
    counter = nullptr;
  }
  DrawCounter(const DrawCounter&) = delete;

  size_t drawn = 0, max_waiting = 0, largest_draw = 0;
  std::map<GLsync, size_t> fences;  // those that live: what had been drawn before each

 private:
  inline static DrawCounter* counter = nullptr;
  size_t done_ = 0;  // of drawn

  void add(size_t indices) {
    drawn += indices;
    largest_draw = std::max(largest_draw, indices);
    max_waiting = std::max(max_waiting, drawn - done_);
  }

  // These have the drivers' functions once they are swapped.
  PFNGLMULTIDRAWELEMENTSBASEVERTEXPROC multi_draw_ = [](GLenum mode, const GLsizei* counts, GLenum type,
                                                        const void* const* indices, GLsizei draws,
                                                        const GLint* base) {
    counter->multi_draw_(mode, counts, type, indices, draws, base);
    size_t sum = 0;
    for (GLsizei i = 0; i < draws; ++i) sum += size_t(counts[i]);
    counter->add(sum);
  };
  PFNGLDRAWELEMENTSBASEVERTEXPROC draw_ = [](GLenum mode, GLsizei count, GLenum type, const void* indices,
                                             GLint base) {
    counter->draw_(mode, count, type, indices, base);
    counter->add(size_t(count));
  };
  PFNGLFENCESYNCPROC fence_ = [](GLenum condition, GLbitfield flags) {
    const GLsync fence = counter->fence_(condition, flags);
    counter->fences[fence] = counter->drawn;
    return fence;
  };
  PFNGLCLIENTWAITSYNCPROC wait_ = [](GLsync fence, GLbitfield flags, GLuint64 ns) {
    const GLenum result = counter->wait_(fence, flags, ns);
    if (result != GL_TIMEOUT_EXPIRED) counter->done_ = std::max(counter->done_, counter->fences.at(fence));
    return result;
  };
  PFNGLDELETESYNCPROC delete_ = [](GLsync fence) {
    counter->delete_(fence);
    counter->fences.erase(fence);
  };
};

// Draws each object once a light.
TEST(PendingDraws, AreFewInAPassOfVeryManyDraws) {
  const Scene scene = find_builtin_scene("hall")->make();
  size_t once = 0;  // indices of all instances: the depth prepass draws no more
  for (const Instance& i : scene.instances) once += scene.meshes[i.mesh].indices.size();
  const View view = default_view(scene, 33, 19);
  TechniqueRun run(test_devices(), scene, view, {}, find_technique("forward_multipass"));
  DrawCounter counter;
  run.run_frame();
  const size_t most = once + 2 * portion + counter.largest_draw;
  EXPECT_LE(counter.max_waiting, most);
  EXPECT_GT(counter.drawn, 3 * most) << "too few draws to show a limit";
  EXPECT_TRUE(counter.fences.empty()) << "fences that nothing deletes";
}

}  // namespace
}  // namespace lightgrid
