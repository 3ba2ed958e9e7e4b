// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/sharp_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/remainder.hpp"
#include "base/disjoint_sets.hpp"
#include "base/grouped.hpp"
#include "base/parallel.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/fit.hpp"
#include "scaleaxis/ranges.hpp"

namespace scaleaxis {
namespace {

constexpr std::string_view kStage = "sharp edges";
constexpr double kDegree = std::numbers::pi / 180.0;

constexpr double kReach = 8.0;          // tolerances: how far the border moves at most
constexpr double kLeastLength = 3.0;    // tolerances: shorter parts of edges need corners at both ends
constexpr double kLeastSheet = 2.0;     // tolerances: what is smaller is not extended
constexpr double kBladeCosine = -0.97;  // of the normals: thinner wedges cannot be told from thin walls

// The search for an edge: points ever nearer to it.
constexpr std::array kAside{0.02, 0.1, 0.5, 1.0};  // of the radius: how far from one contact to go to find the next one
constexpr double kApproach = 0.7;                  // of the way to the edge: the rest of it after each step
constexpr double kLeastPart = 0.8;                 // of the radius expected after a step: something else is in the way
constexpr int kMaxSteps = 10;
constexpr double kSettled = 1e-3;    // of the way to the edge: the last change, at most
constexpr double kConverged = 1e-7;  // of the way to the edge: the last change
constexpr double kOnSurface = 1e-3;  // of the way: how far the solid's boundary may be from the edge

// Gaps in a row of places on an edge.
constexpr std::size_t kMostInGap = 6;
constexpr double kMostWidth = 4.0;  // tolerances
constexpr double kSag = 0.05;       // of the width: how far from the edge the middle may be

// Steps along one edge of the solid, and from one to another.
const double kSameDirection = std::cos(40.0 * kDegree);
const double kOtherDirection = std::cos(25.0 * kDegree);
constexpr double kSamePlace = 1e-3;  // tolerances
constexpr double kMaxDetour = 1.5;   // of the way between vertices with the same corner
constexpr double kMaxStretch = 3.0;  // an edge of the border, where it arrives

// A place on a sharp edge.
struct Crease {
    Point place;
    Point direction;     // of the edge; 0 in corners
    double angle = 0.0;  // between the normals, degrees
};

struct Plane {
    Point normal;
    Point point;

    double from(const Point& p) const { return dot(normal, point - p); }
};

// The tangent plane of the boundary at the point that is nearest to `p`.
Plane tangent_plane(const Point& p, const Point& nearest) { return {unit(nearest - p), nearest}; }

struct Search {
    Point start;
    Point at;
    double radius = 0.0;
    double expected = 0.0;  // the radius, from the step before
    std::array<Plane, 3> planes{};
    Crease crease;
    bool is_active = true;
    bool is_found = false;
};

// The point on both planes that is nearest to `p`.
Point on_both(const Plane& a, const Plane& b, const Point& p) {
    const double cosine = dot(a.normal, b.normal);
    const double determinant = 1.0 - cosine * cosine;
    const double da = a.from(p);
    const double db = b.from(p);
    return p + ((da - cosine * db) / determinant) * a.normal + ((db - cosine * da) / determinant) * b.normal;
}

std::optional<Point> on_all(const std::array<Plane, 3>& planes, const Point& p) {
    const auto& [a, b, c] = planes;
    const Point bc = cross(b.normal, c.normal);
    const double determinant = dot(a.normal, bc);
    constexpr double kLeastDeterminant = 0.05;
    if (std::abs(determinant) < kLeastDeterminant) {
        return std::nullopt;
    }
    return p + (1.0 / determinant) *
                   (a.from(p) * bc + b.from(p) * cross(c.normal, a.normal) + c.from(p) * cross(a.normal, b.normal));
}

// Looks for sharp edges, or for corners, near points inside a solid, for all at the same time.
class CreaseSearch {
   public:
    CreaseSearch(const Solid& solid, const SharpEdgeOptions& options, bool wants_corners)
        : solid_(solid),
          most_cosine_(std::cos(options.angle * kDegree)),
          reach_(kReach * options.tolerance),
          wants_corners_(wants_corners) {}

    std::vector<std::optional<Crease>> run(std::span<const Point> points) {
        searches_.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            searches_[i].start = points[i];
            searches_[i].at = points[i];
        }
        for (int step = 0; step < kMaxSteps; ++step) {
            stop_if_cancelled();
            find_planes();
            for_each_active([&](Search& search) { approach(search, step); });
        }
        check_places();
        std::vector<std::optional<Crease>> result(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (searches_[i].is_found) {
                result[i] = searches_[i].crease;
            }
        }
        return result;
    }

   private:
    template <class Work>
    void for_each_active(const Work& work) {
        for (Search& search : searches_) {
            if (search.is_active) {
                work(search);
            }
        }
    }

    // A question for the nearest point of the boundary.
    struct Question {
        Point point;
        double bound = std::numeric_limits<double>::infinity();
    };

    // Asks `question_of(search)` for each active search that `is_wanted`, and has `take(search, point, nearest)` take
    // the answer.
    template <class IsWanted, class QuestionOf, class Take>
    void ask(const IsWanted& is_wanted, const QuestionOf& question_of, const Take& take) {
        std::vector<Search*> asking;
        std::vector<Point> points;
        std::vector<double> bounds;
        for_each_active([&](Search& search) {
            if (is_wanted(search)) {
                const Question question = question_of(search);
                asking.push_back(&search);
                points.push_back(question.point);
                bounds.push_back(question.bound);
            }
        });
        const std::vector<std::optional<Point>> answers = nearest_of(solid_, points, bounds);
        for (std::size_t i = 0; i < asking.size(); ++i) {
            if (answers[i]) {
                take(*asking[i], points[i], *answers[i]);
            } else {
                asking[i]->is_active = false;
            }
        }
    }

    // The tangent planes of the contacts: the nearest point, and those that are nearest from a little aside.
    void find_planes() {
        ask([](const Search&) { return true; },
            [](const Search& search) {
                const bool is_first = search.expected == 0.0;
                return is_first ? Question{search.at} : question_near(search.at, search.planes[0].point);
            },
            [](Search& search, const Point& p, const Point& nearest) {
                search.planes[0] = tangent_plane(p, nearest);
                search.radius = distance(p, nearest);
                if (!(search.radius > 0.0 && search.radius >= kLeastPart * search.expected)) {
                    search.is_active = false;
                    search.is_found = false;
                }
            });
        const auto is_second = [&](const Search& search) {
            const double cosine = dot(search.planes[0].normal, search.planes[1].normal);
            return kBladeCosine < cosine && cosine < most_cosine_;
        };
        find_plane(
            1, [](const Search& search) { return search.planes[0].normal; }, is_second);
        if (wants_corners_) {
            find_plane(
                2, [](const Search& search) { return unit(search.planes[0].normal + search.planes[1].normal); },
                [&](const Search& search) {
                    const auto& [a, b, c] = search.planes;
                    return dot(c.normal, a.normal) < most_cosine_ && dot(c.normal, b.normal) < most_cosine_;
                });
        }
    }

    // Some point of the boundary is known: no farther one is wanted.
    static Question question_near(const Point& p, const Point& known) {
        constexpr double kRounding = 1e-6;
        return {p, (1.0 + kRounding) * distance(p, known)};
    }

    // The plane that is nearest from a point farther from those before. Little farther first: in thin parts the
    // opposite side is not far.
    template <class NormalOf, class IsFound>
    void find_plane(std::size_t number, const NormalOf& normal_of, const IsFound& is_found) {
        for (Search& search : searches_) {
            search.planes[number] = search.planes[0];
        }
        for (const double part : kAside) {
            ask([&](const Search& search) { return !is_found(search); },
                [&](const Search& search) {
                    return question_near(search.at - (part * search.radius) * normal_of(search),
                                         search.planes[0].point);
                },
                [&](Search& search, const Point& p, const Point& nearest) {
                    search.planes[number] = tangent_plane(p, nearest);
                });
        }
        for_each_active([&](Search& search) { search.is_active = is_found(search); });
    }

    void approach(Search& search, int step) const {
        const auto& [a, b, c] = search.planes;
        std::optional<Point> place = on_both(a, b, search.at);
        if (wants_corners_) {
            place = on_all(search.planes, search.at);
        }
        if (!place || !(distance(*place, search.start) <= reach_)) {
            search.is_active = false;
            search.is_found = false;
            return;
        }
        const double way = distance(*place, search.start);
        const double change = step == 0 ? way : distance(*place, search.crease.place);
        search.crease = {*place, wants_corners_ ? Point() : unit(cross(a.normal, b.normal)),
                         std::acos(std::clamp(dot(a.normal, b.normal), -1.0, 1.0)) / kDegree};
        search.at = *place + kApproach * (search.at - *place);
        search.expected = kApproach * search.radius;
        search.is_found = change <= kSettled * way;
        search.is_active = change > kConverged * way;
    }

    // On a convex edge the solid ends: it is entered a little before, and left a little behind.
    void check_places() {
        std::vector<Search*> found;
        std::vector<Point> points;
        for (Search& search : searches_) {
            if (search.is_found) {
                const Point& place = search.crease.place;
                const Point little = kOnSurface * (place - search.start);
                found.push_back(&search);
                append(points, {place - little, place + little});
            }
        }
        const std::vector<std::uint8_t> sides = sides_of(solid_, points);
        for (std::size_t i = 0; i < found.size(); ++i) {
            found[i]->is_found = sides[2 * i] != 0 && sides[2 * i + 1] == 0;
        }
    }

    const Solid& solid_;
    double most_cosine_;
    double reach_;
    bool wants_corners_;
    std::vector<Search> searches_;
};

// Which sheets are too small to be extended: crumbs, which the filter leaves beside the ends of seams.
std::vector<std::uint8_t> small_sheets(const MedialComplex& complex, double size) {
    std::vector<Box> boxes(complex.sheets);
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index v : complex.faces[f]) {
            boxes[complex.face_sheets[f]].extend(complex.vertices[v]);
        }
    }
    std::vector<std::uint8_t> result(boxes.size());
    std::ranges::transform(boxes, result.begin(), [&](const Box& box) { return box.diagonal() < size ? 1 : 0; });
    return result;
}

// Collapses the faces of some sheets, from some free edges on, and then the edges that they leave behind.
void collapse_sheets(const MedialComplex& complex, const std::vector<std::uint8_t>& is_chosen, std::vector<Index> edges,
                     Remainder& remainder) {
    const std::vector<Cofaces> faces_before = remainder.faces_at_edge;
    while (!edges.empty()) {
        const Index edge = edges.back();
        edges.pop_back();
        if (remainder.has_edge[edge] == 0) {
            continue;
        }
        const auto& [p, q] = complex.edges[edge];
        if (const Index face = remainder.only_face(edge); face != kNone && is_chosen[complex.face_sheets[face]] != 0) {
            remainder.remove_face(complex, face);
            edges.insert(edges.end(), complex.face_edges[face].begin(), complex.face_edges[face].end());
        } else if (remainder.faces_at_edge[edge].count == 0 && faces_before[edge].count > 0 &&
                   (remainder.edges_at_vertex[p].count == 1 || remainder.edges_at_vertex[q].count == 1)) {
            remainder.has_vertex[remainder.edges_at_vertex[p].count == 1 ? p : q] = 0;
        } else {
            continue;
        }
        remainder.remove_edge(complex, edge);
        for (const Index v : {p, q}) {
            if (remainder.edges_at_vertex[v].count == 1) {
                edges.push_back(remainder.edges_at_vertex[v].combined);
            }
        }
    }
}

// Crumbs are small sheets beside large ones. Where all are small, the solid is.
std::vector<std::uint8_t> find_crumbs(const MedialComplex& complex, double size) {
    const std::vector<std::uint8_t> is_small = small_sheets(complex, size);
    std::vector<std::uint8_t> is_in_large(complex.vertices.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index v : complex.faces[f]) {
            if (is_small[complex.face_sheets[f]] == 0) {
                is_in_large[v] = 1;
            }
        }
    }
    std::vector<std::uint8_t> result(is_small.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const Index sheet = complex.face_sheets[f];
        if (is_small[sheet] != 0 &&
            std::ranges::any_of(complex.faces[f], [&](Index v) { return is_in_large[v] != 0; })) {
            result[sheet] = 1;
        }
    }
    return result;
}

// Collapses crumbs in the wedge of a sharp edge, where larger sheets are to go on. All vertices of their border see
// one.
MedialComplex without_crumbs(MedialComplex complex, const Solid& solid, const SharpEdgeOptions& options) {
    std::vector<std::uint8_t> is_crumb = find_crumbs(complex, kLeastSheet * options.tolerance);
    Remainder remainder(complex);
    std::vector<Index> edges;
    std::vector<Point> points;
    for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
        const Index face = remainder.only_face(e);
        if (face != kNone && is_crumb[complex.face_sheets[face]] != 0) {
            edges.push_back(e);
            append(points, {complex.vertices[complex.edges[e][0]], complex.vertices[complex.edges[e][1]]});
        }
    }
    if (edges.empty()) {
        return complex;
    }
    const std::vector<std::optional<Crease>> creases = CreaseSearch(solid, options, false).run(points);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (!creases[2 * i] || !creases[2 * i + 1]) {
            is_crumb[complex.face_sheets[remainder.only_face(edges[i])]] = 0;
        }
    }
    collapse_sheets(complex, is_crumb, std::move(edges), remainder);
    MedialComplex result = complex_of(remainder, complex);
    label_sheets(result);
    return result;
}

// What the border of a complex looks like around a vertex.
struct BorderVertex {
    Index vertex = kNone;
    Index face = kNone;                            // one at the vertex
    std::array<Index, 2> neighbors{kNone, kNone};  // positions among the border's vertices
    Index border_edges = 0;
    bool is_at_seam = false;
    std::optional<Crease> crease;
    std::optional<Crease> corner;

    bool is_plain() const { return border_edges == 2 && !is_at_seam; }
};

struct Border {
    std::vector<BorderVertex> vertices;
    std::vector<std::array<Index, 2>> edges;  // of positions among `vertices`
    std::vector<Index> positions;             // of each vertex of the complex, `kNone` inside
};

Border border_of(const MedialComplex& complex, double least_sheet) {
    const std::vector<std::uint8_t> is_small = small_sheets(complex, least_sheet);
    std::vector<Index> faces_at(complex.edges.size());
    std::vector<Index> face_of(complex.edges.size());
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        for (const Index e : complex.face_edges[f]) {
            face_of[e] = f;
        }
    }
    for (const Index e : complex.face_edges.items) {
        ++faces_at[e];
    }
    Border border;
    border.positions.assign(complex.vertices.size(), kNone);
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (faces_at[e] != 1 || is_small[complex.face_sheets[face_of[e]]] != 0) {
            continue;
        }
        std::array<Index, 2> ends{};
        for (int k = 0; k < 2; ++k) {
            Index& position = border.positions[complex.edges[e][k]];
            if (position == kNone) {
                position = static_cast<Index>(border.vertices.size());
                border.vertices.emplace_back().vertex = complex.edges[e][k];
            }
            ends[k] = position;
        }
        border.edges.push_back(ends);
        for (int k = 0; k < 2; ++k) {
            BorderVertex& at = border.vertices[ends[k]];
            if (at.border_edges < 2) {
                at.neighbors[at.border_edges] = ends[1 - k];
            }
            ++at.border_edges;
        }
    }
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        for (const Index v : complex.faces[f]) {
            if (border.positions[v] != kNone) {
                border.vertices[border.positions[v]].face = f;
            }
        }
    }
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        for (const Index v : complex.edges[e]) {
            if (faces_at[e] > 2 && border.positions[v] != kNone) {
                border.vertices[border.positions[v]].is_at_seam = true;
            }
        }
    }
    return border;
}

// Finds the edges for plain vertices of the border, and corners where seams end or one edge follows on another.
void find_creases(const MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options, Border& border) {
    const auto search = [&](bool wants_corners, const auto& is_wanted, auto result) {
        std::vector<Index> chosen;
        std::vector<Point> points;
        for (Index i = 0; i < static_cast<Index>(border.vertices.size()); ++i) {
            if (is_wanted(border.vertices[i])) {
                chosen.push_back(i);
                points.push_back(complex.vertices[border.vertices[i].vertex]);
            }
        }
        std::vector<std::optional<Crease>> found = CreaseSearch(solid, options, wants_corners).run(points);
        for (std::size_t k = 0; k < chosen.size(); ++k) {
            border.vertices[chosen[k]].*result = found[k];
        }
    };
    search(
        false, [](const BorderVertex& at) { return at.is_plain(); }, &BorderVertex::crease);
    search(
        true,
        [&](const BorderVertex& at) {
            if (!at.is_plain()) {
                return true;
            }
            return at.crease && std::ranges::any_of(at.neighbors, [&](Index neighbor) {
                       const std::optional<Crease>& other = border.vertices[neighbor].crease;
                       return other && std::abs(dot(at.crease->direction, other->direction)) < kOtherDirection;
                   });
        },
        &BorderVertex::corner);
}

// A few vertices of the border that see no edge, between two that see the same one.
struct BorderGap {
    std::vector<Index> inside;
    Index before;
    Index after;
};

std::vector<BorderGap> gaps_of(const Border& border, double most_width) {
    const auto is_open = [&](Index i) {
        const BorderVertex& at = border.vertices[i];
        return at.is_plain() && !at.crease && !at.corner;
    };
    std::vector<BorderGap> gaps;
    for (Index i = 0; i < static_cast<Index>(border.vertices.size()); ++i) {
        for (const Index first : border.vertices[i].neighbors) {
            if (!border.vertices[i].crease || first == kNone || !is_open(first)) {
                continue;
            }
            BorderGap gap{{}, i, first};
            for (Index last = i; is_open(gap.after) && gap.inside.size() <= kMostInGap;) {
                gap.inside.push_back(gap.after);
                const auto& [p, q] = border.vertices[gap.after].neighbors;
                gap.after = std::exchange(last, gap.after) == p ? q : p;
            }
            const std::optional<Crease>& before = border.vertices[i].crease;
            const std::optional<Crease>& after = border.vertices[gap.after].crease;
            if (!after || gap.after <= i || gap.inside.size() > kMostInGap) {
                continue;
            }
            const Point way = after->place - before->place;
            if (norm(way) <= most_width && std::abs(dot(way, before->direction)) >= kSameDirection * norm(way) &&
                std::abs(dot(way, after->direction)) >= kSameDirection * norm(way)) {
                gaps.push_back(std::move(gap));
            }
        }
    }
    return gaps;
}

// Has gaps go to the places beside them, if the edge goes on there.
void close_gaps(const Solid& solid, double most_width, Border& border) {
    const std::vector<BorderGap> gaps = gaps_of(border, most_width);
    using Answers = std::vector<std::optional<Point>>;
    const auto answers =
        collect_batches<Answers>(solid, gaps.size(), [&](std::size_t begin, std::size_t end, Answers& nearest) {
            std::vector<Point> points;
            std::vector<double> bounds;
            for (std::size_t i = begin; i < end; ++i) {
                const Point& a = border.vertices[gaps[i].before].crease->place;
                const Point& b = border.vertices[gaps[i].after].crease->place;
                points.push_back(midpoint(a, b));
                bounds.push_back(kSag * distance(a, b));
            }
            nearest.resize(points.size());
            solid.nearest(points, bounds, nearest);
        });
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        const std::vector<Index>& inside = gaps[i].inside;
        for (std::size_t k = 0; answers[i] && k < inside.size(); ++k) {
            const Index beside = 2 * k < inside.size() ? gaps[i].before : gaps[i].after;
            border.vertices[inside[k]].crease = border.vertices[beside].crease;
        }
    }
}

// Vertices that go to the same corner: trees of edges of the complex, so that cones on them change nothing about the
// homotopy type.
struct Corners {
    DisjointSets sets;          // of vertices of the complex
    std::vector<Index> of_set;  // at its representative, a vertex of the border in it that knows the corner
    std::vector<std::array<Index, 2>> tree_edges;  // of vertices of the complex
};

// Joins vertices of the border with the same corner: those beside each other, and then others along the shortest way
// across the complex, which takes the place of a seam where the filter, or the gaps between balls, have made two sheets
// of three.
class CornerSearch {
   public:
    CornerSearch(const MedialComplex& complex, const Border& border, double same_place)
        : complex_(complex), border_(border), same_place_(same_place) {}

    Corners run() && {
        result_.sets = DisjointSets(complex_.vertices.size());
        for (const auto& [a, b] : border_.edges) {
            join_beside(border_.vertices[a].vertex, border_.vertices[b].vertex);
        }
        for (const auto& [p, q] : complex_.edges) {
            join_beside(p, q);
        }
        std::vector<Index> known;
        for (const BorderVertex& at : border_.vertices) {
            if (at.corner) {
                known.push_back(at.vertex);
            }
        }
        std::ranges::stable_sort(known, {}, [&](Index v) { return corner_of(v)->place.x; });
        for (std::size_t i = 0; i < known.size(); ++i) {
            for (std::size_t k = i + 1; k < known.size() && are_close_in_x(known[i], known[k]); ++k) {
                if (have_same_corner(known[i], known[k]) &&
                    result_.sets.find(known[i]) != result_.sets.find(known[k])) {
                    join_by_way(known[i], known[k]);
                }
            }
        }
        result_.of_set.assign(complex_.vertices.size(), kNone);
        for (Index i = 0; i < static_cast<Index>(border_.vertices.size()); ++i) {
            if (border_.vertices[i].corner) {
                Index& of_set = result_.of_set[result_.sets.find(border_.vertices[i].vertex)];
                of_set = of_set == kNone ? i : of_set;
            }
        }
        return std::move(result_);
    }

   private:
    const std::optional<Crease>& corner_of(Index v) const {
        static const std::optional<Crease> kNothing;
        const Index position = border_.positions[v];
        return position == kNone ? kNothing : border_.vertices[position].corner;
    }

    bool are_close_in_x(Index p, Index q) const {
        return std::abs(corner_of(p)->place.x - corner_of(q)->place.x) <= same_place_;
    }

    bool have_same_corner(Index p, Index q) const {
        const std::optional<Crease>& a = corner_of(p);
        const std::optional<Crease>& b = corner_of(q);
        return a && b && distance(a->place, b->place) <= same_place_;
    }

    void join_beside(Index p, Index q) {
        if (have_same_corner(p, q) && result_.sets.join(p, q)) {
            result_.tree_edges.push_back({p, q});
        }
    }

    // May a way to the corner of `from` go through `v`? Not where it would meet another corner's.
    bool is_free(Index from, Index v) {
        return (!corner_of(v) || have_same_corner(from, v)) &&
               (is_on_way_.empty() || is_on_way_[v] == 0 || result_.sets.find(v) == result_.sets.find(from));
    }

    void join_by_way(Index from, Index to) {
        if (neighbors_.empty()) {
            neighbors_ = grouped_both_ways(complex_.vertices.size(), complex_.edges);
        }
        const double most = kMaxDetour * distance(complex_.vertices[from], complex_.vertices[to]);
        std::unordered_map<Index, std::pair<double, Index>> reached{{from, {0.0, kNone}}};  // length, vertex before
        using Entry = std::pair<double, Index>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
        front.emplace(0.0, from);
        while (!front.empty() && front.top().second != to) {
            const auto [length, v] = front.top();
            front.pop();
            if (length > reached.at(v).first) {
                continue;
            }
            for (const Index next : neighbors_[v]) {
                const double longer = length + distance(complex_.vertices[v], complex_.vertices[next]);
                if (longer > most || !(next == to || is_free(from, next))) {
                    continue;
                }
                const auto [known, is_new] = reached.try_emplace(next, longer, v);
                if (is_new || longer < known->second.first) {
                    known->second = {longer, v};
                    front.emplace(longer, next);
                }
            }
        }
        if (front.empty()) {
            return;
        }
        is_on_way_.resize(complex_.vertices.size());
        for (Index v = to; v != from;) {
            is_on_way_[v] = 1;
            const Index before = reached.at(v).second;
            if (result_.sets.join(v, before)) {
                result_.tree_edges.push_back({v, before});
            }
            v = before;
        }
    }

    const MedialComplex& complex_;
    const Border& border_;
    double same_place_;
    IndexLists neighbors_;
    std::vector<std::uint8_t> is_on_way_;  // of each vertex, once there is a way
    Corners result_{DisjointSets(0), {}, {}};
};

// A part of the border along one sharp edge: vertices of the border one after the other, and where each is on the edge.
struct Chain {
    std::vector<Index> at;
    std::vector<double> positions;  // along the edge, ascending
    bool is_closed = false;
};

class Chains {
   public:
    Chains(const MedialComplex& complex, const Border& border, Corners& corners, double tolerance)
        : complex_(complex), border_(border), corners_(corners), tolerance_(tolerance) {}

    std::vector<Chain> run() {
        std::vector<std::array<Index, 2>> links;
        for (const auto& [a, b] : border_.edges) {
            if (goes_along(a, b)) {
                links.push_back({a, b});
            }
        }
        links_ = grouped(border_.vertices.size(), [&](const auto& add) {
            for (Index link = 0; link < static_cast<Index>(links.size()); ++link) {
                add(links[link][0], link);
                add(links[link][1], link);
            }
        });
        is_used_.assign(links.size(), 0);
        for (const bool wants_closed : {false, true}) {
            for (Index i = 0; i < static_cast<Index>(border_.vertices.size()); ++i) {
                for (const Index link : links_[i]) {
                    if (is_used_[link] == 0 && (wants_closed || is_end(i))) {
                        follow(i, link, links);
                    }
                }
            }
        }
        return std::move(result_);
    }

   private:
    const BorderVertex& vertex(Index i) const { return border_.vertices[i]; }
    const Crease& crease(Index i) const { return vertex(i).corner ? *vertex(i).corner : *vertex(i).crease; }
    const Point& place(Index i) const { return crease(i).place; }
    bool is_end(Index i) const { return vertex(i).corner || links_[i].size() != 2; }

    // Do an edge of the border and the line between the places of its ends lead the same way?
    bool goes_along(Index a, Index b) {
        if (!(vertex(a).corner || vertex(a).crease) || !(vertex(b).corner || vertex(b).crease)) {
            return false;
        }
        if (vertex(a).corner && vertex(b).corner) {
            return corners_.sets.find(vertex(a).vertex) != corners_.sets.find(vertex(b).vertex);
        }
        const Point way = place(b) - place(a);
        const double length = norm(way);
        const double length_before = distance(complex_.vertices[vertex(a).vertex], complex_.vertices[vertex(b).vertex]);
        const bool is_to_corner = vertex(a).corner || vertex(b).corner;
        if (length > kMaxStretch * length_before + (is_to_corner ? kReach : 0.5) * tolerance_) {
            return false;
        }
        const auto agrees = [&](Index i) {
            return vertex(i).corner || length <= kSamePlace * tolerance_ ||
                   std::abs(dot(way, crease(i).direction)) >= kSameDirection * length;
        };
        return agrees(a) && agrees(b);
    }

    void follow(Index start, Index link, const std::vector<std::array<Index, 2>>& links) {
        Chain chain;
        chain.at.push_back(start);
        Index here = start;
        while (link != kNone) {
            is_used_[link] = 1;
            here = links[link][0] == here ? links[link][1] : links[link][0];
            chain.at.push_back(here);
            link = kNone;
            if (!is_end(here)) {
                for (const Index next : links_[here]) {
                    if (is_used_[next] == 0) {
                        link = next;
                    }
                }
            }
        }
        if (here == start && !vertex(start).corner) {
            chain.is_closed = true;
            chain.at.pop_back();
        }
        measure(chain);
        result_.push_back(std::move(chain));
    }

    // Positions along the edge, whose direction is that of the step before.
    void measure(Chain& chain) const {
        Point direction{};
        double position = 0.0;
        chain.positions.push_back(position);
        for (std::size_t k = 1; k < chain.at.size(); ++k) {
            const Point way = place(chain.at[k]) - place(chain.at[k - 1]);
            const Index known = vertex(chain.at[k]).corner ? chain.at[k - 1] : chain.at[k];
            Point along = vertex(known).corner ? unit(way) : crease(known).direction;
            if (dot(along, direction == Point{} ? way : direction) < 0.0) {
                along = -1.0 * along;
            }
            direction = along;
            position += dot(way, along);
            chain.positions.push_back(position);
        }
        if (position < 0.0) {
            for (double& p : chain.positions) {
                p = -p;
            }
        }
    }

    const MedialComplex& complex_;
    const Border& border_;
    Corners& corners_;
    double tolerance_;
    IndexLists links_;
    std::vector<std::uint8_t> is_used_;
    std::vector<Chain> result_;
};

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
        complex = without_crumbs(std::move(complex), solid, options);
        Border border = border_of(complex, kLeastSheet * options.tolerance);
        find_creases(complex, solid, options, border);
        close_gaps(solid, kMostWidth * options.tolerance, border);
        report(execution, kStage, 0.8);
        Corners corners = CornerSearch(complex, border, kSamePlace * options.tolerance).run();
        const std::vector<Chain> chains = Chains(complex, border, corners, options.tolerance).run();
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
