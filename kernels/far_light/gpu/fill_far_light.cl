// Fills the volume of far light, for GPUs: a work-item takes a sample. As far_light/cpu/fill_far_light.cl,
// with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/common/light_columns.h"
#include "shared/effects/far_light.h"

kernel void fill_far_light(LIGHT_ARGUMENTS constant FarGrid* grid, global float4* moments) {
  const LightColumns lights = {GIVEN_LIGHTS};
  const uint at = get_global_id(0), samples = grid->size_x * grid->size_y * grid->size_z;
  if (at >= samples) return;
  const uint row = at / grid->size_x;
  const Real3 position = real3(fma((float)(at % grid->size_x), grid->spacing_x, grid->first_x),
                               fma((float)(row % grid->size_y), grid->spacing_y, grid->first_y),
                               fma((float)(row / grid->size_y), grid->spacing_z, grid->first_z));
  const LightSums sum = far_light_of(&lights, grid->lights, position);
  store_far_light(&sum, 0, moments, at, samples);
}
