// A cache folder for PoCL on machines that have none to write to, such as containers without a home.
#pragma once

#include <filesystem>

namespace lightgrid {

// Sets POCL_CACHE_DIR to a new folder below the system's temporary one where PoCL's own cannot be written and the user
// has named none. Made by main before any other thread runs and before the first OpenCL call; removes the folder at the
// end. Where no temporary folder can be made either, nothing is set, and ClDevice says what is wrong.
class TemporaryCache {
 public:
  TemporaryCache();
  ~TemporaryCache();
  TemporaryCache(const TemporaryCache&) = delete;
  TemporaryCache& operator=(const TemporaryCache&) = delete;

  void tell() const;  // on stderr, that there is one: compiled kernels are then lost at the end

 private:
  std::filesystem::path folder_, unwritable_;
};

}  // namespace lightgrid
