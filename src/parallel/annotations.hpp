// Marks the per-element maths that the host compiler and nvcc share.
#pragma once

#ifdef __CUDACC__
#define ISOWEAVE_HD __host__ __device__
#else
#define ISOWEAVE_HD
#endif
