// Which BRDF a whole image is shaded with.
#pragma once

namespace lightgrid {

enum class Brdf { ggx, blinn, lambert };  // the specular lobe, or none: shared/brdf.h

}  // namespace lightgrid
