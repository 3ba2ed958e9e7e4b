// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "base/tasks.hpp"

namespace scaleaxis::inline v1 {

/// An arena of that many threads, its user's alone while this lives. Arenas are kept and used again: oneTBB (seen with
/// 2021.8) holds on to 7 kB of every arena in which several threads have worked, even after it is destroyed.
class BorrowedArena {
   public:
    explicit BorrowedArena(int threads);
    ~BorrowedArena();
    BorrowedArena(const BorrowedArena&) = delete;
    BorrowedArena& operator=(const BorrowedArena&) = delete;

    tasks::task_arena& operator*() { return arena_.mapped(); }

   private:
    std::multimap<int, tasks::task_arena>::node_type arena_;  // so that giving it back allocates nothing
};

}  // namespace scaleaxis::inline v1
