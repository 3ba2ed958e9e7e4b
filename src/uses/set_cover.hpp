// SPDX-License-Identifier: Apache-2.0
/// \file
/// Set cover: as few sets as possible that hold all elements.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// Which elements, `0 … elements - 1`, are in which set.
struct SetSystem {
    IndexLists sets;
    Index elements = 0;
};

/// Takes the set with the most elements that are not covered yet, again and again; of several the first one. Then those
/// that are not needed are dropped, the smallest first.
/// \returns nothing if that takes more than `limit` sets, or an element is in none
std::optional<std::vector<Index>> greedy_cover(const SetSystem& system, Index limit);

/// As many sets as are given, others perhaps, that hold all elements. Local search: the set that is missed least goes,
/// and of those with an element that is not covered the one comes that gains most; elements weigh the more the longer
/// they were not covered (C. Gao et al., "An efficient local search heuristic with row weighting for the unicost set
/// covering problem", 2015). It looks only at sets that lie in no other one, and at elements that are not covered with
/// another one anyway. \param chosen at least one; each set once \param work a limit of the effort, in changes of
/// a set's gain \returns nothing if none was found
std::optional<std::vector<Index>> cover_of_size(const SetSystem& system, const std::vector<Index>& chosen,
                                                std::int64_t work);

/// A lower bound of the number of sets: Lagrangian relaxation, subgradient method (M. Held, R. Karp, 1971; J. Beasley,
/// "A Lagrangian heuristic for set-covering problems", 1990).
/// \param cover size of a known cover
Index cover_bound(const SetSystem& system, Index cover);

}  // namespace scaleaxis::inline v1
