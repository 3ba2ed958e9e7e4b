// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/faults.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/skeleton.hpp"
#include "uses/boundary_ahead.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// New nodes from an end to the middle of an opening, and the branch that they prolong.
struct Prolongation {
    Index branch = kNone;
    bool is_at_front = false;
    std::vector<Index> nodes;  ///< from the end on
};

Prolongation prolonged(Skeleton& skeleton, Index end, const Point& to, double spacing) {
    Prolongation result;
    result.branch = skeleton.node_branches[end];
    result.is_at_front = skeleton.branches[result.branch].front() == end;
    const Point from = skeleton.nodes[end];
    const double parts = spacing > 0.0 ? std::ceil(distance(from, to) / spacing) : 1.0;
    Index last = end;
    for (double k = 1.0; k <= parts; k += 1.0) {
        const auto node = static_cast<Index>(skeleton.nodes.size());
        skeleton.nodes.push_back(k == parts ? to : from + k / parts * (to - from));
        skeleton.radii.push_back(skeleton.radii[end]);
        skeleton.node_branches.push_back(result.branch);
        skeleton.node_components.push_back(skeleton.node_components[end]);
        skeleton.edges.push_back({last, node});
        result.nodes.push_back(node);
        last = node;
    }
    return result;
}

IndexLists with_prolongations(const IndexLists& branches, const std::vector<Prolongation>& all) {
    IndexLists result;
    for (Index b = 0; b < static_cast<Index>(branches.size()); ++b) {
        std::vector<Index> nodes(branches[b].begin(), branches[b].end());
        for (const Prolongation& prolongation : all) {
            if (prolongation.branch != b) {
                continue;
            }
            const std::vector<Index>& added = prolongation.nodes;
            if (prolongation.is_at_front) {
                nodes.insert(nodes.begin(), added.rbegin(), added.rend());
            } else {
                nodes.insert(nodes.end(), added.begin(), added.end());
            }
        }
        result.push_back(nodes);
    }
    return result;
}

}  // namespace

Skeleton led_to_openings(Skeleton skeleton, std::span<const Hole> holes, double spacing) {
    require(spacing >= 0.0, "the spacing of nodes must not be negative");
    const std::vector<Index> degree = branch_degrees(skeleton);
    auto ends = indices_where(degree.size(), [&](Index n) { return degree[n] == 1; });
    std::vector<Prolongation> prolongations;
    for (const Hole& hole : holes) {
        const auto way_of = [&](Index end) { return distance(skeleton.nodes[end], hole.center); };
        // A curve ends one radius before a disc that it meets at right angles, and farther from one that is askew.
        const auto nearest = std::ranges::min_element(ends, {}, way_of);
        if (nearest == ends.end() || way_of(*nearest) == 0.0 ||
            way_of(*nearest) > std::max(kMostRadii * skeleton.radii[*nearest], hole.width)) {
            continue;
        }
        prolongations.push_back(prolonged(skeleton, *nearest, hole.center, spacing));
        ends.erase(nearest);
    }
    skeleton.branches = with_prolongations(skeleton.branches, prolongations);
    return skeleton;
}

}  // namespace scaleaxis::inline v1
