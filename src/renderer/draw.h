// Drawing lists of a view.
#pragma once

#include <functional>

#include "renderer/render_view.h"

namespace lightgrid {

enum class DrawStreams { positions_where_possible, all };

// Draws parts of instances; sets only what the last bind left otherwise.
class InstanceDrawer {
 public:
  InstanceDrawer(RenderView& v, DrawStreams streams) : v_(v), streams_(streams) {}

  // The program with the instance's material and matrices, winding by the sign of the determinant, and face culling by
  // double-sidedness. Uniforms of the caller's own may be set after it.
  void bind(int instance, const SceneProgram& program);
  void draw(const IndexRanges& ranges);

 private:
  RenderView& v_;
  DrawStreams streams_;
  const SceneProgram* program_ = nullptr;
  int material_ = -1, instance_ = -1;
  GLsizei unflushed_indices_ = 0;
};

// Draws a list with the programs of its instances' features. `features_read`: those that make variants.
void draw_list(RenderView& v, const DrawList& list, DrawStreams streams, ScenePrograms& programs,
               const std::function<uint32_t(uint32_t features)>& features_read = nullptr);

// A triangle over the whole image (shaders/screen.vert).
void draw_screen(const GlProgram& program);

}  // namespace lightgrid
