// SPDX-License-Identifier: Apache-2.0
#include "spatial/box_tree.hpp"

#include <limits>
#include <span>

#include "base/numbers.hpp"
#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr int kBins = 8;

// Subtrees of more items than this are built side by side.
constexpr std::size_t kParallelSize = 1 << 13;

/// Coordinates are three of four lanes; the last one is computed in vain.
struct FloatBox {
    Float4 min = {kFloatInfinity, kFloatInfinity, kFloatInfinity, kFloatInfinity};
    Float4 max = {-kFloatInfinity, -kFloatInfinity, -kFloatInfinity, -kFloatInfinity};

    void extend(const FloatBox& other) {
        min = lesser(min, other.min);
        max = greater(max, other.max);
    }
    float half_area() const {
        const Float4 side = max - min;
        return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
    }
};

struct Reference {
    FloatBox box;
    Index item = kNone;

    Float4 doubled_center() const { return box.min + box.max; }
};

/// References with what surrounds their boxes, and their doubled centres.
struct Range {
    std::span<Reference> references;
    FloatBox box;
    FloatBox centers;
};

/// What surrounds the references that go into one bin, or several.
struct Bin {
    FloatBox box;
    FloatBox centers;
    std::size_t count = 0;

    void extend(const Reference& r) {
        box.extend(r.box);
        const Float4 center = r.doubled_center();
        centers.extend({center, center});
        ++count;
    }
    void extend(const Bin& other) {
        box.extend(other.box);
        centers.extend(other.centers);
        count += other.count;
    }
};

Range range_of(std::span<Reference> references) {
    Bin bin;
    for (const Reference& r : references) {
        bin.extend(r);
    }
    return {references, bin.box, bin.centers};
}

std::array<Range, 2> split_in_half(std::span<Reference> references, int axis) {
    const std::size_t half = references.size() / 2;
    // Not std::nth_element, after which C++ libraries have each half in another order.
    std::sort(references.begin(), references.end(), [axis](const Reference& a, const Reference& b) {
        const float x = a.doubled_center()[axis], y = b.doubled_center()[axis];
        return x < y || (x == y && a.item < b.item);
    });
    return {range_of(references.first(half)), range_of(references.subspan(half))};
}

// Splits along the axis on which the centres spread most, where the surface area heuristic is least of `kBins` equal
// parts (I. Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007).
std::array<Range, 2> split(const Range& range, int depth) {
    const auto& [references, box, centers] = range;
    const Float4 spread = centers.max - centers.min;
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
        axis = spread[k] > spread[axis] ? k : axis;
    }
    if (depth >= box_tree_details::kMaxDepth || !(spread[axis] > 1e-6F)) {
        return split_in_half(references, axis);
    }

    const float low = centers.min[axis];
    const float bins_per_length = 0.9999F * kBins / spread[axis];
    const auto bin_of = [=](const Reference& r) {
        return static_cast<int>((r.box.min[axis] + r.box.max[axis] - low) * bins_per_length);
    };
    std::array<Bin, kBins> bins;
    for (const Reference& r : references) {
        bins[bin_of(r)].extend(r);
    }
    std::array<Bin, kBins> upper = bins;  // all from this bin on
    for (int k = kBins - 2; k > 0; --k) {
        upper[k].extend(upper[k + 1]);
    }
    // The first and the last bin are not empty.
    Bin lower;
    Bin best_lower;
    int best = 0;
    float least_cost = kFloatInfinity;
    for (int k = 1; k < kBins; ++k) {
        lower.extend(bins[k - 1]);
        const float cost = lower.box.half_area() * static_cast<float>(lower.count) +
                           upper[k].box.half_area() * static_cast<float>(upper[k].count);
        if (cost < least_cost) {
            least_cost = cost;
            best = k;
            best_lower = lower;
        }
    }
    // A partition without branches, which here could not be predicted.
    std::size_t front = 0;
    for (Reference& r : references) {
        const std::size_t advance = bin_of(r) < best ? 1 : 0;
        std::swap(r, references[front]);
        front += advance;
    }
    return {Range{references.first(front), best_lower.box, best_lower.centers},
            Range{references.subspan(front), upper[best].box, upper[best].centers}};
}

// Appends the subtree over `references`. Children are addressed relative to their parent, so that subtrees built apart
// can be put together.
void build(const Reference* all, const Range& range, int depth, std::vector<BoxTree::Node>& nodes) {
    if (range.references.size() > kParallelSize / 8) {
        stop_if_cancelled();
    }
    std::array<Range, BoxTree::kWidth> children{range};
    std::size_t size = 1;
    while (size < BoxTree::kWidth) {
        // The child that a query most likely visits is split next.
        std::size_t largest = size;
        for (std::size_t k = 0; k < size; ++k) {
            if (children[k].references.size() > BoxTree::kLeafSize &&
                (largest == size || children[k].box.half_area() > children[largest].box.half_area())) {
                largest = k;
            }
        }
        if (largest == size) {
            break;
        }
        const std::array<Range, 2> halves = split(children[largest], depth);
        children[largest] = halves[0];
        children[size++] = halves[1];
    }

    std::array<std::vector<BoxTree::Node>, BoxTree::kWidth> apart;
    const bool is_parallel = range.references.size() > kParallelSize;
    if (is_parallel) {
        tasks::parallel_for(std::size_t{0}, size, [&](std::size_t k) {
            if (children[k].references.size() > BoxTree::kLeafSize) {
                build(all, children[k], depth + 1, apart[k]);
            }
        });
        stop_if_cancelled();  // an incomplete tree must not be used
    }

    const std::size_t self = nodes.size();
    nodes.emplace_back();
    for (std::size_t k = 0; k < BoxTree::kWidth; ++k) {
        const bool is_child = k < size;
        const FloatBox box = is_child ? children[k].box : FloatBox();
        for (int axis = 0; axis < 3; ++axis) {
            nodes[self].bounds[0][axis][k] = box.min[axis];
            nodes[self].bounds[1][axis][k] = box.max[axis];
        }
        const std::span<Reference> part = is_child ? children[k].references : std::span<Reference>();
        if (part.size() <= BoxTree::kLeafSize) {
            nodes[self].first[k] = static_cast<Index>(part.data() - all);
            nodes[self].count[k] = static_cast<Index>(part.size());
            continue;
        }
        nodes[self].first[k] = static_cast<Index>(nodes.size() - self);
        nodes[self].count[k] = 0;
        if (is_parallel) {
            append(nodes, apart[k]);
            apart[k] = {};
        } else {
            build(all, children[k], depth + 1, nodes);
        }
    }
}

}  // namespace

BoxTree build_box_tree(std::span<const Box> boxes) {
    BoxTree tree;
    Box all;
    for (const Box& box : boxes) {
        all.extend(box);
    }
    const Point extent = all.max - all.min;
    const double longest = std::max({extent.x, extent.y, extent.z});
    tree.origin = midpoint(all.min, all.max);
    tree.scale = longest > 0.0 ? 2.0 / longest : 1.0;

    std::vector<Reference> references(boxes.size());
    for_each_index(references.size(), [&](std::size_t i) {
        const Point low = tree.in_frame(boxes[i].min);
        const Point high = tree.in_frame(boxes[i].max);
        const std::array<double, 3> min{low.x, low.y, low.z};
        const std::array<double, 3> max{high.x, high.y, high.z};
        for (int k = 0; k < 3; ++k) {
            references[i].box.min[k] = static_cast<float>(min[k]) - BoxTree::kPadding;
            references[i].box.max[k] = static_cast<float>(max[k]) + BoxTree::kPadding;
        }
        references[i].item = static_cast<Index>(i);
    });
    build(references.data(), range_of(references), 0, tree.nodes);
    tree.order.resize(boxes.size());
    std::transform(references.begin(), references.end(), tree.order.begin(), [](const Reference& r) { return r.item; });
    return tree;
}

namespace box_tree_details {

std::optional<ClippedSegment> clipped(const BoxTree& tree, const Point& a, const Point& b) {
    const Point start = tree.in_frame(a);
    const Point direction = tree.in_frame(b) - start;
    const std::array<double, 3> s{start.x, start.y, start.z};
    const std::array<double, 3> d{direction.x, direction.y, direction.z};
    constexpr double kEnd = 1.0 + 2.0 * BoxTree::kPadding;
    double enter = 0.0;
    double leave = 1.0;
    for (int k = 0; k < 3; ++k) {
        if (d[k] == 0.0) {
            leave = std::abs(s[k]) <= kEnd ? leave : -1.0;
            continue;
        }
        const double t0 = (-kEnd - s[k]) / d[k];
        const double t1 = (kEnd - s[k]) / d[k];
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
    }
    if (!(enter <= leave) || !is_finite(direction)) {
        return std::nullopt;
    }
    ClippedSegment result;
    for (int k = 0; k < 3; ++k) {
        // Where the segment does not move, the box that its start lies in must give no bound: the padding sees to it.
        constexpr double kTiny = 1e-30;
        const double clipped_direction = (leave - enter) * d[k];
        result.start[k] = static_cast<float>(s[k] + enter * d[k]);
        result.inverse_direction[k] = static_cast<float>(
            1.0 / (std::abs(clipped_direction) > kTiny ? clipped_direction : std::copysign(kTiny, d[k])));
        result.is_negative[k] = std::signbit(d[k]) ? 1 : 0;
    }
    return result;
}

}  // namespace box_tree_details
}  // namespace scaleaxis::inline v1
