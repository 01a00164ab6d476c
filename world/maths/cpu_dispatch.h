/* Functions that are compiled twice, for any x86-64 and for AVX2; the loader selects one. WIDE:
 * also for AVX-512, whose products of 64-bit integers take half the time.
 * Everything that they call becomes part of them. Use it only if each operation has the same result
 * on every machine: integers, and + - * min max and conversions of single floats. */
#ifndef JOLON_WORLD_MATHS_CPU_DISPATCH_H
#define JOLON_WORLD_MATHS_CPU_DISPATCH_H

/* A sanitizer's runtime is not ready when the loader selects; clang 14 does not support both
 * attributes. */
#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&                \
    !defined(__SANITIZE_THREAD__)
#define VECTOR_CLONES __attribute__((target_clones("avx2", "default"), flatten))
#define WIDE_VECTOR_CLONES                                                                         \
    __attribute__((target_clones("arch=x86-64-v4", "avx2", "default"), flatten))
#else
#define VECTOR_CLONES
#define WIDE_VECTOR_CLONES
#endif

#endif
