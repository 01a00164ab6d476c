/* Functions that are compiled twice, for any x86-64 and for those with AVX2; the loader picks one.
 * Everything that they call becomes part of them. Use it only where each operation has one result
 * on every machine: integers, and + - * min max and conversions of floats one by one. */
#ifndef JOLON_WORLD_MATHS_CPU_DISPATCH_H
#define JOLON_WORLD_MATHS_CPU_DISPATCH_H

/* A sanitizer's run time is not ready yet when the loader picks; clang 14 does not do both. */
#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&                \
    !defined(__SANITIZE_THREAD__)
#define VECTOR_CLONES __attribute__((target_clones("avx2", "default"), flatten))
#else
#define VECTOR_CLONES
#endif

#endif
