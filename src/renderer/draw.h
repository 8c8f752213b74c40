// Drawing of draw lists.
#pragma once

#include "renderer/pass_caches.h"

namespace lightgrid {

enum class DrawStreams { positions_where_possible, all };

// Draws parts of instances; changes only state that differs from the last bind.
class InstanceDrawer {
 public:
  InstanceDrawer(Work& work, const Seen& seen, DrawStreams streams)
      : work_(work), seen_(seen), streams_(streams) {}

  // Binds the program with the instance's material and matrices; sets winding by the sign of the determinant,
  // and face culling unless double-sided. The caller may set its own uniforms afterwards.
  void bind(int instance, const SceneProgram& program);
  void draw(const IndexRanges& ranges);

 private:
  Work& work_;
  const Seen& seen_;
  DrawStreams streams_;
  const SceneProgram* program_ = nullptr;
  int material_ = -1, instance_ = -1;
  GLsizei unflushed_indices_ = 0;
};

// Draws a list with a program for each instance's features.
void draw_list(Work& work, const Seen& seen, const DrawList& list, DrawStreams streams,
               ScenePrograms& programs);

// A triangle that covers the image (shaders/screen.vert).
void draw_screen(const GlProgram& program);

}  // namespace lightgrid
