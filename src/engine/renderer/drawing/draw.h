// Drawing of draw lists.
#pragma once

#include <cstddef>
#include <functional>

#include "gl/gl.h"
#include "renderer/pass_context.h"

namespace lightgrid {

enum class DrawStreams { positions_where_possible, all };

// Draws parts of instances; changes only state that differs from the last bind.
class InstanceDrawer {
 public:
  InstanceDrawer(PassContext& work, DrawStreams streams) : work_(work), streams_(streams) {}

  // Binds the program with the instance's material and matrices; sets winding by whether the instance
  // mirrors, and face culling unless double-sided. The caller may set its own uniforms afterwards.
  void bind(int instance, const SceneProgram& program);
  void draw(const IndexRanges& ranges);

 private:
  PassContext& work_;
  DrawStreams streams_;
  const SceneProgram* program_ = nullptr;
  int material_ = -1, instance_ = -1;
  GLsizei unflushed_indices_ = 0;
};

// Draws a list with a program for each instance's features.
void draw_list(PassContext& work, const DrawList& list, DrawStreams streams, ScenePrograms& programs);

// Draws a list with shaders/triangles.frag. first: of an instance, the number that the shader adds to those
// of its triangles with -DRAY_NUMBERS, else the instance's own.
void draw_triangles(PassContext& work, const DrawList& list, const std::vector<std::string>& defines,
                    const std::function<uint32_t(int instance)>& first);

// A triangle that covers the image (shaders/screen.vert).
void draw_screen(const GlProgram& program);

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
  size_t indices_ = 0;      // indices of this portion
  GLsync drawn_ = nullptr;  // signalled when the portion before is
};

}  // namespace lightgrid
