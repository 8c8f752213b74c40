// The texels of an atlas of shadow maps: distances along the face's axis, from 0 to its range.
//
// -DSHADOW_BITS  16 or 24: whole steps of the range, of which the last means nothing; 32: float, metres
#pragma once

#ifndef SHADOW_BITS
#define SHADOW_BITS 32
#endif

#if SHADOW_BITS == 32
typedef float Texel;
#define TEXEL_NOTHING INFINITY
#define texel_scale(range) 1.0f
#define texel_step(range, distance) ((distance)*0x1p-23f)
#else
#define TEXEL_NOTHING ((float)((1 << SHADOW_BITS) - 1))
#define texel_scale(range) ((TEXEL_NOTHING - 1.0f) / (range))
#define texel_step(range, distance) ((range) / (TEXEL_NOTHING - 1.0f))
#if SHADOW_BITS == 16
typedef ushort Texel;
#else
typedef uint Texel;
#endif
#endif
