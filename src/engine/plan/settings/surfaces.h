// How surfaces and the volumes of lights are drawn and stored.
#pragma once

#include "plan/settings.h"

namespace lightgrid {

// How deferred light volumes skip pixels out of a light's reach (passes/shade_light_volumes.cpp).
enum class VolumeCulling { back_faces, stencil, scissor, depth_bounds };

// The mesh that stands for a light's ball: docs/light_volumes.md.
enum class VolumeMeshes { automatic, icosahedron, box };

// Who rasterises, in techniques that leave the choice: OpenGL, or OpenCL (raster/raster_view.h), which then
// needs no OpenGL.
enum class RasterApi { opengl, opencl };

// How the resolve passes keep a material's maps (upload/scene_surfaces.h).
enum class TexelLayout { packed, packed_8, separate };

}  // namespace lightgrid

namespace lightgrid::setting {

inline const Setting<int> buffer_bits{
    190,
    "buffer-bits",
    "bits per channel of the geometry buffer, or of light_prepass's light buffer: 32 is float; fewer are "
    "fixed point, in the light buffer half floats with 16 bits",
    {"32", "16", "8"}};

inline const Setting<VolumeCulling> volume_culling{
    200,
    "volume-culling",
    "how light volumes skip pixels that the light does not reach",
    {{"back-faces", VolumeCulling::back_faces},
     {"stencil", VolumeCulling::stencil},
     {"scissor", VolumeCulling::scissor},
     {"depth-bounds", VolumeCulling::depth_bounds}}};

inline const Setting<VolumeMeshes> volume_mesh{
    400,
    "volume-mesh",
    "the mesh of a light's volume; auto: more faces if it is larger on screen",
    {{"auto", VolumeMeshes::automatic},
     {"icosahedron", VolumeMeshes::icosahedron},
     {"box", VolumeMeshes::box}}};

inline const Setting<RasterApi> raster{
    410,
    "raster",
    "the API that draws triangles: OpenGL, or OpenCL as in visibility, which needs no OpenGL",
    {{"opengl", RasterApi::opengl}, {"opencl", RasterApi::opencl}}};

inline const Setting<TexelLayout> texels{
    460,
    "texels",
    "textures in OpenCL: the maps of a material in one texel of 16 or 8 bytes if their sizes agree, or each "
    "by itself",
    {{"16", TexelLayout::packed}, {"8", TexelLayout::packed_8}, {"separate", TexelLayout::separate}}};

}  // namespace lightgrid::setting

namespace lightgrid {

// The most bits that group-stencil may use: counting faces needs one of the 8.
inline int max_stencil_masks(VolumeCulling culling) { return culling == VolumeCulling::stencil ? 7 : 8; }

}  // namespace lightgrid
