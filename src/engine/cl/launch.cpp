#include "cl/launch.h"

#include <algorithm>

namespace lightgrid {
namespace {

// The driver may have them only for programs that it built from source itself.
std::vector<std::string> parameters_of(const cl::Kernel& kernel, size_t count) {
  std::vector<std::string> names;
  try {
    for (cl_uint i = 0; i < count; ++i) names.push_back(kernel.getArgInfo<CL_KERNEL_ARG_NAME>(i).c_str());
  } catch (const cl::Error&) {
    return {};
  }
  return names;
}

}  // namespace

NamedKernel::NamedKernel(ProgramCache& programs, const std::string& file, const std::string& defines)
    : programs_(&programs), file_(file), defines_(defines + " -cl-kernel-arg-info") {
  if (!programs.request(file_, defines_)) find();
}

void NamedKernel::find() {
  kernel_ = programs_->kernel(file_, defines_);
  count_ = kernel_.getInfo<CL_KERNEL_NUM_ARGS>();
  parameters_ = parameters_of(kernel_, count_);
}

void NamedKernel::launch(ClDevice& device, const std::string& label, const cl::NDRange& global,
                         const cl::NDRange& local, const ClArguments& arguments) {
  if (device.dry_run) return;
  if (!kernel_()) find();
  for (size_t i = 0; i < std::max(count_, arguments.size()); ++i) {
    const bool both = i < count_ && i < arguments.size();
    if (both && (parameters_.empty() || parameters_[i] == arguments[i].name)) continue;
    throw machine_error("kernels/{}.cl: its parameter {} is \"{}\", the argument is \"{}\"", file_, i,
                        i < parameters_.size() ? parameters_[i] : "",
                        i < arguments.size() ? arguments[i].name : "");
  }
  try {
    for (cl_uint i = 0; i < arguments.size(); ++i) kernel_.setArg(i, arguments[i].bytes, arguments[i].value);
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, label);
  }
  lightgrid::launch(device, label, kernel_, global, local);
}

}  // namespace lightgrid
