// Builds of kernels.
#pragma once

#include "plan/settings.h"
#include "shared/cull_settings.h"

namespace lightgrid::setting {

inline const Setting<KernelShape> kernel_shape{
    280,
    "kernel-shape",
    "lanes (vectors, for CPUs) or group (work-groups, for GPUs)",
    {{"auto", KernelShape::automatic}, {"lanes", KernelShape::lanes}, {"group", KernelShape::group}},
    {.tunable = true}};

inline const Setting<bool> portable{680,
                                    "portable",
                                    "plain OpenCL C, without builtins that only some CPUs have",
                                    {{"off", false}, {"on", true}},
                                    {.tunable = true}};

// 0: the culler's own choice.
inline const Setting<int> group_size{
    690,
    "group-size",
    "work-items that cull a block of 4 x 4 tiles, in the group shape",
    {{"auto", 0}, {"64", 64}, {"128", 128}, {"256", 256}, {"512", 512}, {"1024", 1024}},
    {.tunable = true}};

inline const Setting<bool> everything_on{700,
                                         "everything-on",
                                         "build and run every effect's code, needed or not (to test plans)",
                                         {{"off", false}, {"on", true}},
                                         {.common = true}};

}  // namespace lightgrid::setting
