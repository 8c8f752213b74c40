// Kernels of kernels/*/cpu have work-groups of one work-item, which takes many values. ONE_ITEM in the
// declaration makes OpenCL refuse other sizes. ASSUME_ONE_ITEM, the body's first statement, lets clang remove
// PoCL's loops over a work-group's items when PoCL compiles a kernel for any size
// (docs/devices.md#program-cache). Only PoCL gets it: Oclgrind 21.10 does not know llvm.assume.
#define ONE_ITEM __attribute__((reqd_work_group_size(1, 1, 1)))
#ifdef POCL_DEVICE_ADDRESS_BITS
#define ASSUME_ONE_ITEM \
  __builtin_assume(get_local_size(0) == 1 && get_local_size(1) == 1 && get_local_size(2) == 1)
#else
#define ASSUME_ONE_ITEM
#endif
