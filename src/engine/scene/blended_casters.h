// The setting shadow-blended.
#pragma once

namespace lightgrid {

// The part of a light that a blended surface hides.
enum class BlendedCasters {
  none,    // nothing
  opaque,  // all of it, as an opaque one does
  alpha    // the share alpha of what other blended surfaces let through
};

}  // namespace lightgrid
