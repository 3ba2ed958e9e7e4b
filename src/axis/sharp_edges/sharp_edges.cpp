// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/sharp_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/sharp_edges/border.hpp"
#include "axis/sharp_edges/bridges.hpp"
#include "axis/sharp_edges/chains.hpp"
#include "axis/sharp_edges/creases.hpp"
#include "axis/sharp_edges/crumbs.hpp"
#include "axis/sharp_edges/missing_edges.hpp"
#include "axis/stages/stages.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/fit.hpp"
#include "scaleaxis/ranges.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kSharpEdgesStage = "sharp edges";

constexpr double kLeastLength = 3.0;  // tolerances: shorter parts of edges need corners at both ends
constexpr double kLeastSheet = 2.0;   // tolerances: what is smaller is not extended

// Adds the strips.
class Extension {
   public:
    Extension(MedialComplex complex, const Solid& solid, const SharpEdgeOptions& options, const Border& border,
              CornerTrees& corners)
        : solid_(solid),
          options_(options),
          border_(border),
          corners_(corners),
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
                const BorderVertex& beside = border_.vertices[corners_.of_set[set]];
                add_face({p, q, corner_vertices_[set]}, beside.corner->angle, beside.face);
                std::vector<Index>& feet = rows_[corner_vertices_[set]].feet;
                feet.insert(feet.end(), {p, q});
            }
        }
        for (const Bridge& bridge : bridges_between(result_.complex, solid_, options_, kSamePlace * options_.tolerance,
                                                    ends_, std::move(rows_))) {
            add_bridge(bridge);
        }
        MedialComplex& complex = result_.complex;
        build_edges(complex, curves_);
        label_sheets(complex);
        return std::move(result_);
    }

   private:
    // Long chains, and those from one corner to another. A corner needs a long one, or two.
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
                    ends[set_of(end)] += is_kept[i] == 0 ? 0 : is_long(chains[i]) ? 2 : 1;
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
        return blocks_of(chain.positions, kSamePlace * options_.tolerance).size() >= least &&
               (is_long(chain) || (!is_loop && is_from_corner && is_to_corner));
    }

    bool is_long(const Chain& chain) const { return chain.positions.back() >= kLeastLength * options_.tolerance; }

    Index set_of(Index i) { return corners_.sets.find(border_.vertices[i].vertex); }
    bool was_corner(Index i) const { return border_.vertices[i].corner.has_value(); }
    bool leads_to_corner(Index i) { return was_corner(i) && is_corner_[set_of(i)] != 0; }

    Index add_vertex(const Point& place) {
        ++result_.statistics.points;
        return scaleaxis::add_vertex(result_.complex, {place, 0.0}, {VertexKind::kSharpEdge});
    }

    Index corner_at(Index i) { return was_corner(i) ? corner_vertices_[set_of(i)] : kNone; }

    // Where the vertices of a row go, by their positions on the edge. `first` and `last` say where its ends go, if that
    // is known, and `place_of` the place of any other vertex.
    template <class PlaceOf>
    std::vector<Index> targets_of(const std::vector<double>& positions, std::optional<Index> first,
                                  std::optional<Index> last, const PlaceOf& place_of) {
        std::vector<Index> targets(positions.size(), kNone);
        for (const auto& [begin, end] : blocks_of(positions, kSamePlace * options_.tolerance)) {
            Index target = kNone;
            if (begin == 0 && first) {
                target = *first;
            } else if (end + 1 == positions.size() && last) {
                target = *last;
            } else {
                target = add_vertex(place_of((begin + end) / 2));
            }
            std::fill(targets.begin() + static_cast<std::ptrdiff_t>(begin),
                      targets.begin() + static_cast<std::ptrdiff_t>(end) + 1, target);
        }
        return targets;
    }

    void add_chain(const Chain& chain) {
        const auto corner_of = [&](Index i) { return was_corner(i) ? std::optional(corner_at(i)) : std::nullopt; };
        const std::vector<Index> targets =
            targets_of(chain.positions, corner_of(chain.at.front()), corner_of(chain.at.back()),
                       [&](std::size_t k) { return border_.vertices[chain.at[k]].crease->place; });
        const std::size_t count = chain.at.size();
        const auto foot = [&](std::size_t k) {
            const BorderVertex& at = border_.vertices[chain.at[k]];
            return Foot{at.vertex, targets[k], angle_at(at), at.face};
        };
        for (std::size_t k = chain.is_closed ? 0 : 1; k < count; ++k) {
            add_strip(foot((k + count - 1) % count), foot(k));
        }
        if (!chain.is_closed) {
            add_ends(chain, targets);
        }
    }

    // Where a chain ends, its edge may go on.
    void add_ends(const Chain& chain, const std::vector<Index>& targets) {
        const auto add_end = [&](auto at, auto target, auto end) {
            for (; *target == kNone; ++at, ++target) {
                // beside a corner that is left out
            }
            const auto next = std::find_if(target, end, [&](Index other) { return other != *target; });
            const Point& place = result_.complex.vertices[*target];
            const bool is_corner = leads_to_corner(*at);
            const Point outward = unit(place - result_.complex.vertices[*next]);
            ends_.push_back(
                {border_.vertices[*at].vertex, *target, place, is_corner, is_corner ? -1.0 * outward : outward});
            border_of_end_.push_back(*at);
            // Rows of other edges at a corner may have a way below them, but for the strip's part that ends there.
            RowsOfTarget& rows = rows_[*target];
            for (std::size_t k = 0; k < targets.size(); ++k) {
                const Index v = border_.vertices[chain.at[k]].vertex;
                if (targets[k] == *target) {
                    rows.feet.push_back(v);
                } else if (!is_corner || (k > 0 && targets[k - 1] == *target) ||
                           (k + 1 < targets.size() && targets[k + 1] == *target)) {
                    rows.others.push_back(v);
                }
            }
        };
        add_end(chain.at.begin(), targets.begin(), targets.end());
        add_end(chain.at.rbegin(), targets.rbegin(), targets.rend());
    }

    void add_bridge(const Bridge& bridge) {
        const BorderVertex& beside = border_.vertices[border_of_end_[bridge.from]];
        const std::vector<Index> targets =
            targets_of(bridge.positions, ends_[bridge.from].target, ends_[bridge.to].target,
                       [&](std::size_t k) { return bridge.places[k]; });
        const auto foot = [&](std::size_t k) { return Foot{bridge.way[k], targets[k], angle_at(beside), beside.face}; };
        for (std::size_t k = 1; k < bridge.way.size(); ++k) {
            add_strip(foot(k - 1), foot(k));
        }
    }

    // A vertex of the axis, and where it goes.
    struct Foot {
        Index vertex;
        Index target;
        double angle;  // between the normals at the edge
        Index face;    // one beside
    };

    void add_strip(const Foot& a, const Foot& b) {
        if (a.target == kNone || b.target == kNone) {
            return;
        }
        const double angle = std::max(a.angle, b.angle);
        const auto add = [&](const std::array<Index, 3>& corners) { add_face(corners, angle, a.face); };
        if (a.target == b.target) {
            add({a.vertex, b.vertex, a.target});
            return;
        }
        const std::vector<Point>& points = result_.complex.vertices;
        result_.statistics.length += distance(points[a.target], points[b.target]);
        if (squared_distance(points[a.vertex], points[b.target]) <
            squared_distance(points[b.vertex], points[a.target])) {
            add({a.vertex, b.vertex, b.target});
            add({a.vertex, b.target, a.target});
        } else {
            add({a.vertex, b.vertex, a.target});
            add({b.vertex, b.target, a.target});
        }
    }

    static double angle_at(const BorderVertex& at) { return at.crease ? at.crease->angle : at.corner->angle; }

    // The contacts of a ball in a wedge are seen under the angle between the normals.
    void add_face(const std::array<Index, 3>& corners, double angle, Index beside) {
        const MedialComplex& complex = result_.complex;
        const auto contacts = has_contacts_ ? std::optional(complex.face_contacts[beside]) : std::nullopt;
        scaleaxis::add_face(result_.complex, corners, {0.5 * angle, 0, contacts});
    }

    const Solid& solid_;
    const SharpEdgeOptions& options_;
    const Border& border_;
    CornerTrees& corners_;
    std::vector<std::uint8_t> is_corner_;  // at the representatives of sets
    std::vector<Index> corner_vertices_;   // the same: what was added
    std::vector<std::array<Index, 2>> curves_;
    bool has_contacts_;
    std::vector<RowEnd> ends_;
    std::unordered_map<Index, RowsOfTarget> rows_;
    std::vector<Index> border_of_end_;  // the vertex of the border of each
    SharpComplex result_;
};

void validate(const SharpEdgeOptions& options) {
    if (!kSharpAngleRange.contains(options.angle)) {
        throw InvalidOption("the angle of sharp edges must lie between 10 and 150 degrees");
    }
    if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance)) {
        throw InvalidOption("the tolerance must be a positive number");
    }
    check_scale(options.scale);
}

}  // namespace

SharpComplex extended_to_sharp_edges(MedialComplex complex, const Solid& solid, const SharpEdgeOptions& options,
                                     const Execution& execution) {
    validate(options);
    check_knows_nearest(solid);
    return in_arena(execution, [&] {
        report(execution, kSharpEdgesStage, 0.0);
        MedialComplex given = complex;
        const double least_sheet = kLeastSheet * options.tolerance;
        const double same_place = kSamePlace * options.tolerance;
        complex = without_crumbs(std::move(complex), solid, options, least_sheet);
        Border border = border_of(complex, least_sheet);
        find_creases(complex, solid, options, border);
        report(execution, kSharpEdgesStage, 0.8);
        CornerTrees corners = corners_of(complex, border, same_place);
        const std::vector<Chain> chains = chains_of(complex, border, corners, options.tolerance, same_place);
        SharpComplex result = Extension(std::move(complex), solid, options, border, corners).run(chains);
        if (result.statistics.points == 0) {
            result.complex = std::move(given);
        }
        reach_missing_edges(result.complex, solid, options, result.statistics);
        result.statistics.angle = options.angle;
        result.statistics.sheets = result.complex.sheets;
        result.statistics.topology = topology_of(result.complex);
        report(execution, kSharpEdgesStage, 1.0);
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

}  // namespace scaleaxis::inline v1
