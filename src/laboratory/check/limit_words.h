// Sentences about limits and the lights that they drop.
#pragma once

#include "check/light_limits.h"

namespace lightgrid::lab {

std::string name_of_light(int light, const Scene& scene);           // `light 17 "lamp"`
std::string words_of(const LimitPlace& place, const Scene& scene);  // `frame 3, mesh 4 "floor"`
// `light 17 "lamp" (frame 3, mesh 4 "floor"; 2 meshes)`
std::string words_of(const DroppedLight& dropped, const EngineLimit& limit, const Scene& scene);

// How full the worst place is; of a limit that does not hold also which lights it drops, at most
// `max_lights` by name, and what to change.
std::vector<std::string> sentences_of(const LimitResult& result, const Scene& scene, size_t max_lights);

}  // namespace lightgrid::lab
