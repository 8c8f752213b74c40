// Names for OpenCL's error codes, and conversion of its exceptions to Error.
#pragma once

#include <string>

#include "base/error.h"
#include "cl/opencl.h"

namespace lightgrid {

// "CL_OUT_OF_RESOURCES"; an unknown code in digits.
std::string cl_error_name(cl_int code);

// "clCreateBuffer failed with CL_MEM_OBJECT_ALLOCATION_FAILURE", after `context` and a colon if given.
Error cl_machine_error(const cl::Error& error, const std::string& context = "");

}  // namespace lightgrid
