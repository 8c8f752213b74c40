// The scene's surfaces as the resolve kernels read them from OpenCL memory: the attributes of vertices,
// instances and materials. 32-bit members only: C++ and OpenCL C lay them out alike.
#pragma once

#include "shared/language.h"

#define SURFACE_NONE 0xffffffffu  // in a visibility buffer: no triangle

// A map of SurfaceMaterial.
#define SURFACE_BASE_COLOR 0
#define SURFACE_METALLIC_ROUGHNESS 1
#define SURFACE_NORMAL 2
#define SURFACE_OCCLUSION 3
#define SURFACE_EMISSIVE 4
#define SURFACE_COAT 5
#define SURFACE_COAT_ROUGHNESS 6
#define SURFACE_COAT_NORMAL 7
#define SURFACE_SPECULAR 8
#define SURFACE_SPECULAR_COLOR 9
#define SURFACE_MAPS 10

// SurfaceMaterial::flags. A map that is there has the bit 1 << its number.
#define SURFACE_PACKED 65536u  // maps 0 to 2 are one chain of 16-byte texels, which maps[0] describes
#define SURFACE_UNLIT 131072u
#define SURFACE_DOUBLE_SIDED 262144u

// SurfaceMap::flags.
#define MAP_CLAMP_U 1u
#define MAP_MIRROR_U 2u
#define MAP_CLAMP_V 4u
#define MAP_MIRROR_V 8u
#define MAP_MAGNIFY_NEAREST 16u
#define MAP_MINIFY_NEAREST 32u  // within a level
#define MAP_LEVEL_NEAREST 64u   // between levels
#define MAP_UV1 128u
#define MAP_TRANSFORM 256u

#define MAP_LEVELS 16  // sides of up to 32,768 texels

// SurfaceInstance::flags.
#define INSTANCE_MIRRORED 1u      // front faces turn clockwise
#define INSTANCE_NUMBER_SHIFT 8u  // the other bits: its number (MaskPlan::of_instance)

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

// A cache line. What the mesh lacks is zero, but its colour is 1.
typedef struct SurfaceVertex {
  float normal_x, normal_y, normal_z;  // object space
  float handedness;                    // sign of the bitangent
  float tangent_x, tangent_y, tangent_z, spare;
  float u0, v0, u1, v1;
  float red, green, blue, alpha;
} SurfaceVertex;

// A texture as one material uses it: a chain of mip levels (renderer/upload/texel_chain.h).
typedef struct SurfaceMap {
  uint base;           // first texel of the chain
  uint width, height;  // level 0, texels
  uint last_level;
  uint flags;
  uint spare;
  uint level_first[MAP_LEVELS];      // texels after `base`
  float uv_linear[4], uv_offset[2];  // KHR_texture_transform: columns u and v, offset
} SurfaceMap;

typedef struct SurfaceMaterial {
  float base_color[4];
  float emissive[3];
  float metallic, roughness, normal_scale, occlusion_strength, alpha_cutoff;
  uint flags;
  uint alpha_base;  // the first texel of a masked base colour map's chain of alphas
  float coat, coat_roughness, coat_normal_scale;  // KHR_materials_clearcoat
  float subsurface[3], roll_off, minnaert_k;      // scene/material_model.h
  float model;                                    // its number
  float f0[3], specular;                          // the dielectric's reflectance; its strength
  SurfaceMap maps[SURFACE_MAPS];
} SurfaceMaterial;

// In the rasteriser's order of instances. Matrices to view space, row by row.
typedef struct SurfaceInstance {
  float normal[9], direction[9];  // matrices of normals (the inverse transpose) and of tangents
  uint material, flags;
} SurfaceInstance;

#if !defined(__OPENCL_VERSION__)
}  // namespace lightgrid
#endif
