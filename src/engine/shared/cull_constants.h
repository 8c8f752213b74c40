// Numbers that the culling kernels and the code that launches them share. Compiles as C++ and as OpenCL C.
#pragma once

// Stands for infinity: its square is finite in float, so no test meets inf - inf or 0 * inf.
#define FAR_AWAY 1e18f
// Relative error of a distance computed from depth. It allows for a shader's division that is 2.5 units off:
// docs/hard_cases.md#slack.
#define WIDEN 4.8e-7f
// view_from_world may lengthen a vector by this part of it: check_rigid bounds each entry of M M^T - 1 by
// 1e-5, so its norm by 3e-5.
#define MAX_STRETCH 1.5e-5f
// GPUs cull by blocks of BLOCK_TILES x BLOCK_TILES tiles. A work-group of
// culling/gpu/project_lights.cl takes PROJECT_GROUP lights.
#define BLOCK_TILES 4u
#define PROJECT_GROUP 128
