// A material as the shaders see it: one uniform block.
#pragma once

#include "shared/language.h"

#define MATERIAL_BASE_COLOR_MAP 1u
#define MATERIAL_METALLIC_ROUGHNESS_MAP 2u
#define MATERIAL_NORMAL_MAP 4u
#define MATERIAL_OCCLUSION_MAP 8u
#define MATERIAL_EMISSIVE_MAP 16u
#define MATERIAL_MASK 32u
#define MATERIAL_UNLIT 64u
#define MATERIAL_CLEARCOAT 128u
#define MATERIAL_SPECULAR_MAP 256u
#define MATERIAL_SPECULAR_COLOR_MAP 512u
#define MATERIAL_CLEARCOAT_MAP 16777216u
#define MATERIAL_CLEARCOAT_ROUGHNESS_MAP 33554432u
#define MATERIAL_CLEARCOAT_NORMAL_MAP 67108864u
// Bits of uv_flags, shifted by the slot: base colour 0, metallic-roughness 1, normal 2, occlusion 3, emissive
// 4, coat 5, its roughness 6, its normal 7, specular 8, its colour 9.
#define MATERIAL_UV1_FIRST 1u
#define MATERIAL_UV_TRANSFORM_FIRST 65536u
#define MATERIAL_MAPS 10

#ifdef LIGHTGRID_GLSL
layout(std140) uniform MaterialParamsBlock {
  vec4 base_color;
  vec4 emissive;
  vec4 subsurface;  // colour; roll-off, 0: no skin
  float metallic, roughness, normal_scale, occlusion_strength;
  float alpha_cutoff;
  uint flags;
  float clearcoat, clearcoat_roughness, clearcoat_normal_scale;
  float minnaert_k;  // 1: Lambert
  float model;       // its number (scene/material_model.h)
  uint uv_flags;
  vec4 specular;                  // the dielectric's reflectance at normal incidence; its strength
  vec4 uv_linear[MATERIAL_MAPS];  // column by column: u axis, v axis
  vec4 uv_offset[MATERIAL_MAPS];
  // clang-format off
} material;
// clang-format on
#elif !defined(__OPENCL_VERSION__)
namespace lightgrid {
struct MaterialParams {
  float base_color[4];
  float emissive[4];
  float subsurface[4];
  float metallic, roughness, normal_scale, occlusion_strength;
  float alpha_cutoff;
  uint flags;
  float clearcoat, clearcoat_roughness, clearcoat_normal_scale;
  float minnaert_k, model;
  uint uv_flags;
  float specular[4];  // at a multiple of 16 bytes, as a vec4
  float uv_linear[MATERIAL_MAPS][4];
  float uv_offset[MATERIAL_MAPS][4];
};
static_assert(sizeof(MaterialParams) == 432);
}  // namespace lightgrid
#endif
