// A cache folder for PoCL on machines without a writable one, such as containers without a home.
#pragma once

#include <filesystem>

namespace lightgrid {

// Sets POCL_CACHE_DIR to a new folder in the system's temporary one if PoCL's own is not writable and the
// user has set none. main creates it before other threads start and before the first OpenCL call; it removes
// the folder at the end. If no temporary folder can be created either, nothing is set, and ClDevice reports
// the fault.
class TemporaryCache {
 public:
  TemporaryCache();
  ~TemporaryCache();
  TemporaryCache(const TemporaryCache&) = delete;
  TemporaryCache& operator=(const TemporaryCache&) = delete;

  void tell() const;  // reports the folder on stderr: compiled kernels are lost at the end

 private:
  std::filesystem::path folder_, unwritable_;
};

}  // namespace lightgrid
