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
    : file_(file), kernel_(programs.kernel(file, defines + " -cl-kernel-arg-info")) {
  count_ = kernel_.getInfo<CL_KERNEL_NUM_ARGS>();
  parameters_ = parameters_of(kernel_, count_);
}

void NamedKernel::check(const ClArguments& arguments) const {
  const auto given = [&](const std::string& parameter) {
    return std::any_of(arguments.begin(), arguments.end(),
                       [&](const ClArgument& argument) { return parameter == argument.name; });
  };
  for (const std::string& parameter : parameters_) {
    if (!given(parameter))
      throw machine_error("kernels/{}.cl: no argument for its parameter \"{}\"", file_, parameter);
  }
  for (const ClArgument& argument : arguments) {
    if (!parameters_.empty() &&
        std::find(parameters_.begin(), parameters_.end(), argument.name) == parameters_.end())
      throw machine_error("kernels/{}.cl has no parameter \"{}\"", file_, argument.name);
  }
  if (arguments.size() != count_)
    throw machine_error("kernels/{}.cl takes {} arguments, not {}", file_, count_, arguments.size());
  for (size_t i = 0; i < parameters_.size(); ++i) {
    if (parameters_[i] != arguments[i].name)
      throw machine_error("kernels/{}.cl: its parameter {} is \"{}\", the argument is \"{}\"", file_, i,
                          parameters_[i], arguments[i].name);
  }
}

void NamedKernel::launch(ClDevice& device, const std::string& label, const cl::NDRange& global,
                         const cl::NDRange& local, const ClArguments& arguments) {
  const bool agree =
      arguments.size() == count_ &&
      std::equal(parameters_.begin(), parameters_.end(), arguments.begin(),
                 [](const std::string& parameter, const ClArgument& a) { return parameter == a.name; });
  if (!agree) check(arguments);
  try {
    for (cl_uint i = 0; i < arguments.size(); ++i) kernel_.setArg(i, arguments[i].bytes, arguments[i].value);
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, label);
  }
  lightgrid::launch(device, label, kernel_, global, local);
}

}  // namespace lightgrid
