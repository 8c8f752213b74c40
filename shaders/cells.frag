// The cell of the light grid that shading finds.
//   GIVEN_DEPTH: from depth values in a texture.
#include "shared/view_params.h"
#include "shaders/lights/cell.glsl"

#ifdef GIVEN_DEPTH
uniform sampler2D given_depth;
#endif

layout(location = 0) out uint cell;

void main() {
#ifdef GIVEN_DEPTH
  cell = cell_at(uvec2(gl_FragCoord.xy), texelFetch(given_depth, ivec2(gl_FragCoord.xy), 0).r);
#else
  cell = cell_here();
#endif
}
