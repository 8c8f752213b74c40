// The OpenCL C++ bindings as this project uses them: version 1.2 of the API, which every driver has, and
// exceptions (cl/error.h converts them).
#pragma once

// Options of the OpenCL bindings.
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>
