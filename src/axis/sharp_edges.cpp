// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/sharp_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "axis/border.hpp"
#include "axis/chains.hpp"
#include "axis/complex.hpp"
#include "axis/crumbs.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/fit.hpp"
#include "scaleaxis/ranges.hpp"

namespace scaleaxis {
namespace {

constexpr std::string_view kStage = "sharp edges";

constexpr double kLeastLength = 3.0;  // tolerances: shorter parts of edges need corners at both ends
constexpr double kLeastSheet = 2.0;   // tolerances: what is smaller is not extended
constexpr double kSamePlace = 1e-3;   // tolerances

// Which vertices of a chain arrive at the same place, so that none goes back where the border does: the blocks of an
// isotonic regression of the positions, by pooling of adjacent violators. First and last of each, ascending.
std::vector<std::array<std::size_t, 2>> blocks_of(const std::vector<double>& positions, double same_place) {
    struct Block {
        std::size_t first;
        std::size_t last;
        double mean;
    };
    std::vector<Block> blocks;
    for (std::size_t k = 0; k < positions.size(); ++k) {
        blocks.push_back({k, k, positions[k]});
        while (blocks.size() > 1 && blocks[blocks.size() - 2].mean >= blocks.back().mean - same_place) {
            const Block block = blocks.back();
            blocks.pop_back();
            Block& before = blocks.back();
            const auto size = static_cast<double>(block.last - block.first + 1);
            const auto size_before = static_cast<double>(before.last - before.first + 1);
            before.mean = (size_before * before.mean + size * block.mean) / (size_before + size);
            before.last = block.last;
        }
    }
    std::vector<std::array<std::size_t, 2>> result;
    for (const Block& block : blocks) {
        result.push_back({block.first, block.last});
    }
    return result;
}

// Adds the strips.
class Extension {
   public:
    Extension(MedialComplex complex, const Border& border, Corners& corners, double tolerance)
        : border_(border),
          corners_(corners),
          tolerance_(tolerance),
          curves_(curve_edges(complex)),
          has_contacts_(complex.has_contacts()) {
        result_.complex = std::move(complex);
    }

    SharpComplex run(const std::vector<Chain>& chains) && {
        const std::vector<std::uint8_t> is_kept = choose(chains);
        for (std::size_t i = 0; i < chains.size(); ++i) {
            if (is_kept[i] != 0) {
                add_chain(chains[i]);
            }
        }
        for (const auto& [p, q] : corners_.tree_edges) {
            const Index set = corners_.sets.find(p);
            if (corner_vertices_[set] != kNone) {
                const Index beside = corners_.of_set[set];
                add_face({p, q, corner_vertices_[set]}, border_.vertices[beside].corner->angle, beside);
            }
        }
        MedialComplex& complex = result_.complex;
        build_edges(complex, curves_);
        label_sheets(complex);
        return std::move(result_);
    }

   private:
    // Long chains, and those from one corner to another. A corner needs two of them at least.
    std::vector<std::uint8_t> choose(const std::vector<Chain>& chains) {
        is_corner_.resize(corners_.of_set.size());
        for (std::size_t i = 0; i < is_corner_.size(); ++i) {
            is_corner_[i] = corners_.of_set[i] != kNone ? 1 : 0;
        }
        std::vector<std::uint8_t> is_kept(chains.size());
        for (bool is_changed = true; is_changed;) {
            std::vector<Index> ends(is_corner_.size());
            for (std::size_t i = 0; i < chains.size(); ++i) {
                is_kept[i] = is_long_enough(chains[i]) ? 1 : 0;
                for (const Index end : {chains[i].at.front(), chains[i].at.back()}) {
                    ends[set_of(end)] += is_kept[i];
                }
            }
            is_changed = false;
            for (std::size_t i = 0; i < ends.size(); ++i) {
                if (is_corner_[i] != 0 && ends[i] < 2) {
                    is_corner_[i] = 0;
                    is_changed = true;
                }
            }
        }
        corner_vertices_.assign(is_corner_.size(), kNone);
        for (std::size_t i = 0; i < is_corner_.size(); ++i) {
            if (is_corner_[i] != 0) {
                corner_vertices_[i] = add_vertex(border_.vertices[corners_.of_set[i]].corner->place);
                ++result_.statistics.corners;
            }
        }
        return is_kept;
    }

    // Different chains must not arrive on the same edges, nor a chain on one twice: that would make voids.
    bool is_long_enough(const Chain& chain) {
        const Index first = chain.at.front();
        const Index last = chain.at.back();
        const bool is_from_corner = leads_to_corner(first);
        const bool is_to_corner = leads_to_corner(last);
        const bool is_loop = chain.is_closed || set_of(first) == set_of(last);
        std::size_t least = 3;  // places
        if (!is_loop && !(is_from_corner && is_to_corner)) {
            // Those of corners that are left out do not count.
            least = 2 + (is_from_corner == was_corner(first) ? 0 : 1) + (is_to_corner == was_corner(last) ? 0 : 1);
        } else if (is_loop && !chain.is_closed) {
            least = 4;
        }
        const bool is_short = chain.positions.back() < kLeastLength * tolerance_;
        return blocks_of(chain.positions, kSamePlace * tolerance_).size() >= least &&
               !(is_short && (is_loop || !(is_from_corner && is_to_corner)));
    }

    Index set_of(Index i) { return corners_.sets.find(border_.vertices[i].vertex); }
    bool was_corner(Index i) const { return border_.vertices[i].corner.has_value(); }
    bool leads_to_corner(Index i) { return was_corner(i) && is_corner_[set_of(i)] != 0; }

    Index add_vertex(const Point& place) {
        MedialComplex& complex = result_.complex;
        complex.vertices.push_back(place);
        complex.radii.push_back(0.0);
        complex.vertex_balls.push_back(kMoved);
        ++result_.statistics.points;
        return static_cast<Index>(complex.vertices.size()) - 1;
    }

    Index corner_at(Index i) { return was_corner(i) ? corner_vertices_[set_of(i)] : kNone; }

    void add_chain(const Chain& chain) {
        std::vector<Index> targets(chain.at.size(), kNone);
        for (const auto& [first, last] : blocks_of(chain.positions, kSamePlace * tolerance_)) {
            const bool has_first = first == 0 && was_corner(chain.at.front());
            const bool has_last = last + 1 == chain.at.size() && was_corner(chain.at.back());
            Index target = kNone;
            if (has_first || has_last) {
                target = corner_at(has_first ? chain.at.front() : chain.at.back());
            } else {
                target = add_vertex(border_.vertices[chain.at[(first + last) / 2]].crease->place);
            }
            std::fill(targets.begin() + static_cast<std::ptrdiff_t>(first),
                      targets.begin() + static_cast<std::ptrdiff_t>(last) + 1, target);
        }
        const std::size_t count = chain.at.size();
        for (std::size_t k = chain.is_closed ? 0 : 1; k < count; ++k) {
            const std::size_t before = (k + count - 1) % count;
            add_strip(chain.at[before], chain.at[k], targets[before], targets[k]);
        }
    }

    void add_strip(Index a, Index b, Index target_a, Index target_b) {
        if (target_a == kNone || target_b == kNone) {
            return;
        }
        if (target_a == target_b) {
            add_triangle(a, b, target_a);
            return;
        }
        const std::vector<Point>& points = result_.complex.vertices;
        result_.statistics.length += distance(points[target_a], points[target_b]);
        const Index p = border_.vertices[a].vertex;
        const Index q = border_.vertices[b].vertex;
        const double angle = std::max(angle_at(a), angle_at(b));
        if (squared_distance(points[p], points[target_b]) < squared_distance(points[q], points[target_a])) {
            add_face({p, q, target_b}, angle, a);
            add_face({p, target_b, target_a}, angle, a);
        } else {
            add_face({p, q, target_a}, angle, a);
            add_face({q, target_b, target_a}, angle, a);
        }
    }

    double angle_at(Index i) const {
        const BorderVertex& at = border_.vertices[i];
        return at.crease ? at.crease->angle : at.corner->angle;
    }

    void add_triangle(Index a, Index b, Index target) {
        add_face({border_.vertices[a].vertex, border_.vertices[b].vertex, target}, std::max(angle_at(a), angle_at(b)),
                 a);
    }

    // The contacts of a ball in a wedge are seen under the angle between the normals.
    void add_face(const std::array<Index, 3>& corners, double angle, Index beside) {
        MedialComplex& complex = result_.complex;
        complex.faces.push_back(corners);
        complex.face_angles.push_back(0.5 * angle);
        complex.face_sheets.push_back(0);
        if (has_contacts_) {
            const std::array<Index, 2> contacts = complex.face_contacts[border_.vertices[beside].face];
            complex.face_contacts.push_back(contacts);
        }
    }

    const Border& border_;
    Corners& corners_;
    double tolerance_;
    std::vector<std::uint8_t> is_corner_;  // at the representatives of sets
    std::vector<Index> corner_vertices_;   // the same: what was added
    std::vector<std::array<Index, 2>> curves_;
    bool has_contacts_;
    SharpComplex result_;
};

void validate(const SharpEdgeOptions& options) {
    if (!kSharpAngleRange.contains(options.angle)) {
        throw InvalidOption("the angle of sharp edges must lie between 10 and 150 degrees");
    }
    if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance)) {
        throw InvalidOption("the tolerance must be a positive number");
    }
}

}  // namespace

SharpComplex extended_to_sharp_edges(MedialComplex complex, const Solid& solid, const SharpEdgeOptions& options,
                                     const Execution& execution) {
    validate(options);
    check_knows_nearest(solid);
    return in_arena(execution, [&] {
        report(execution, kStage, 0.0);
        MedialComplex given = complex;
        const double least_sheet = kLeastSheet * options.tolerance;
        const double same_place = kSamePlace * options.tolerance;
        complex = without_crumbs(std::move(complex), solid, options, least_sheet);
        Border border = border_of(complex, least_sheet);
        find_creases(complex, solid, options, border);
        report(execution, kStage, 0.8);
        Corners corners = corners_of(complex, border, same_place);
        const std::vector<Chain> chains = chains_of(complex, border, corners, options.tolerance, same_place);
        SharpComplex result = Extension(std::move(complex), border, corners, options.tolerance).run(chains);
        if (result.statistics.points == 0) {
            result.complex = std::move(given);
        }
        result.statistics.angle = options.angle;
        result.statistics.topology = topology_of(result.complex);
        report(execution, kStage, 1.0);
        return result;
    });
}

SharpComplex extend_to_sharp_edges(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options,
                                   const Execution& execution) {
    return in_arena(execution, [&] {
        check(complex);
        return extended_to_sharp_edges(complex, solid, options, execution);
    });
}

}  // namespace scaleaxis
