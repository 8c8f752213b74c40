// The functions behind builtin_scenes().
#pragma once

#include "scene/scene.h"

namespace lightgrid {

Scene make_hall();
Scene make_spheres();
Scene make_terrain();
Scene make_street();
Scene make_particles();
Scene make_gallery();

}  // namespace lightgrid
