// Drawing lists of instances.
#pragma once

#include "passes/frame/visible_clusters.h"

namespace lightgrid {

enum class DrawStreams { positions_where_possible, all };

// front_to_back: by layers of distance, and within each as given. Passes over the same instances in the same order agree
// on what is seen where surfaces share a depth: what comes last.
enum class DrawOrder { front_to_back, as_given };

// Draws the instances with the programs that `program_of(features)` names; clusters that the view cannot see are left out,
// also those behind what the depth prepass found, where `distances` tells of it. Binds materials, sets winding by the sign
// of the determinant and face culling by double-sidedness. Consecutive draws of one program and material share their state.
void draw_instances(Frame& f, const std::vector<int>& instances, DrawStreams streams,
                    const std::function<const GlProgram&(uint32_t features)>& program_of,
                    const TileDistances* distances = nullptr, DrawOrder order = DrawOrder::front_to_back);

// A triangle over the whole image (shaders/screen.vert).
void draw_screen(const GlProgram& program);

}  // namespace lightgrid
