// Fills the volume of far light, for CPUs: a work-item takes 16 samples, one after the other in memory.
//
// LIGHT_ARGUMENTS  shared/light_table.h; positions along the world's axes from the volume's origin
// grid             where samples lie, and the number of lights (shared/effects/far_light.h)
// moments          out: FAR_PLANES vectors a sample, plane after plane, x fastest
// -DSPOTS, -DVIRTUAL_LIGHTS, -DWINDOW_SMOOTH, -DWINDOW_NONE  shared/light_table.h, shared/punctual_light.h
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/common/pack.h"
#include "kernels/common/light_columns.h"
#include "kernels/common/one_item.h"
#include "shared/effects/far_light.h"

kernel ONE_ITEM void fill_far_light(LIGHT_ARGUMENTS constant FarGrid* grid, global float4* moments) {
  ASSUME_ONE_ITEM;
  const LightColumns lights = {GIVEN_LIGHTS};
  const uint first = 16 * get_global_id(0), samples = grid->size_x * grid->size_y * grid->size_z;
  const whole at = LANE_INDEX + (whole)((int)first), size_x = (int)grid->size_x, size_y = (int)grid->size_y;
  const whole row = at / size_x;
  const Real3 position = real3(fma(TO_REAL(at % size_x), REAL(grid->spacing_x), REAL(grid->first_x)),
                               fma(TO_REAL(row % size_y), REAL(grid->spacing_y), REAL(grid->first_y)),
                               fma(TO_REAL(row / size_y), REAL(grid->spacing_z), REAL(grid->first_z)));
  const LightSums sum = far_light_of(&lights, grid->lights, position);
  for (uint i = 0; i < 16 && first + i < samples; ++i) store_far_light(&sum, i, moments, first + i, samples);
}
