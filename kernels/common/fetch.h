// Asks for the cache line at a global address, on CPUs. They read on while they wait for memory, but not past
// a block of pixels; a GPU has other work-items to run.
#pragma once

#if defined(__x86_64__) || defined(__aarch64__)
#define FETCH(at) __builtin_prefetch((const void*)(size_t)(at))
#else
#define FETCH(at) (void)(at)
#endif
