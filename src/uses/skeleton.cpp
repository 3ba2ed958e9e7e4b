// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <string_view>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "axis/complex.hpp"
#include "axis/edit/collapse.hpp"
#include "axis/stages/curve_fire.hpp"
#include "axis/stages/resolved_fire.hpp"
#include "axis/stages/stages.hpp"
#include "balls/union/union_data.hpp"
#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"
#include "uses/ascent.hpp"
#include "uses/boundary_ahead.hpp"
#include "uses/curves/ways_out.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kSkeletonStage = "skeleton";
constexpr double kWideFactor = 2.0;  // of the radius: half the width of a wide sheet
constexpr double kLeastRise = 0.35;  // of the erosion thickness along a branch; 0.29 in a corner of 90°
// Of the way: erosion thickness that rises less is no limb's, but that in a corner of a box (0.42), or of a square
// sheet (0.41 of half its width).
constexpr double kLeastLimbRise = 0.45;
// Of a disc along another curve, where no sheet is wide: limbs part there, as those of a V.
constexpr double kLeastBlend = 0.25;
// Of the fire's disc, or of the mean length of edges: half the window of the smoothing.
constexpr double kWindowFactor = 1.5;

// A complex with the times of the fire in its sheets.
struct Burnt {
    MedialComplex complex;
    std::vector<double> vertex_times;  // the latest of the sheets at the vertex; the radius on curves
    std::vector<double> vertex_paths;  // the ways that the fire has come there within the sheets; 0 on curves
    std::vector<double> edge_times;

    double radius(Index v) const { return complex.scale * complex.radii[v]; }
    // In the solid, whose balls are not grown.
    double time_in_solid(Index v) const {
        return vertex_paths[v] + (vertex_times[v] - vertex_paths[v]) / complex.scale;
    }
};

// Vertices of `given` come first.
Burnt burnt_sheets(const MedialComplex& given) {
    BurntComplex burnt = burnt_complex(given, 0.0);
    const auto is_missed = [](const RidgeCrossing& crossing) {
        // With 1.3 times of what the ends tell curves wave.
        return crossing.thickness > (1.0 + kRadiusError) * std::ranges::max(crossing.end_thickness);
    };
    for (int round = 0; round < kMostCutRounds && cut(burnt, cuts_at_ridges(burnt, is_missed)); ++round) {
        // once more
    }
    const auto& [complex, radii, sides, sectors, fire] = burnt;
    Burnt result{{}, radii, std::vector<double>(radii.size()), {}};
    for (std::size_t s = 0; s < sectors.vertices.size(); ++s) {
        if (fire.sector_times[s] < kInfinity) {
            double& time = result.vertex_times[sectors.vertices[s]];
            double& path = result.vertex_paths[sectors.vertices[s]];
            time = std::max(time, fire.sector_times[s]);
            path = std::max(path, fire.sector_paths[s]);
        }
    }
    std::vector<Index> faces(complex.faces.size());
    std::iota(faces.begin(), faces.end(), 0);
    result.edge_times = edge_times(burnt, complex, sides, radii, faces, std::vector<std::uint8_t>(faces.size(), 1));
    result.complex = std::move(burnt.complex);
    return result;
}

// Collapses faces from free edges, those that burn first first. All vertices stay, as parts of trees.
Remainder collapsed_faces(const Burnt& burnt) {
    return after_collapses(burnt.complex, [&](const ElementaryCollapse& collapse) {
        return collapse.has_face ? std::optional(burnt.edge_times[collapse.free]) : std::nullopt;
    });
}

// What of the curves stays, and where the rest has shrunk to.
struct Pruned {
    std::vector<std::uint8_t> has_edge;
    std::vector<Index> parents;  // of each vertex, the next one on the way to what stays; itself if it stays
};

// Erosion thickness where an edge ends that burnt from a tip.
double thickness_at(const Burnt& burnt, const BurntEdge& edge, Index tip) {
    return burnt.vertex_times[tip] + edge.length - burnt.vertex_times[edge.to];
}

// A wide sheet that is not about as long as wide keeps the curve that burns last, which says how it lies, even if that
// does not stick out by its radius, too. \param last where it ends
bool tells_how_it_lies(const Burnt& burnt, const BurntEdge& last, Index tip, double significance) {
    const double path = burnt.vertex_paths[last.to];
    return path > kWideFactor * significance * burnt.radius(last.to) &&
           thickness_at(burnt, last, tip) > kLeastLimbRise * path;
}

using BurntCurve = std::vector<Index>;

// Where towards its tip a curve stops to be a ridge. \param curve burnt edges, from the tip on \param first which
// sticks out
BurntCurve::const_iterator ridge_begin(const Burnt& burnt, const std::vector<BurntEdge>& edges, const BurntCurve& curve,
                                       BurntCurve::const_iterator first) {
    const Index tip = edges[curve.front()].from;
    const auto rises = [&](BurntCurve::const_iterator i) {
        return thickness_at(burnt, edges[*i], tip) >= kLeastRise * edges[*i].length;
    };
    if (const Index v = edges[*first].to; burnt.vertex_paths[v] > kWideFactor * burnt.radius(v)) {
        for (; first != curve.begin() && rises(first - 1); --first) {
        }
        return first;
    }
    // What leads from an edge of the solid to the end of a limb rises less than the limb does.
    auto begin = curve.begin();
    double least_excess = 0.0;
    for (auto i = curve.begin(); i != first; ++i) {
        const double excess = thickness_at(burnt, edges[*i], tip) - kLeastLimbRise * edges[*i].length;
        if (excess < least_excess) {
            least_excess = excess;
            begin = i + 1;
        }
    }
    return begin;
}

// A curve starts at a tip, and ends where a longer one goes on. It stays if it sticks out somewhere by its own measure,
// from there on; and towards the tip as far as the erosion thickness says that it is a ridge.
Pruned pruned_curves(const Burnt& burnt, const Remainder& remainder, double significance) {
    const std::vector<BurntEdge> edges = burn_curves(burnt.complex, burnt.vertex_times, remainder);
    std::vector<std::uint8_t> is_kept(edges.size());
    BurntCurve curve;  // its edges, from the tip on
    for (Index last = 0; last < static_cast<Index>(edges.size()); ++last) {
        if (edges[last].next != kNone && edges[edges[last].next].feeder == last) {
            continue;
        }
        curve.clear();
        for (Index i = last; i != kNone; i = edges[i].feeder) {
            curve.push_back(i);
        }
        std::ranges::reverse(curve);
        const Index tip = edges[curve.front()].from;
        // Hairs at the border of a sheet have small balls.
        const double least = kSmallPart * significance * burnt.vertex_times[edges[last].to];
        const auto sticks_out = [&](Index i) {
            const Index v = edges[i].to;
            return thickness_at(burnt, edges[i], tip) >
                   significance * burnt.radius(v) + std::max(kLeastLimbRise * burnt.vertex_paths[v], least);
        };
        auto first = std::ranges::find_if(curve, sticks_out);
        if (first == curve.end() && edges[last].next == kNone &&
            tells_how_it_lies(burnt, edges[last], tip, significance)) {
            --first;
        }
        if (first == curve.end()) {
            continue;
        }
        const auto begin = ridge_begin(burnt, edges, curve, first);
        for (Index i = *begin; i != kNone && is_kept[i] == 0; i = edges[i].next) {
            is_kept[i] = 1;
        }
    }
    Pruned result{remainder.has_edge, std::vector<Index>(burnt.complex.vertices.size())};
    for (Index v = 0; v < static_cast<Index>(result.parents.size()); ++v) {
        result.parents[v] = v;
    }
    for (auto i = static_cast<Index>(edges.size()); i-- > 0;) {
        if (is_kept[i] == 0) {
            result.has_edge[edges[i].edge] = 0;
            result.parents[edges[i].from] = result.parents[edges[i].to];  // which burnt later
        }
    }
    return result;
}

// Vertices of the complex along a curve, from one end or junction to the next; of a loop the first is the last, too.
using Chain = std::vector<Index>;

class ChainWalk {
   public:
    ChainWalk(const MedialComplex& complex, const Remainder& remainder, const std::vector<std::uint8_t>& has_edge)
        : complex_(complex), degrees_(complex.vertices.size()), is_in_sheet_(complex.vertices.size()) {
        for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
            if (has_edge[e] == 0) {
                continue;
            }
            if (remainder.faces_at_edge[e].count == 0) {
                bare_.push_back(e);
            }
            for (const Index v : complex.edges[e]) {
                ++degrees_[v];
                is_in_sheet_[v] = remainder.faces_at_edge[e].count > 0 ? 1 : is_in_sheet_[v];
            }
        }
        at_vertex_ = grouped(complex.vertices.size(), [&](const auto& add) {
            for (const Index e : bare_) {
                add(complex.edges[e][0], e);
                add(complex.edges[e][1], e);
            }
        });
        is_walked_.resize(complex.edges.size());
    }

    std::vector<Chain> run() {
        std::vector<Chain> chains;
        for (const bool are_loops : {false, true}) {
            for (const Index e : bare_) {
                for (const Index v : complex_.edges[e]) {
                    if (is_walked_[e] == 0 && (are_loops || is_special(v))) {
                        chains.push_back(walk(v, e));
                    }
                }
            }
        }
        return chains;
    }

    bool is_special(Index v) const { return degrees_[v] != 2 || is_in_sheet_[v] != 0; }
    bool is_end(Index v) const { return degrees_[v] == 1 && is_in_sheet_[v] == 0; }
    bool is_junction(Index v) const { return degrees_[v] > 2 && is_in_sheet_[v] == 0; }
    bool is_in_sheet(Index v) const { return is_in_sheet_[v] != 0; }
    /// Edges without faces at a vertex.
    std::span<const Index> edges_at(Index v) const { return at_vertex_[v]; }

   private:
    Chain walk(Index start, Index edge) {
        Chain chain{start};
        for (;;) {
            is_walked_[edge] = 1;
            const Index v = other_end(complex_.edges[edge], chain.back());
            chain.push_back(v);
            if (is_special(v) || v == start) {
                return chain;
            }
            const std::span<const Index> at = at_vertex_[v];
            edge = at[0] == edge ? at[1] : at[0];
        }
    }

    const MedialComplex& complex_;
    std::vector<Index> degrees_;
    std::vector<std::uint8_t> is_in_sheet_;
    std::vector<Index> bare_;
    IndexLists at_vertex_;
    std::vector<std::uint8_t> is_walked_;
};

// By how much an end is a limb, if not less than 0: the disc that the fire has burnt at its tip has to stick out of all
// discs along the other curves at its junction, by its radius and by a part of theirs; in the solid, since grown balls
// hide limbs. \param chain from the tip to the junction
double limb_margin(const Burnt& burnt, const ChainWalk& walk, const Chain& chain, double significance) {
    const MedialComplex& complex = burnt.complex;
    const Index tip = chain.front();
    double least = kInfinity;
    std::vector<Index> seen{chain.back()};
    std::unordered_set<Index> is_seen(chain.begin(), chain.end());
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const Index v = seen[i];
        const double way = distance(complex.vertices[tip], complex.vertices[v]);
        const double excess = way + burnt.time_in_solid(tip) - burnt.time_in_solid(v);
        const double part = kLeastBlend * std::min(burnt.time_in_solid(v), kWideFactor * complex.radii[v]);
        least = std::min(least, excess - significance * (complex.radii[tip] + part));
        for (const Index e : walk.edges_at(v)) {
            const Index next = other_end(complex.edges[e], v);
            if ((i == 0 || way < kMostRadii * burnt.vertex_times[v]) && is_seen.insert(next).second) {
                seen.push_back(next);
            }
        }
    }
    return least;
}

// Removes ends that are no limbs, one at each junction. \return whether there were any
bool remove_short_ends(const Burnt& burnt, const Remainder& remainder, double significance, Pruned& pruned) {
    const MedialComplex& complex = burnt.complex;
    ChainWalk walk(complex, remainder, pruned.has_edge);
    struct ShortEnd {
        double margin;
        Chain chain;  // from the tip on
    };
    std::vector<ShortEnd> ends;
    for (Chain& chain : walk.run()) {
        if (walk.is_junction(chain.front())) {
            std::ranges::reverse(chain);
        }
        if (walk.is_end(chain.front()) && walk.is_junction(chain.back())) {
            if (const double margin = limb_margin(burnt, walk, chain, significance); margin < 0.0) {
                ends.push_back({margin, std::move(chain)});
            }
        }
    }
    std::ranges::stable_sort(ends, {}, &ShortEnd::margin);
    std::vector<std::uint8_t> is_done(complex.vertices.size());  // junctions, one end of each at a time
    std::vector<std::uint8_t> is_gone(complex.vertices.size());
    for (const auto& [margin, chain] : ends) {
        if (is_done[chain.back()] == 0) {
            is_done[chain.back()] = 1;
            for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
                is_gone[chain[k]] = 1;
                pruned.parents[chain[k]] = chain.back();
            }
        }
    }
    for (Index& parent : pruned.parents) {
        parent = pruned.parents[parent];
    }
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (is_gone[complex.edges[e][0]] != 0 || is_gone[complex.edges[e][1]] != 0) {
            pruned.has_edge[e] = 0;
        }
    }
    return !ends.empty();
}

// The vertices of a chain without those on detours that lie in one ball, which is convex, so that the chord is in the
// solid, too. Where sheets lie close together collapses leave curves that go along one of them and back along the
// other.
Chain without_detours(const Burnt& burnt, const Chain& chain) {
    constexpr double kDetour = 2.0;  // of the chord; below √2 bends of 90 degrees would be cut, too
    const std::vector<Point>& vertices = burnt.complex.vertices;
    Chain result{chain.front()};
    for (std::size_t i = 0; i + 1 < chain.size();) {
        std::size_t next = i + 1;
        double most = 0.0;
        double way = 0.0;
        for (std::size_t k = i + 1; k < chain.size(); ++k) {
            const double chord = distance(vertices[chain[i]], vertices[chain[k]]);
            if (chord > burnt.complex.radii[chain[i]]) {
                break;
            }
            way += distance(vertices[chain[k - 1]], vertices[chain[k]]);
            if (way - kDetour * chord > most) {
                most = way - kDetour * chord;
                next = k;
            }
        }
        i = next;
        result.push_back(chain[i]);
    }
    return result;
}

// A point with a parameter, where a smooth curve is to pass by.
struct CurvePoint {
    double position;
    Point point;
};

// The value there of the square polynomial that is closest to the points within a window: a local regression
// (W. Cleveland, "Robust locally weighted regression and smoothing scatterplots", 1979). It keeps the ends, and does
// not shrink bends as means do.
Point regression(std::span<const CurvePoint> points, double position, double window) {
    const auto from = std::ranges::lower_bound(points, position - window, {}, &CurvePoint::position);
    const auto to = std::ranges::upper_bound(points, position + window, {}, &CurvePoint::position);
    std::array<double, 5> moments{};
    std::array<Point, 3> sums{};
    for (auto at = from; at != to; ++at) {
        const double t = (at->position - position) / window;
        const double cube = 1.0 - std::abs(t * t * t);
        double power = cube * cube * cube;
        for (std::size_t k = 0; k < 5; ++k) {
            moments[k] += power;
            if (k < 3) {
                sums[k] = sums[k] + power * at->point;
            }
            power *= t;
        }
    }
    const auto& [m0, m1, m2, m3, m4] = moments;
    const double c0 = m2 * m4 - m3 * m3;
    const double c1 = m2 * m3 - m1 * m4;
    const double c2 = m1 * m3 - m2 * m2;
    const double determinant = m0 * c0 + m1 * c1 + m2 * c2;
    if (determinant > kRelativeRounding * m0 * m0 * m0) {
        return (1.0 / determinant) * (c0 * sums[0] + c1 * sums[1] + c2 * sums[2]);
    }
    const double line = m0 * m2 - m1 * m1;
    return line > kRelativeRounding * m0 * m0 ? (1.0 / line) * (m2 * sums[0] - m1 * sums[1]) : (1.0 / m0) * sums[0];
}

// A chain made smooth.
struct SmoothChain {
    std::vector<Point> points;      // of each vertex
    std::vector<double> positions;  // lengths from the first one
    std::vector<double> windows;
};

SmoothChain smoothed(const Burnt& burnt, const Chain& chain, bool is_loop) {
    const std::vector<Point>& vertices = burnt.complex.vertices;
    const std::size_t count = chain.size();
    std::vector<CurvePoint> points;
    double length = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        length += i > 0 ? distance(vertices[chain[i - 1]], vertices[chain[i]]) : 0.0;
        points.push_back({length, vertices[chain[i]]});
    }
    const double least_window = kWindowFactor * length / static_cast<double>(count - 1);
    SmoothChain result;
    for (const Index v : chain) {
        const double window = kWindowFactor * burnt.vertex_times[v];
        result.windows.push_back(std::max(least_window, is_loop ? std::min(window, 0.25 * length) : window));
    }
    std::vector<CurvePoint> all = points;
    if (is_loop) {  // once more before and after, without the vertex that is first and last
        all.clear();
        for (const double shift : {-length, 0.0, length}) {
            for (std::size_t i = 0; i + 1 < count; ++i) {
                all.push_back({points[i].position + shift, points[i].point});
            }
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        result.points.push_back(regression(all, points[i].position, result.windows[i]));
    }
    return result;
}

// Lets a chain begin (or, reversed, end) at a place that is not quite its own.
void shift_begin(SmoothChain& chain, const Point& begin) {
    const Point shift = begin - chain.points[0];
    double length = 0.0;
    Point previous = chain.points[0];
    for (std::size_t i = 0; i < chain.points.size(); ++i) {
        length += distance(previous, chain.points[i]);
        previous = chain.points[i];
        const double part = std::max(0.0, 1.0 - length / chain.windows[0]);
        chain.points[i] = chain.points[i] + part * shift;
    }
}

void reverse(SmoothChain& chain) {
    std::ranges::reverse(chain.points);
    std::ranges::reverse(chain.windows);
}

// The radius of the largest ball around a point; nothing where that lies outside.
using RadiusAt = std::function<std::optional<double>(const Point&)>;

// The skeleton of the chains that are left.
class Assembly {
   public:
    Assembly(const Burnt& burnt, const Remainder& remainder, const Pruned& pruned, const RadiusAt& radius_at,
             double spacing, std::size_t given_vertices)
        : burnt_(burnt),
          remainder_(remainder),
          parents_(pruned.parents),
          radius_at_(radius_at),
          spacing_(spacing),
          given_vertices_(given_vertices),
          walk_(burnt.complex, remainder, pruned.has_edge),
          chains_(walk_.run()),
          groups_(burnt.complex.vertices.size()),
          vertex_nodes_(burnt.complex.vertices.size(), kNone) {}

    Skeleton run() {
        remove_detours();
        join_junctions();
        smooth_chains();
        add_groups();
        for (std::size_t c = 0; c < chains_.size(); ++c) {
            add_branch(c);
        }
        place_nodes();
        add_sheets();
        find_thickest_branches();
        number_components();
        map_vertices();
        return std::move(result_);
    }

   private:
    // A node that is to be: where it should be, and where it surely can.
    struct Place {
        Point target;
        Index source;  // a vertex
    };

    bool is_loop(const Chain& chain) const { return chain.front() == chain.back() && !walk_.is_special(chain.front()); }

    void remove_detours() {
        for (Chain& chain : chains_) {
            if (is_loop(chain)) {
                continue;
            }
            Chain rest = without_detours(burnt_, chain);
            std::ranges::reverse(rest);
            rest = without_detours(burnt_, rest);  // which looks at the balls at the other end
            std::ranges::reverse(rest);
            std::size_t k = 0;
            for (const Index v : chain) {
                k += k + 1 < rest.size() && rest[k + 1] == v ? 1 : 0;
                parents_[v] = rest[k];
            }
            chain = rest;
        }
        for (Index& parent : parents_) {
            parent = parents_[parent];
        }
    }

    // Junctions nearby, deep within each other's balls, become one.
    void join_junctions() {
        std::vector<std::tuple<double, std::size_t>> short_chains;
        for (std::size_t c = 0; c < chains_.size(); ++c) {
            const Index a = chains_[c].front();
            const Index b = chains_[c].back();
            const double length = distance(burnt_.complex.vertices[a], burnt_.complex.vertices[b]);
            if (walk_.is_junction(a) && walk_.is_junction(b) &&
                length < kNearby * std::min(burnt_.radius(a), burnt_.radius(b))) {
                short_chains.emplace_back(length, c);
            }
        }
        std::ranges::sort(short_chains);
        std::vector<std::uint8_t> is_joined(chains_.size());
        for (const auto& [length, c] : short_chains) {
            const Chain& chain = chains_[c];
            if (groups_.find(chain.front()) != groups_.find(chain.back())) {
                for (const Index v : chain) {
                    groups_.join(chain.front(), v);
                }
                is_joined[c] = 1;
            }
        }
        std::vector<Chain> rest;
        for (std::size_t c = 0; c < chains_.size(); ++c) {
            if (is_joined[c] == 0) {
                rest.push_back(std::move(chains_[c]));
            }
        }
        chains_ = std::move(rest);
    }

    // Curves begin and end where those that meet there agree on.
    void smooth_chains() {
        struct Mean {
            Point sum{};
            double count = 0.0;
        };
        std::map<Index, Mean> means;  // of groups
        for (const Chain& chain : chains_) {
            smooth_.push_back(smoothed(burnt_, chain, is_loop(chain)));
            for (const auto& [v, at] : {std::pair(chain.front(), smooth_.back().points.front()),
                                        std::pair(chain.back(), smooth_.back().points.back())}) {
                Mean& mean = means[groups_.find(v)];
                mean.sum = mean.sum + at;
                mean.count += 1.0;
            }
        }
        for (std::size_t c = 0; c < chains_.size(); ++c) {
            for (const Index v : {chains_[c].front(), chains_[c].back()}) {
                const Mean& mean = means[groups_.find(v)];
                shift_begin(smooth_[c],
                            walk_.is_in_sheet(v) ? burnt_.complex.vertices[v] : (1.0 / mean.count) * mean.sum);
                reverse(smooth_[c]);
            }
            SmoothChain& chain = smooth_[c];
            double length = 0.0;
            for (std::size_t i = 0; i < chain.points.size(); ++i) {
                length += i > 0 ? distance(chain.points[i - 1], chain.points[i]) : 0.0;
                chain.positions.push_back(length);
            }
        }
    }

    Index add_node(const Place& place) {
        places_.push_back(place);
        result_.node_branches.push_back(kNone);
        return static_cast<Index>(places_.size()) - 1;
    }

    // Ends, junctions, single balls, and what is in sheets.
    void add_groups() {
        std::vector<Index> biggest(burnt_.complex.vertices.size(), kNone);  // vertex of each group
        const auto count = static_cast<Index>(burnt_.complex.vertices.size());
        std::vector<std::uint8_t> is_node(count);
        std::vector<std::uint8_t> is_in_chain(count);
        for (const Chain& chain : chains_) {
            for (const Index v : chain) {
                is_in_chain[v] = 1;
            }
            is_node[groups_.find(chain.front())] = 1;
            is_node[groups_.find(chain.back())] = 1;
        }
        for (Index v = 0; v < count; ++v) {
            if (parents_[v] == v) {
                const Index group = groups_.find(v);
                if (walk_.is_in_sheet(v) || (is_in_chain[v] == 0 && group == v)) {
                    is_node[group] = 1;
                }
                if (biggest[group] == kNone || burnt_.radius(v) > burnt_.radius(biggest[group])) {
                    biggest[group] = v;
                }
            }
        }
        group_nodes_.assign(count, kNone);
        for (Index v = 0; v < count; ++v) {
            if (is_node[v] != 0) {
                group_nodes_[v] = add_node({burnt_.complex.vertices[biggest[v]], biggest[v]});
            }
        }
        for (std::size_t c = 0; c < chains_.size(); ++c) {
            places_[node_at(chains_[c].front())].target = smooth_[c].points.front();
            places_[node_at(chains_[c].back())].target = smooth_[c].points.back();
        }
    }

    void add_edge(Index a, Index b) { result_.edges.push_back({std::min(a, b), std::max(a, b)}); }

    Index node_at(Index v) { return group_nodes_[groups_.find(v)]; }

    // No two edges between the same nodes.
    Index least_edges(Index first, Index last, bool ends_in_sheet) {
        if (first == last) {
            return 3;
        }
        const bool is_new = has_branch_.insert(std::minmax(first, last)).second;
        return is_new && !ends_in_sheet ? 1 : 2;
    }

    void add_branch(std::size_t c) {
        const Chain& chain = chains_[c];
        const SmoothChain& smooth = smooth_[c];
        const Index first = node_at(chain.front());
        const Index last = node_at(chain.back());
        const double length = smooth.positions.back();
        const bool ends_in_sheet = walk_.is_in_sheet(chain.front()) || walk_.is_in_sheet(chain.back());
        const Index count = std::max(least_edges(first, last, ends_in_sheet),
                                     static_cast<Index>(std::ceil(length / spacing_ - kRelativeRounding)));
        std::vector<Index> branch{first};
        std::size_t i = 0;
        for (Index k = 1; k < count; ++k) {
            const double position = length * k / count;
            while (i + 2 < smooth.positions.size() && smooth.positions[i + 1] < position) {
                ++i;
            }
            const double step = smooth.positions[i + 1] - smooth.positions[i];
            const double t = step > 0.0 ? std::clamp((position - smooth.positions[i]) / step, 0.0, 1.0) : 0.5;
            const Point target = smooth.points[i] + t * (smooth.points[i + 1] - smooth.points[i]);
            branch.push_back(add_node({target, t < 0.5 ? chain[i] : chain[i + 1]}));
            result_.node_branches[branch.back()] = static_cast<Index>(c);
        }
        branch.push_back(last);
        for (std::size_t k = 1; k < branch.size(); ++k) {
            add_edge(branch[k - 1], branch[k]);
        }
        for (std::size_t k = 1; k + 1 < chain.size(); ++k) {
            const double part = length > 0.0 ? smooth.positions[k] / length : 0.5;
            vertex_nodes_[chain[k]] = branch[static_cast<std::size_t>(std::lround(part * count))];
        }
        result_.branches.push_back(branch);
    }

    // Smoothing must not lead out of the solid, nor far from its middle.
    void place_nodes() {
        result_.nodes.resize(places_.size());
        result_.radii.resize(places_.size());
        for_each_index(
            places_.size(),
            [&](std::size_t n) {
                const auto& [target, source] = places_[n];
                const Point& start = burnt_.complex.vertices[source];
                // Between balls of a union it may be one and a half times the error of the radius less. With half of
                // the radius lost there would be a stenosis at each fork.
                const double least = (1.0 - 2.0 * kRadiusError) * burnt_.complex.radii[source];
                for (double part = 1.0; part > 0.1; part *= 0.5) {
                    const Point p = start + part * (target - start);
                    if (const auto radius = radius_at_(p); radius && *radius >= least) {
                        result_.nodes[n] = p;
                        result_.radii[n] = *radius;
                        return;
                    }
                }
                result_.nodes[n] = start;
                result_.radii[n] = burnt_.complex.radii[source];
            },
            std::size_t{64});
    }

    void add_sheets() {
        const MedialComplex& complex = burnt_.complex;
        for (std::size_t f = 0; f < complex.faces.size(); ++f) {
            if (remainder_.has_face[f] != 0) {
                const auto corners = each_of<Index>(complex.faces[f], [&](Index v) { return node_at(v); });
                result_.faces.push_back(corners);
            }
        }
        for (std::size_t e = 0; e < complex.edges.size(); ++e) {
            if (remainder_.faces_at_edge[e].count > 0) {
                add_edge(node_at(complex.edges[e][0]), node_at(complex.edges[e][1]));
            }
        }
        std::ranges::sort(result_.edges);
    }

    void find_thickest_branches() {
        std::vector<double> thickest(places_.size(), -1.0);
        for (Index b = 0; b < static_cast<Index>(result_.branches.size()); ++b) {
            const std::span<const Index> branch = result_.branches[b];
            double sum = 0.0;
            for (const Index n : branch) {
                sum += result_.radii[n];
            }
            const double mean = sum / static_cast<double>(branch.size());
            for (const Index n : {branch.front(), branch.back()}) {
                if (mean > thickest[n]) {
                    thickest[n] = mean;
                    result_.node_branches[n] = b;
                }
            }
        }
    }

    void number_components() {
        DisjointSets sets(result_.nodes.size());
        for (const auto& [a, b] : result_.edges) {
            sets.join(a, b);
        }
        result_.node_components = sets.numbered().first;
    }

    void map_vertices() {
        for (Index v = 0; v < static_cast<Index>(vertex_nodes_.size()); ++v) {
            if (parents_[v] == v && vertex_nodes_[v] == kNone) {
                vertex_nodes_[v] = node_at(v);
            }
        }
        result_.vertex_nodes.resize(given_vertices_);
        for (std::size_t v = 0; v < given_vertices_; ++v) {
            result_.vertex_nodes[v] = vertex_nodes_[parents_[v]];
        }
    }

    const Burnt& burnt_;
    const Remainder& remainder_;
    std::vector<Index> parents_;  // see `Pruned`
    const RadiusAt& radius_at_;
    double spacing_;
    std::size_t given_vertices_;
    ChainWalk walk_;
    std::vector<Chain> chains_;
    DisjointSets groups_;  // of vertices: those that are one node
    std::vector<SmoothChain> smooth_;
    std::vector<Place> places_;        // of the nodes
    std::vector<Index> group_nodes_;   // of the first vertex of each group
    std::vector<Index> vertex_nodes_;  // of vertices that stay
    std::set<std::pair<Index, Index>> has_branch_;
    Skeleton result_;
};

// The mean distance from a point to the boundary in the plane normal to a direction; ways that lead on into other parts
// of the solid do not count.
double mean_radius(const Solid& solid, const Point& p, const Point& direction, double inscribed) {
    constexpr int kWays = 32;
    constexpr double kMostWay = 3.0;  // in inscribed radii: sections up to three times as wide as high count whole
    double sum = 0.0;
    double count = 0.0;
    for (const double way : ways_out(solid, p, direction, kWays, std::array{kMostWay * inscribed})) {
        if (way != kInfinity) {
            sum += way;
            count += 1.0;
        }
    }
    return count > 0.5 * kWays ? sum / count : inscribed;
}

// The same for all nodes that have a direction.
void set_mean_radii(const Solid& solid, Skeleton& skeleton) {
    const IndexLists neighbors = grouped_both_ways(skeleton.nodes.size(), skeleton.edges);
    for_each_index(
        skeleton.nodes.size(),
        [&](std::size_t n) {
            const std::span<const Index> near = neighbors[n];
            if (near.size() == 1 || near.size() == 2) {
                const Point& before = near.size() == 2 ? skeleton.nodes[near[1]] : skeleton.nodes[n];
                const Point direction = unit(skeleton.nodes[near[0]] - before);
                skeleton.radii[n] = mean_radius(solid, skeleton.nodes[n], direction, skeleton.radii[n]);
            }
        },
        std::size_t{16});
}

void validate(const SkeletonOptions& options) {
    require(options.spacing >= 0.0 && std::isfinite(options.spacing),
            "the spacing of the nodes must be a number of at least 0");
    require(options.significance >= 0.0 && std::isfinite(options.significance),
            "the significance of branches must be a number of at least 0");
}

double spacing_of(const SkeletonOptions& options, const MedialComplex& complex) {
    if (options.spacing > 0.0) {
        return options.spacing;
    }
    return kDefaultTolerance * box_of_balls(complex).diagonal();
}

Skeleton skeleton_with(const MedialComplex& complex, const RadiusAt& radius_at, const SkeletonOptions& options,
                       const Execution& execution) {
    check(complex);
    report(execution, kSkeletonStage, 0.0);
    if (complex.vertices.empty()) {
        return {};
    }
    const Burnt burnt = burnt_sheets(complex);
    const Remainder remainder = collapsed_faces(burnt);
    Pruned pruned = pruned_curves(burnt, remainder, options.significance);
    while (remove_short_ends(burnt, remainder, options.significance, pruned)) {
        stop_if_cancelled();
    }
    report(execution, kSkeletonStage, 0.4);
    Skeleton result =
        Assembly(burnt, remainder, pruned, radius_at, spacing_of(options, complex), complex.vertices.size()).run();
    report(execution, kSkeletonStage, 1.0);
    return result;
}

}  // namespace

std::vector<Index> degrees(const Skeleton& skeleton) {
    std::vector<Index> result(skeleton.nodes.size());
    for (const auto& edge : skeleton.edges) {
        for (const Index n : edge) {
            ++result[n];
        }
    }
    return result;
}

std::vector<Index> branch_degrees(const Skeleton& skeleton) {
    std::vector<Index> result(skeleton.nodes.size());
    for (std::size_t b = 0; b < skeleton.branches.size(); ++b) {
        const std::span<const Index> branch = skeleton.branches[b];
        for (std::size_t k = 1; k < branch.size(); ++k) {
            ++result[branch[k - 1]];
            ++result[branch[k]];
        }
    }
    return result;
}

double branch_length(const Skeleton& skeleton, Index branch) {
    const std::span<const Index> nodes = skeleton.branches[branch];
    double length = 0.0;
    for (std::size_t k = 1; k < nodes.size(); ++k) {
        length += distance(skeleton.nodes[nodes[k - 1]], skeleton.nodes[nodes[k]]);
    }
    return length;
}

MedialComplex complex_of(const Skeleton& skeleton) {
    MedialComplex complex;
    complex.vertices = skeleton.nodes;
    complex.radii = skeleton.radii;
    complex.vertex_origins.resize(skeleton.nodes.size());
    complex = with_linear_radii(std::move(complex));
    complex.faces = skeleton.faces;
    complex.face_angles.assign(skeleton.faces.size(), 0.0);
    build_edges(complex, skeleton.edges);
    label_sheets(complex);
    return complex;
}

Topology topology(const Skeleton& skeleton) { return topology_of(complex_of(skeleton)); }

SkeletonStatistics statistics_of(const Skeleton& skeleton, const MedialComplex& complex) {
    SkeletonStatistics result;
    result.nodes = static_cast<Index>(skeleton.nodes.size());
    result.branches = static_cast<Index>(skeleton.branches.size());
    result.faces = static_cast<Index>(skeleton.faces.size());
    result.ends = static_cast<Index>(std::ranges::count(degrees(skeleton), 1));
    result.junctions =
        static_cast<Index>(std::ranges::count_if(branch_degrees(skeleton), [](Index degree) { return degree > 2; }));
    double sum = 0.0;
    for (Index b = 0; b < result.branches; ++b) {
        const std::span<const Index> branch = skeleton.branches[b];
        for (std::size_t k = 1; k < branch.size(); ++k) {
            const double length = distance(skeleton.nodes[branch[k - 1]], skeleton.nodes[branch[k]]);
            result.length += length;
            sum += 0.5 * length * (skeleton.radii[branch[k - 1]] + skeleton.radii[branch[k]]);
        }
    }
    if (!skeleton.radii.empty()) {
        const auto [least, largest] = std::ranges::minmax(skeleton.radii);
        result.least_radius = least;
        result.largest_radius = largest;
        double all = 0.0;
        for (const double radius : skeleton.radii) {
            all += radius;
        }
        result.mean_radius =
            result.length > 0.0 ? sum / result.length : all / static_cast<double>(skeleton.radii.size());
    }
    result.complex_topology = topology(complex);
    result.topology = topology(skeleton);
    return result;
}

Skeleton skeleton(const MedialComplex& complex, const BallUnion& ball_union, const SkeletonOptions& options,
                  const Execution& execution) {
    validate(options);
    require(options.radius != SkeletonRadius::kMean,
            "mean radii need the solid: of an axis alone a skeleton has the inscribed ones");
    return in_arena(execution, [&] {
        const UnionInterior& interior = ball_union.data().interior();
        const auto radius_at = [&](const Point& p) -> std::optional<double> {
            const auto nearest = nearest_from_inside(interior, p);
            return nearest ? std::optional(nearest->distance / complex.scale) : std::nullopt;
        };
        return skeleton_with(complex, radius_at, options, execution);
    });
}

Skeleton skeleton(const MedialComplex& complex, const Solid& solid, const SkeletonOptions& options,
                  const Execution& execution) {
    validate(options);
    return in_arena(execution, [&] {
        solid.prepare_nearest();
        const auto radius_at = [&](const Point& p) -> std::optional<double> {
            const std::optional<Point> nearest = solid.nearest(p);
            return nearest && solid.inside(p) ? std::optional(distance(p, *nearest)) : std::nullopt;
        };
        Skeleton result = skeleton_with(complex, radius_at, options, execution);
        if (options.radius == SkeletonRadius::kMean) {
            set_mean_radii(solid, result);
        }
        return result;
    });
}

Skeleton skeleton(const MedialComplex& complex, const SkeletonOptions& options, const Execution& execution) {
    validate(options);
    check(complex);
    if (complex.vertices.empty()) {
        return {};
    }
    const BallUnion ball_union = grown_union(complex, {execution.threads, {}, execution.cancel});
    return skeleton(complex, ball_union, options, execution);
}

std::vector<Index> nearest_nodes(const Skeleton& skeleton, const MedialComplex& complex, std::span<const Point> points,
                                 const Execution& execution) {
    require(skeleton.vertex_nodes.size() == complex.vertices.size(),
            "the skeleton is not that of this complex: their numbers of vertices differ");
    std::vector<Ball> balls;
    std::vector<Index> nodes;
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        if (!is_on_sharp_edge(complex, v)) {  // which adds nothing to a union
            balls.push_back({complex.vertices[v], complex.radii[v]});
            nodes.push_back(skeleton.vertex_nodes[v]);
        }
    }
    return each_of<Index>(BallUnion(std::move(balls)).nearest_balls(points, execution),
                          [&](const NearestBall& nearest) { return nodes[nearest.ball]; });
}

}  // namespace scaleaxis::inline v1
