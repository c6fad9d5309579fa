// SPDX-License-Identifier: Apache-2.0
// The one place that asks which compiler is running: the shared headers are read by OpenCL C and by C++.
// Shared structs hold scalars and scalar arrays only, so that both sides lay them out alike.
#ifndef TURBID_SHARED_DIALECT_H
#define TURBID_SHARED_DIALECT_H

#ifdef __OPENCL_VERSION__
#define TURBID_ASSERT_SIZE(type, bytes) typedef char type##_has_the_size_both_sides_expect[sizeof(type) == (bytes) ? 1 : -1]
#else
#define TURBID_ASSERT_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), "host and device disagree on " #type)
#endif

#endif
