// SPDX-License-Identifier: Apache-2.0
#include "base/arenas.hpp"

#include <mutex>
#include <utility>

namespace scaleaxis::inline v1 {
namespace {

struct FreeArenas {
    std::mutex mutex;
    std::multimap<int, tasks::task_arena> by_threads;
};

// Never destroyed: at the end of the program the scheduler may be gone before this would be.
FreeArenas& free_arenas() {
    static auto* const arenas = new FreeArenas;
    return *arenas;
}

}  // namespace

BorrowedArena::BorrowedArena(int threads) {
    FreeArenas& free = free_arenas();
    const std::lock_guard lock(free.mutex);
    auto arena = free.by_threads.find(threads);
    if (arena == free.by_threads.end()) {
        arena = free.by_threads.emplace(threads, threads);
    }
    arena_ = free.by_threads.extract(arena);
}

BorrowedArena::~BorrowedArena() {
    FreeArenas& free = free_arenas();
    const std::lock_guard lock(free.mutex);
    free.by_threads.insert(std::move(arena_));
}

}  // namespace scaleaxis::inline v1
