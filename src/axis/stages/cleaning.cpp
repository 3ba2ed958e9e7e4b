// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/cleaning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/collapse.hpp"
#include "axis/edit/slivers.hpp"
#include "axis/stages/curve_fire.hpp"
#include "axis/stages/fire.hpp"
#include "axis/stages/resolved_fire.hpp"
#include "axis/stages/stages.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "spatial/ball_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kCleaningStage = "cleaning";
constexpr double kOpeningSlack =
    0.1;  // of T: how far discs need not reach the border, which they meet in a row of arcs
// Of an edge whose ends are to go: where its inside may have to stay.
constexpr std::array kPartsLookedAt{0.25, 0.5, 0.75};
constexpr double kLeastCut = 0.2;  // of an edge: cuts closer to an end go through the end
// Of T: how much later than balls of the union the fire may start between vertices of the border. A third of T takes
// rims of curved walls, which are led on straight, off their middle; all of it leaves some more sheets.
constexpr double kLateStart = 0.75;
constexpr double kCurveFactor = 2.0;  // curves are longer than sheets are deep

double local_thickness(double thickness, double radius) { return std::min(thickness, 0.5 * radius); }

// Which sectors lie at a sharp edge of the solid: those of faces that end in balls of radius 0, in sheets that have an
// edge between two such balls.
std::vector<std::uint8_t> at_sharp_edges(const MedialComplex& complex, const Sectors& sectors) {
    const auto is_sharp = [&](Index v) { return is_on_sharp_edge(complex, v); };
    std::vector<std::uint8_t> is_sharp_sheet(complex.sheets);
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index e : complex.face_edges[f]) {
            if (is_sharp(complex.edges[e][0]) && is_sharp(complex.edges[e][1])) {
                is_sharp_sheet[complex.face_sheets[f]] = 1;
            }
        }
    }
    std::vector<std::uint8_t> result(sectors.vertices.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (is_sharp_sheet[complex.face_sheets[f]] != 0 && std::ranges::any_of(complex.faces[f], is_sharp)) {
            for (Index c = complex.faces.offsets[f]; c < complex.faces.offsets[f + 1]; ++c) {
                result[sectors.of_corner[c]] = 1;
            }
        }
    }
    return result;
}

// Which sheets are but crumbs on others: they are nowhere as thick as `thickness`, but their component is.
std::vector<std::uint8_t> crumbs_of(const MedialComplex& complex, const std::vector<double>& radii,
                                    const Sectors& sectors, const Fire& fire, double thickness) {
    DisjointSets components(complex.vertices.size());
    for (const auto& [a, b] : complex.edges) {
        components.join(a, b);
    }
    std::vector<std::uint8_t> is_crumb(complex.sheets, 1);
    std::vector<std::uint8_t> has_thick(complex.vertices.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (Index c = complex.faces.offsets[f]; c < complex.faces.offsets[f + 1]; ++c) {
            const Index v = complex.faces.items[c];
            if (fire.sector_times[sectors.of_corner[c]] - radii[v] >= thickness) {
                is_crumb[complex.face_sheets[f]] = 0;
                has_thick[components.find(v)] = 1;
            }
        }
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (has_thick[components.find(complex.faces[f][0])] == 0) {
            is_crumb[complex.face_sheets[f]] = 0;
        }
    }
    return is_crumb;
}

// What is to be kept: what has enough erosion thickness, which is less beside small balls but not in crumbs, and then
// whatever discs around kept points cover that are as large as the way of the fire to these points. That is an opening,
// within each sheet.
class Opening {
   public:
    Opening(const BurntComplex& burnt, double thickness) : depths_(burnt.sectors.vertices.size(), -kInfinity) {
        const auto& [complex, radii, sides, sectors, fire] = burnt;
        const std::vector<std::uint8_t> is_sharp = at_sharp_edges(complex, sectors);
        const std::vector<std::uint8_t> is_crumb = crumbs_of(complex, radii, sectors, fire, thickness);
        std::vector<Index> sheets(depths_.size());
        for (std::size_t c = 0; c < sectors.of_corner.size(); ++c) {
            sheets[sectors.of_corner[c]] = complex.face_sheets[sides.face_of[c]];
        }
        std::vector<std::vector<Ball>> discs(complex.sheets);
        std::vector<Index> low;
        for (Index s = 0; s < static_cast<Index>(depths_.size()); ++s) {
            const Index v = sectors.vertices[s];
            const double least = local_thickness(thickness, radii[v]);
            if (is_sharp[s] != 0) {
                depths_[s] = fire.sector_paths[s] + kOpeningSlack * thickness;
            } else if (radii[v] > 0.0 && is_crumb[sheets[s]] == 0 && fire.sector_times[s] - radii[v] >= least) {
                depths_[s] = fire.sector_paths[s] + kOpeningSlack * least;
            } else {
                low.push_back(s);
                continue;
            }
            if (depths_[s] < kInfinity) {
                discs[sheets[s]].push_back({complex.vertices[v], depths_[s]});
            }
        }
        trees_.resize(discs.size());
        for (const Index s : low) {
            if (const Index sheet = sheets[s]; !trees_[sheet] && !discs[sheet].empty()) {
                trees_[sheet] = build_ball_tree(discs[sheet]);
            }
        }
        for_each_index(low.size(), [&](std::size_t i) {
            const Index at = burnt.sectors.vertices[low[i]];
            depths_[low[i]] = depth_at(burnt.complex.vertices[at], sheets[low[i]]);
        });
    }

    /// How deep inside what is to be kept the sectors lie: ≥ 0 what is kept.
    const std::vector<double>& depths() const { return depths_; }

    /// The same at a point of a sheet.
    double depth_at(const Point& at, Index sheet) const {
        return trees_[sheet] ? -nearest_ball(*trees_[sheet], at).distance : -kInfinity;
    }

   private:
    std::vector<double> depths_;
    std::vector<std::optional<BallTree>> trees_;  // of the discs in each sheet, where it is not kept as a whole
};

// A complex whose faces are all kept or all to go.
struct Divided {
    MedialComplex complex;
    std::vector<double> radii;         // that the fire takes
    std::vector<double> vertex_paths;  // ways of the fire within the sheets, the longest at each vertex
    std::vector<std::uint8_t> is_low;  // of each face: to go
    std::vector<Index> parents;        // of each face, the one that was divided
    std::vector<double> edge_times;
};

// Where the depth is zero on an edge from `a` to `b`. Around voids it is infinite: all of the edge is kept then.
double zero_between(double a, double b) {
    if (std::max(a, b) == kInfinity) {
        return a < b ? 0.0 : 1.0;
    }
    return a / (a - b);
}

// Makes the depth zero at the end of an edge where its zero is close to it; on seams always, for what is cut there
// would be cut in all sheets.
void snap(const MedialComplex& complex, const Sides& sides, const Sectors& sectors, std::vector<double>& depths) {
    std::vector<Index> on_border;
    for (Index side = 0; side < static_cast<Index>(sides.face_of.size()); ++side) {
        const bool is_seam = sides.of_edge[complex.face_edges.items[side]].size() > 2;
        const std::array<Index, 2> corners = corners_at_ends(complex, sides, side);
        const Index p = sectors.of_corner[corners[0]];
        const Index q = sectors.of_corner[corners[1]];
        if ((depths[p] < 0.0) == (depths[q] < 0.0)) {
            continue;
        }
        const double zero = zero_between(depths[p], depths[q]);
        const double least = is_seam ? 0.5 : kLeastCut;
        if (zero < least) {
            on_border.push_back(p);
        } else if (zero >= 1.0 - least) {
            on_border.push_back(q);
        }
    }
    for (const Index s : on_border) {
        depths[s] = 0.0;
    }
}

// Divides faces along the zero of the depth.
class Division {
   public:
    Division(const BurntComplex& burnt, const std::vector<double>& depths)
        : complex_(burnt.complex),
          radii_(burnt.radii),
          sides_(burnt.sides),
          sectors_(burnt.sectors),
          fire_(burnt.fire),
          depths_(depths) {}

    Divided run() && {
        start();
        for (Index f = 0; f < static_cast<Index>(complex_.faces.size()); ++f) {
            divide(f);
        }
        build_edges(result_.complex, curve_edges(complex_));
        return std::move(result_);
    }

   private:
    void start() {
        result_.complex = vertices_of(complex_);
        result_.radii = radii_;
        result_.vertex_paths.resize(complex_.vertices.size());
        for (std::size_t s = 0; s < sectors_.vertices.size(); ++s) {
            double& path = result_.vertex_paths[sectors_.vertices[s]];
            path = std::max(path, fire_.sector_paths[s]);
        }
        cuts_.assign(complex_.edges.size(), kNone);
        for (Index e = 0; e < static_cast<Index>(complex_.edges.size()); ++e) {
            if (sides_.of_edge[e].empty() || sides_.of_edge[e].size() > 2) {
                continue;
            }
            const std::array<Index, 2> corners = corners_at_ends(complex_, sides_, sides_.of_edge[e][0]);
            const Index p = sectors_.of_corner[corners[0]];
            const Index q = sectors_.of_corner[corners[1]];
            if (depths_[p] * depths_[q] < 0.0) {
                add_cut(e, p, q);
            }
        }
    }

    void add_cut(Index edge, Index sector_p, Index sector_q) {
        const auto& [p, q] = complex_.edges[edge];
        const double t = zero_between(depths_[sector_p], depths_[sector_q]);
        const Point& a = complex_.vertices[p];
        const Point& b = complex_.vertices[q];
        const double radius = radius_on_edge(complex_, radii_, edge, t);
        cuts_[edge] = add_vertex(result_.complex, {a + t * (b - a), radius / complex_.scale},
                                 origin_between(complex_.vertex_origins[p], complex_.vertex_origins[q]));
        result_.radii.push_back(radius);
        result_.vertex_paths.push_back((1.0 - t) * fire_.sector_paths[sector_p] + t * fire_.sector_paths[sector_q]);
    }

    void add_part(Index face, std::span<const Index> corners, bool is_low) {
        add_face(result_.complex, corners, values_of(complex_, face));
        result_.is_low.push_back(is_low ? 1 : 0);
        result_.parents.push_back(face);
    }

    void divide(Index face) {
        corners_.clear();
        sides_of_zero_.clear();
        double sum = 0.0;
        for (Index c = complex_.faces.offsets[face]; c < complex_.faces.offsets[face + 1]; ++c) {
            const Index sector = sectors_.of_corner[c];
            const double depth = depths_[sector];
            sum += depth;
            corners_.push_back(complex_.faces.items[c]);
            sides_of_zero_.push_back(depth > 0.0 ? 1 : depth < 0.0 ? -1 : 0);
            if (const Index cut = cuts_[complex_.face_edges.items[c]]; cut != kNone) {
                corners_.push_back(cut);
                sides_of_zero_.push_back(0);
            }
        }
        const std::size_t count = corners_.size();
        // Where the corners below zero begin and end.
        std::size_t runs = 0;
        std::size_t begin = 0;
        std::size_t end = 0;
        bool has_high = false;
        bool has_low = false;
        for (std::size_t k = 0; k < count; ++k) {
            has_high = has_high || sides_of_zero_[k] > 0;
            has_low = has_low || sides_of_zero_[k] < 0;
            const bool is_low = sides_of_zero_[k] < 0;
            if (is_low && sides_of_zero_[(k + count - 1) % count] >= 0) {
                ++runs;
                begin = (k + count - 1) % count;
            }
            if (is_low && sides_of_zero_[(k + 1) % count] >= 0) {
                end = (k + 1) % count;
            }
        }
        if (has_low && !has_high) {
            add_part(face, corners_, true);
        } else if (runs == 1 && sides_of_zero_[begin] == 0 && sides_of_zero_[end] == 0 && begin != end) {
            add_part(face, part(begin, end), true);
            add_part(face, part(end, begin), false);
        } else {
            add_part(face, corners_, has_low && sum < 0.0);
        }
    }

    // The corners from one to another, both included.
    std::vector<Index> part(std::size_t from, std::size_t to) const {
        std::vector<Index> result{corners_[from]};
        for (std::size_t k = from; k != to;) {
            k = (k + 1) % corners_.size();
            result.push_back(corners_[k]);
        }
        return result;
    }

    const MedialComplex& complex_;
    const std::vector<double>& radii_;  // of the grown balls
    const Sides& sides_;
    const Sectors& sectors_;
    const Fire& fire_;
    const std::vector<double>& depths_;
    Divided result_;
    std::vector<Index> cuts_;  // the vertex on each edge
    std::vector<Index> corners_;
    std::vector<int> sides_of_zero_;
};

// A sheet that stays along most of a seam stays along all of it, as far as the others there stay: else the seam would
// open, and they become one. Where others go, as crumbs do, the seam goes on.
void keep_along_seams(Divided& divided, const Sides& sides) {
    const MedialComplex& complex = divided.complex;
    const Sectors sectors = sectors_of(complex, sides);
    const auto is_low = [&](Index side) { return divided.is_low[sides.face_of[side]] != 0; };
    const auto for_each_side = [&](const auto& visit) {  // that stays, or goes alone
        for (std::size_t e = 0; e < complex.edges.size(); ++e) {
            const std::span<const Index> at = sides.of_edge[e];
            if (at.size() < 3) {
                continue;
            }
            const auto& [p, q] = complex.edges[e];
            const double length = distance(complex.vertices[p], complex.vertices[q]);
            const auto low = std::ranges::count_if(at, is_low);
            for (const Index side : at) {
                if (!is_low(side) || low == 1) {
                    const auto [a, b] = corners_at_ends(complex, sides, side);
                    const double more = low == 0 ? length : is_low(side) ? -length : 0.0;
                    visit(sectors.of_corner[a], sectors.of_corner[b], more);
                }
            }
        }
    };
    DisjointSets stretches(sectors.vertices.size());
    for_each_side([&](Index a, Index b, double) { stretches.join(a, b); });
    std::vector<double> stays(sectors.vertices.size());  // how much longer the part that stays is
    for_each_side([&](Index a, Index, double length) { stays[stretches.find(a)] += length; });
    for (std::size_t c = 0; c < sectors.of_corner.size(); ++c) {
        if (stays[stretches.find(sectors.of_corner[c])] > 0.0) {
            divided.is_low[sides.face_of[c]] = 0;
        }
    }
}

// Collapses the faces that are to go, in the order in which they burn, from that of their free edges which burns first.
class FaceCollapse {
   public:
    FaceCollapse(const Divided& divided, double thickness, Remainder& remainder)
        : divided_(divided),
          thickness_(thickness),
          remainder_(remainder),
          has_faces_(edges_with_faces(divided.complex)),
          tips_(divided.radii.size()) {
        for (Index v = 0; v < static_cast<Index>(tips_.size()); ++v) {
            tips_[v] = v;
        }
    }

    void run() {
        const MedialComplex& complex = divided_.complex;
        const auto order = [&](const ElementaryCollapse& collapse) {
            return collapse.has_face && divided_.is_low[collapse.element] != 0
                       ? std::optional(divided_.edge_times[collapse.free])
                       : std::nullopt;
        };
        Collapses collapses(complex, remainder_, order,
                            [&](const ElementaryCollapse& collapse, const std::optional<double>&) {
                                for (const Index v : complex.faces[collapse.element]) {
                                    remove_spur(v);
                                }
                            });
        collapses.add_all();
        collapses.run();
    }

   private:
    // Edges that faces have left behind, up to where the fire was as far from the border as their tip is now: a chain
    // that goes on is the middle of a limb.
    void remove_spur(Index v) {
        const MedialComplex& complex = divided_.complex;
        for (Index edge = remainder_.only_bare_edge(v); edge != kNone; edge = remainder_.only_bare_edge(v)) {
            const Index next = other_end(complex.edges[edge], v);
            const auto way = [&](Index tip) { return distance(complex.vertices[tip], complex.vertices[next]); };
            const double thickness = divided_.radii[tips_[v]] + way(tips_[v]) - divided_.radii[next];
            if (has_faces_[edge] == 0 || way(tips_[v]) > divided_.vertex_paths[next] ||
                thickness > kCurveFactor * thickness_) {
                return;
            }
            remainder_.remove_edge(complex, edge);
            remainder_.has_vertex[v] = 0;
            if (way(tips_[v]) > way(tips_[next])) {
                tips_[next] = tips_[v];
            }
            v = next;
        }
    }

    const Divided& divided_;
    double thickness_;
    Remainder& remainder_;
    std::vector<std::uint8_t> has_faces_;  // of each edge, before anything collapsed
    std::vector<Index> tips_;              // of each vertex, the farthest tip of the spurs that led to it
};

// Balls, to which others are added now and then.
class GrowingUnion {
   public:
    explicit GrowingUnion(std::span<const Ball> balls) : given_(tree_of(balls)) {}

    void add(const Ball& ball) {
        added_.push_back(ball);
        if (added_.size() - built_ > kMostUnbuilt) {
            built_ = added_.size();
            tree_of_added_ = tree_of(added_);
        }
    }

    /// How far a ball sticks out of the ball that covers most of it.
    double beyond(const Ball& ball) const {
        double least = kInfinity;
        for (const auto* tree : {&given_, &tree_of_added_}) {
            if (*tree) {
                least = std::min(least, nearest_ball(**tree, ball.center).distance);
            }
        }
        for (std::size_t i = built_; i < added_.size(); ++i) {
            least = std::min(least, distance(ball.center, added_[i].center) - added_[i].radius);
        }
        return least + ball.radius;
    }

   private:
    static constexpr std::size_t kMostUnbuilt = 256;

    static std::optional<BallTree> tree_of(std::span<const Ball> balls) {
        return balls.empty() ? std::nullopt : std::optional(build_ball_tree(balls));
    }

    std::optional<BallTree> given_;
    std::vector<Ball> added_;  // few beside those given: only their tree is built again
    std::size_t built_ = 0;    // of them, in their tree
    std::optional<BallTree> tree_of_added_;
};

// The balls of the vertices that have faces.
std::vector<Ball> balls_of_sheets(const Divided& divided, const Remainder& remainder) {
    const MedialComplex& complex = divided.complex;
    std::vector<std::uint8_t> is_in_sheet(complex.vertices.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (remainder.has_face[f] != 0) {
            for (const Index v : complex.faces[f]) {
                is_in_sheet[v] = 1;
            }
        }
    }
    std::vector<Ball> balls;
    for (std::size_t v = 0; v < is_in_sheet.size(); ++v) {
        if (is_in_sheet[v] != 0) {
            balls.push_back({complex.vertices[v], divided.radii[v]});
        }
    }
    return balls;
}

// Collapses curves that hardly stick out of the sheets and of longer curves. A curve starts at a tip and ends where a
// longer one, or a sheet, goes on. Curves that stay reach their tips.
void collapse_curves(const Divided& divided, double thickness, Remainder& remainder) {
    const std::vector<BurntEdge> burnt = burn_curves(divided.complex, divided.radii, remainder);
    if (burnt.empty()) {
        return;
    }
    const auto ball_at = [&](Index v) { return Ball{divided.complex.vertices[v], divided.radii[v]}; };
    std::vector<Ball> balls = balls_of_sheets(divided, remainder);
    std::vector<Index> last_edges;  // of the curves
    for (Index i = 0; i < static_cast<Index>(burnt.size()); ++i) {
        if (burnt[i].next == kNone) {
            balls.push_back(ball_at(burnt[i].to));  // the fire ends there
        }
        if (burnt[i].next == kNone || burnt[burnt[i].next].feeder != i) {
            last_edges.push_back(i);
        }
    }
    std::ranges::stable_sort(last_edges, std::greater<>(), [&](Index i) { return burnt[i].time; });
    GrowingUnion kept(balls);
    std::vector<std::uint8_t> is_kept(burnt.size());
    for (const Index last : last_edges) {
        bool sticks_out = false;
        for (Index i = last; i != kNone && !sticks_out; i = burnt[i].feeder) {
            sticks_out = kept.beyond(ball_at(burnt[i].from)) >= kCurveFactor * thickness;
        }
        if (!sticks_out) {
            continue;
        }
        // From the root on. What comes after the last ball that sticks out runs beside the curve.
        std::vector<Index> waiting;
        for (Index i = last; i != kNone; i = burnt[i].feeder) {
            waiting.push_back(i);
            if (kept.beyond(ball_at(burnt[i].from)) >= 0.0) {
                for (const Index k : waiting) {
                    is_kept[k] = 1;
                    kept.add(ball_at(burnt[k].from));
                }
                waiting.clear();
            }
        }
        for (Index i = burnt[last].next; i != kNone && is_kept[i] == 0; i = burnt[i].next) {
            is_kept[i] = 1;
            kept.add(ball_at(burnt[i].from));
        }
    }
    for (std::size_t i = 0; i < burnt.size(); ++i) {
        if (is_kept[i] == 0) {
            remainder.remove_edge(divided.complex, burnt[i].edge);
            remainder.has_vertex[burnt[i].from] = 0;
        }
    }
}

// How far balls that are gone stick out of those that are left.
void add_losses(const Divided& divided, const Remainder& remainder, std::size_t old_vertices,
                CleanStatistics& statistics) {
    std::vector<Ball> kept;
    std::vector<Index> gone;
    for (Index v = 0; v < static_cast<Index>(divided.radii.size()); ++v) {
        if (remainder.has_vertex[v] != 0) {
            kept.push_back({divided.complex.vertices[v], divided.complex.radii[v]});
        } else if (static_cast<std::size_t>(v) < old_vertices) {
            gone.push_back(v);
        }
    }
    statistics.vertices_removed = static_cast<Index>(gone.size());
    if (gone.empty()) {
        return;
    }
    const BallTree balls = build_ball_tree(kept);
    std::vector<double> losses(gone.size());
    std::vector<double> retreats(gone.size());
    for_each_index(
        gone.size(),
        [&](std::size_t i) {
            const Point& at = divided.complex.vertices[gone[i]];
            losses[i] = std::max(0.0, nearest_ball(balls, at).distance + divided.complex.radii[gone[i]]);
            retreats[i] = nearest_center_distance(balls, at);
        },
        std::size_t{64});
    statistics.largest_retreat = std::ranges::max(retreats);
    statistics.largest_loss = std::ranges::max(losses);
    double sum = 0.0;
    for (const double loss : losses) {
        sum += loss;
    }
    statistics.mean_loss = sum / static_cast<double>(losses.size());
}

// Where vertices are missing for the fire to tell what is to be kept: on ridges, and on edges whose ends are to go and
// whose middle is to stay.
Halving cuts_for(const BurntComplex& burnt, const Opening& opening, const CleanOptions& options) {
    const auto is_thick = [&](double thickness, double radius) {
        return thickness >= local_thickness(options.thickness, radius);
    };
    Halving cuts = cuts_at_ridges(burnt, [&](const RidgeCrossing& crossing) {
        return is_thick(crossing.thickness, crossing.radius) &&
               !(is_thick(crossing.end_thickness[0], crossing.end_radii[0]) &&
                 is_thick(crossing.end_thickness[1], crossing.end_radii[1]));
    });
    const auto& [complex, radii, sides, sectors, fire] = burnt;
    for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
        const std::span<const Index> at = sides.of_edge[e];
        if (cuts.is_halved[e] != 0 || at.empty() || at.size() > 2) {
            continue;
        }
        const auto& [p, q] = complex.edges[e];
        const double length = distance(complex.vertices[p], complex.vertices[q]);
        const std::array<Index, 2> corners = corners_at_ends(complex, sides, at[0]);
        const auto is_low = [&](Index corner) { return opening.depths()[burnt.sectors.of_corner[corner]] < 0.0; };
        if (length < options.thickness || !is_low(corners[0]) || !is_low(corners[1])) {
            continue;
        }
        double most = -1.0;
        for (const double part : kPartsLookedAt) {
            const double depth =
                opening.depth_at(complex.vertices[p] + part * (complex.vertices[q] - complex.vertices[p]),
                                 complex.face_sheets[sides.face_of[at[0]]]);
            if (depth >= 0.0 && depth > most && radius_on_edge(complex, radii, e, part) > 0.0) {
                most = depth;
                note_cut(burnt, e, part, cuts);
            }
        }
    }
    return cuts;
}

// What is left of a complex, and how much has gone.
CleanedComplex collapsed(const MedialComplex& given, const CleanOptions& options, const Execution& execution) {
    // Seams first, while their gaps are short: opening would widen them.
    BurntComplex burnt = options.finds_ridges ? burnt_complex(with_seams_to_borders(given, 2.0 * options.thickness),
                                                              kLateStart * options.thickness)
                                              : burnt_complex(given, kInfinity);
    Opening opening(burnt, options.thickness);
    const int rounds = options.finds_ridges ? kMostCutRounds : 0;
    for (int round = 0; round < rounds && cut(burnt, cuts_for(burnt, opening, options)); ++round) {
        opening = Opening(burnt, options.thickness);
    }
    const auto& [complex, radii, sides, sectors, fire] = burnt;
    report(execution, kCleaningStage, 0.5);
    std::vector<double> depths = opening.depths();
    snap(complex, sides, sectors, depths);
    Divided divided = Division(burnt, depths).run();
    const Sides sides_of_parts = sides_of(divided.complex);
    keep_along_seams(divided, sides_of_parts);
    divided.edge_times =
        edge_times(burnt, divided.complex, sides_of_parts, divided.radii, divided.parents, divided.is_low);
    report(execution, kCleaningStage, 0.8);
    Remainder remainder(divided.complex);
    FaceCollapse(divided, options.thickness, remainder).run();
    collapse_curves(divided, options.thickness, remainder);
    CleanedComplex result;
    run_together(
        [&] {
            result.complex = complex_of(remainder, divided.complex);
            label_sheets(result.complex);
        },
        [&] {
            for (Index f = 0; f < static_cast<Index>(divided.complex.faces.size()); ++f) {
                if (remainder.has_face[f] == 0) {
                    result.statistics.area_removed += face_area(divided.complex, f);
                }
            }
            add_losses(divided, remainder, burnt.complex.vertices.size(), result.statistics);
        });
    return result;
}

}  // namespace

CleanedComplex cleaned(const MedialComplex& complex, const CleanOptions& options, const Execution& execution) {
    require(options.thickness >= 0.0 && std::isfinite(options.thickness),
            "the thickness to clean by must be a number of at least 0");
    return in_arena(execution, [&] {
        report(execution, kCleaningStage, 0.0);
        CleanedComplex result =
            options.thickness > 0.0 ? collapsed(complex, options, execution) : CleanedComplex{complex, {}};
        CleanStatistics& statistics = result.statistics;
        statistics.thickness = options.thickness;
        statistics.sheets_before = complex.sheets;
        statistics.sheets_after = result.complex.sheets;
        run_together(
            [&] {
                statistics.curves = static_cast<Index>(find_curves(result.complex, Remainder(result.complex)).size());
            },
            [&] { statistics.topology = topology_of(result.complex); });
        report(execution, kCleaningStage, 1.0);
        return result;
    });
}

CleanedComplex clean(const MedialComplex& complex, const CleanOptions& options, const Execution& execution) {
    return in_arena(execution, [&] {
        check(complex);
        return cleaned(complex, options, execution);
    });
}

}  // namespace scaleaxis::inline v1
