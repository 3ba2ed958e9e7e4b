// SPDX-License-Identifier: Apache-2.0
/// \file
/// What runs parallel loops: oneTBB, or with SCALEAXIS_THREADS=OFF the calling thread alone, as WebAssembly needs it.
/// `tasks` has the same names in both.
#pragma once

#ifdef SCALEAXIS_SEQUENTIAL
#include "base/sequential_tasks.hpp"
#else
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

namespace scaleaxis::inline v1 {

namespace tasks = tbb;

}  // namespace scaleaxis::inline v1

// Of windows.h, which oneTBB includes.
#undef far
#undef near
#endif
