// Drawing lists of instances.
#pragma once

#include "passes/frame/visible_clusters.h"

namespace lightgrid {

enum class DrawStreams { positions_where_possible, all };

// Draws parts of instances; sets only what the last bind left otherwise.
class InstanceDrawer {
 public:
  InstanceDrawer(Frame& f, DrawStreams streams) : f_(f), streams_(streams) {}

  // The program with the instance's material and matrices, winding by the sign of the determinant, and face culling by
  // double-sidedness. Uniforms of the caller's own may be set after it.
  void bind(int instance, const GlProgram& program);
  void draw(const IndexRanges& ranges);

 private:
  Frame& f_;
  DrawStreams streams_;
  const GlProgram* program_ = nullptr;
  int material_ = -1, instance_ = -1;
  GLsizei unflushed_indices_ = 0;
};

// Draws the instances with the programs that `program_of(features)` names; clusters that the view cannot see are left out,
// also those behind what the depth prepass found, where `distances` tells of it.
void draw_instances(Frame& f, const std::vector<int>& instances, DrawStreams streams,
                    const std::function<const GlProgram&(uint32_t features)>& program_of,
                    const TileDistances* distances = nullptr, DrawOrder order = DrawOrder::front_to_back);

// A triangle over the whole image (shaders/screen.vert).
void draw_screen(const GlProgram& program);

}  // namespace lightgrid
