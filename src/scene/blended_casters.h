// The setting shadow-blended.
#pragma once

namespace lightgrid {

// What a blended surface hides of a light.
enum class BlendedCasters {
  none,    // nothing
  opaque,  // all of it, as an opaque one does
  alpha    // the share alpha of what other blended surfaces let through
};

}  // namespace lightgrid
