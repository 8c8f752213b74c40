// The built-in functions that our kernels call, as OpenCL C 1.2 declares them (sections 6.12.1 to 6.12.11).
// With PoCL 3, clang reads opencl-c.h, 15,000 declarations, before each kernel unless _OPENCL_H_ is defined.
// With this file instead, a program that is in PoCL's cache is built in 20 ms instead of 55, a new one in
// 0.2 s less (docs/devices.md). A kernel that calls a function for the first time needs its declaration here.
// Attributes are those of opencl-c.h.
// clang-format off
#define BUILTIN __attribute__((overloadable))
#define PURE __attribute__((overloadable, const))
#define READS __attribute__((overloadable, pure))

#define OF_SIZES(M, type) M(type##2) M(type##3) M(type##4) M(type##8) M(type##16)

// Work-items.
#define DECLARE(name) PURE size_t name(uint);
DECLARE(get_global_id) DECLARE(get_global_size) DECLARE(get_group_id) DECLARE(get_local_id)
DECLARE(get_local_size) DECLARE(get_num_groups)
#undef DECLARE
__attribute__((overloadable, convergent)) void barrier(cl_mem_fence_flags);

// Numbers of float.
#define DECLARE(T) \
  PURE T sqrt(T); PURE T fabs(T); PURE T floor(T); PURE T rint(T); \
  PURE T fmin(T, T); PURE T fmax(T, T); PURE T fma(T, T, T); \
  PURE T min(T, T); PURE T max(T, T); PURE T clamp(T, T, T);
DECLARE(float) OF_SIZES(DECLARE, float)
#undef DECLARE
#define DECLARE(T) \
  PURE T fmin(T, float); PURE T fmax(T, float); \
  PURE T min(T, float); PURE T max(T, float); PURE T clamp(T, float, float);
OF_SIZES(DECLARE, float)
#undef DECLARE
PURE int isfinite(float);
PURE int4 isfinite(float4);
PURE int16 isfinite(float16);
PURE float dot(float4, float4);  // no others: a device may round them as it likes (docs/devices.md#same-bits)

// Integers.
#define DECLARE(T) \
  PURE T min(T, T); PURE T max(T, T); PURE T clamp(T, T, T); PURE T clz(T); PURE T popcount(T);
DECLARE(int) DECLARE(uint) DECLARE(long) DECLARE(ulong)
OF_SIZES(DECLARE, int) OF_SIZES(DECLARE, uint) OF_SIZES(DECLARE, ulong)
#undef DECLARE
#define DECLARE(n) \
  PURE int##n min(int##n, int); PURE int##n max(int##n, int); PURE int##n clamp(int##n, int, int); \
  PURE uint##n min(uint##n, uint); PURE uint##n max(uint##n, uint); PURE uint##n clamp(uint##n, uint, uint);
DECLARE(2) DECLARE(3) DECLARE(4) DECLARE(8) DECLARE(16)
#undef DECLARE
#define DECLARE(T) PURE int any(T); PURE int all(T);
DECLARE(int) OF_SIZES(DECLARE, int) OF_SIZES(DECLARE, long)
#undef DECLARE

// Conversions.
#define FROM(to, name, n) \
  PURE to##n name(uchar##n); PURE to##n name(ushort##n); PURE to##n name(int##n); PURE to##n name(uint##n); \
  PURE to##n name(float##n);
#define DECLARE(n) \
  FROM(float, convert_float##n, n) FROM(int, convert_int##n, n) \
  FROM(uint, convert_uint##n, n) FROM(ulong, convert_ulong##n, n) \
  FROM(uchar, convert_uchar##n, n) FROM(ushort, convert_ushort##n, n) \
  FROM(uchar, convert_uchar##n##_sat_rte, n) FROM(ushort, convert_ushort##n##_sat_rte, n)
DECLARE() DECLARE(2) DECLARE(3) DECLARE(4) DECLARE(8) DECLARE(16)
#undef DECLARE
#undef FROM

// Memory.
#define IN(space, T, n) \
  READS T##n vload##n(size_t, const space T*); \
  BUILTIN void vstore##n(T##n, size_t, space T*);
#define SPACES(T, n) \
  IN(__global, T, n) IN(__local, T, n) IN(__private, T, n) READS T##n vload##n(size_t, const __constant T*);
#define DECLARE(n) SPACES(float, n) SPACES(int, n) SPACES(uint, n) SPACES(uchar, n) SPACES(ushort, n)
DECLARE(2) DECLARE(3) DECLARE(4) DECLARE(8) DECLARE(16)
#undef DECLARE
#undef SPACES
#undef IN
#define IN(space, n) \
  READS float##n vload_half##n(size_t, const space half*); \
  BUILTIN void vstore_half##n(float##n, size_t, space half*); \
  BUILTIN void vstore_half##n##_rte(float##n, size_t, space half*);
#define DECLARE(n) IN(__global, n) IN(__local, n) IN(__private, n)
DECLARE() DECLARE(2) DECLARE(3) DECLARE(4) DECLARE(8) DECLARE(16)
#undef DECLARE
#undef IN

// Atomic operations.
#define IN(space, T) \
  BUILTIN T atomic_add(volatile space T*, T); BUILTIN T atomic_min(volatile space T*, T); \
  BUILTIN T atomic_max(volatile space T*, T); BUILTIN T atomic_or(volatile space T*, T); \
  BUILTIN T atomic_inc(volatile space T*); BUILTIN T atomic_cmpxchg(volatile space T*, T, T);
IN(__global, int) IN(__global, uint) IN(__local, int) IN(__local, uint)
#undef IN
BUILTIN void mem_fence(cl_mem_fence_flags);
BUILTIN void read_mem_fence(cl_mem_fence_flags);
#ifdef cl_khr_int64_extended_atomics
BUILTIN ulong atom_max(volatile __global ulong*, ulong);
BUILTIN ulong atom_max(volatile __local ulong*, ulong);
#endif

#undef OF_SIZES
#undef BUILTIN
#undef PURE
#undef READS
