// Which BRDF a whole image is shaded with.
#pragma once

namespace lightgrid {

enum class Brdf { ggx, blinn };  // the specular lobe: shared/brdf.h

}  // namespace lightgrid
