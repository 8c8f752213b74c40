#pragma once

namespace lightgrid {

// What blended surfaces hide of a light: nothing, all of it as opaque ones do, or the share alpha of what is left of
// it behind those before.
enum class BlendedCasters { none, opaque, alpha };

}  // namespace lightgrid
