// Point and spot lights by index, where nothing asks for their shadows.
//
// -DSPOTS, -DVIRTUAL_LIGHTS, -DWINDOW_SMOOTH, -DWINDOW_NONE, -DLEAST_FALLOFF  shared/light_table.h,
// shared/punctual_light.h
#pragma once

#include "shared/punctual_light.h"

typedef struct LightColumns {
  LIGHT_TABLE(LIGHT_ARRAY)
} LightColumns;

static inline PunctualLight light_at(const LightColumns* lights, uint index) {
  PunctualLight light;
  LIGHT_TABLE(LIGHT_ELEMENT)
  return light;
}
