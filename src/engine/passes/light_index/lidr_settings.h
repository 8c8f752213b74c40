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
                                               "blending, as maximum and minimum, or in a channel each",
                                               {{"bitshift", LidrPacking::bitshift},
                                                {"maxblend", LidrPacking::maxblend},
                                                {"sort", LidrPacking::sort},
                                                {"maxblend-sort", LidrPacking::maxblend_sort}}};

// 0: auto.
inline const Setting<int> lidr_overlap{
    300,
    "lidr-overlap",
    "maximum number of light indices per pixel; auto: as many as the packing can hold for these lights",
    {{"auto", 0}, {"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}, {"16", 16}}};

// 0: auto.
inline const Setting<int> lidr_lights{
    310,
    "lidr-lights",
    "number of lights that an index can distinguish; auto: the smallest that is enough for the scene",
    {{"auto", 0}, {"15", 15}, {"255", 255}, {"65535", 65535}}};

inline const Setting<LidrVolumes> lidr_volumes{
    320,
    "lidr-volumes",
    "surfaces that get a light's index: those inside its volume, by a stencil; those behind its front faces, "
    "also for blended surfaces; or everything behind it, without a depth prepass",
    {{"stencil", LidrVolumes::stencil},
     {"front-faces", LidrVolumes::front_faces},
     {"no-prepass", LidrVolumes::no_prepass}}};

inline const Setting<LidrTypes> lidr_types{340,
                                           "lidr-types",
                                           "point and spot lights share images and are distinguished by the "
                                           "light's data, or each have their own images, pass and light loop",
                                           {{"flag", LidrTypes::flag}, {"passes", LidrTypes::passes}}};

inline const Setting<LidrSort> lidr_sort{350,
                                         "lidr-sort",
                                         "sorted packings: lights in view are put into groups for each view, "
                                         "or all lights once while they do not move",
                                         {{"view", LidrSort::view}, {"still", LidrSort::still}}};

inline const Setting<int> lidr_passes{
    360,
    "lidr-passes",
    "sorted packings: maximum number of passes over the surfaces; lights that fit into no group are drawn in "
    "the next pass, and left out after the last",
    {"1", "2", "4", "8", "16"}};

inline const Setting<bool> lidr_light_block{395,
                                            "lidr-light-data",
                                            "where shaders read the light table: buffer textures, or a "
                                            "uniform block (constants), for up to 255 lights",
                                            {{"textures", false}, {"constants", true}}};

}  // namespace lightgrid::setting
