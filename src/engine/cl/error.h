// Names for OpenCL's error codes, and conversion of its exceptions to Error.
#pragma once

#include <new>
#include <optional>
#include <string>

#include "base/error.h"
#include "cl/opencl.h"

namespace lightgrid {

// "CL_OUT_OF_RESOURCES"; an unknown code in digits.
std::string cl_error_name(cl_int code);

// "clCreateBuffer failed with CL_MEM_OBJECT_ALLOCATION_FAILURE", after `context` and a colon if given.
Error cl_machine_error(const cl::Error& error, const std::string& context = "");

// Runs `work`. Returns why it failed: the Error that it threw, or one for an OpenCL failure or lack of
// memory.
template <typename Work>
std::optional<Error> failure_of(const Work& work) {
  try {
    work();
    return {};
  } catch (const Error& error) {
    return error;
  } catch (const cl::Error& error) {
    return cl_machine_error(error);
  } catch (const std::bad_alloc&) {
    return machine_error("out of memory");
  }
}

}  // namespace lightgrid
