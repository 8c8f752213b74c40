// Light-indexed deferred rendering (docs/techniques/lidr.md).
#pragma once

#include "plan/settings.h"

namespace lightgrid {

// How several light indices share a pixel, which surfaces of a light's volume are drawn, when lights are
// sorted into groups, and how their types are told apart.
enum class LidrPacking { bitshift, maxblend, sort, maxblend_sort };
enum class LidrVolumes { stencil, front_faces, no_prepass };
enum class LidrSort { view, still };
enum class LidrTypes { flag, passes };

}  // namespace lightgrid

namespace lightgrid::setting {

inline const Setting<LidrPacking> lidr_packing{290,
                                               "lidr-packing",
                                               "how the light indices of a pixel share an image: shifted by "
                                               "blending, maximum and minimum, or a channel each",
                                               {{"bitshift", LidrPacking::bitshift},
                                                {"maxblend", LidrPacking::maxblend},
                                                {"sort", LidrPacking::sort},
                                                {"maxblend-sort", LidrPacking::maxblend_sort}}};

// 0: auto.
inline const Setting<int> lidr_overlap{
    300,
    "lidr-overlap",
    "capacity of a pixel in light indices; auto: the most that the packing can hold for these lights",
    {{"auto", 0}, {"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}, {"16", 16}}};

// 0: auto.
inline const Setting<int> lidr_lights{
    310,
    "lidr-lights",
    "lights that an index can distinguish; auto: the least that suffices for the scene",
    {{"auto", 0}, {"15", 15}, {"255", 255}, {"65535", 65535}}};

inline const Setting<LidrVolumes> lidr_volumes{
    320,
    "lidr-volumes",
    "marks surfaces inside light volumes, by a stencil; or all behind their front faces, which serves "
    "blended surfaces too, also without a depth prepass: whatever is behind",
    {{"stencil", LidrVolumes::stencil},
     {"front-faces", LidrVolumes::front_faces},
     {"no-prepass", LidrVolumes::no_prepass}}};

inline const Setting<LidrTypes> lidr_types{
    340,
    "lidr-types",
    "point and spot lights: in the same images, told apart by the light's data; or a pass over the surfaces "
    "for each, with images and a light loop of its own",
    {{"flag", LidrTypes::flag}, {"passes", LidrTypes::passes}}};

inline const Setting<LidrSort> lidr_sort{350,
                                         "lidr-sort",
                                         "sorted packings: lights in view are put into groups for each view, "
                                         "or all lights once, while they are at rest",
                                         {{"view", LidrSort::view}, {"still", LidrSort::still}}};

inline const Setting<int> lidr_passes{360,
                                      "lidr-passes",
                                      "sorted packings: the most passes over the surfaces; lights that find "
                                      "no group are drawn in the next, after the last they are left out",
                                      {"1", "2", "4", "8", "16"}};

}  // namespace lightgrid::setting
