// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/centering.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/halving.hpp"
#include "axis/stages/stages.hpp"
#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/fit.hpp"
#include "spatial/slab.hpp"
#include "spatial/spatial_order.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kCenteringStage = "centering";

constexpr std::size_t kMostDirections = 12;

// A curve is seen from a circle around it.
constexpr int kDirectionsOfCurve = 8;

// How far from a contact the solid is asked for its tangent plane there, as a part of the radius.
constexpr double kDepth = 0.2;

// Steps of a move.
constexpr int kSteps = 3;

// Balls that are farther from touching the solid do not touch it, in tolerances. Those of a union that stick out by
// more are to do so: their perturbation, and rounding, are less. Edges are halved where balls in between are: half of
// it takes four times as many new vertices and brings the envelope nearer to the solid by a hundredth, twice of it is
// as much as the balls themselves are allowed. How often.
constexpr double kFaceError = 0.1;
constexpr int kMostCenteringRounds = 4;

// Progress is reported this often.
constexpr std::size_t kBlocksOfProgress = 16;

// Keeps a move from following directions in which the planes hardly differ. In units of squared sines.
constexpr double kDamping = 0.01;

struct ContactPlane {
    Point normal;
    double distance = 0.0;  // from the centre of a ball
};

// A vertex that takes part.
struct Centering {
    Index vertex = kNone;
    double radius = 0.0;               // of the largest ball in the solid around it
    Point center;                      // where it has moved so far
    std::vector<Point> directions;     // in which the solid is asked for contacts from there
    std::vector<Point> places;         // of the boundary, as far as known: first the one nearest to the vertex
    bool is_foot = false;              // of a strip
    double misfit = 0.0;               // at first, of a foot
    std::vector<ContactPlane> planes;  // of the contacts, as seen from where it is
    bool is_moving = true;

    // How far the ball of this radius is from touching the planes.
    double misfit_of(double ball_radius) const {
        double most = 0.0;
        for (const ContactPlane& plane : planes) {
            most = std::max(most, std::abs(plane.distance - ball_radius));
        }
        return most;
    }

    const Point& nearest_place(const Point& p) const {
        return *std::ranges::min_element(places, {}, [&](const Point& place) { return squared_distance(p, place); });
    }

    // No ball around `p` has a larger radius.
    double reach(const Point& p) const { return distance(p, nearest_place(p)); }
};

void add_direction(std::vector<Point>& directions, const Point& direction) {
    const auto is_same = [&](const Point& other) { return dot(direction, other) > kSamePlaneDirection; };
    if (squared_norm(direction) > 0.0 && directions.size() < kMostDirections &&
        std::ranges::none_of(directions, is_same)) {
        directions.push_back(direction);
    }
}

void add_circle(std::vector<Point>& directions, const Point& tangent) {
    const Point u = any_normal_to(tangent);
    const Point v = cross(tangent, u);
    for (int i = 0; i < kDirectionsOfCurve; ++i) {
        const auto [cosine, sine] = on_circle(static_cast<double>(i) / kDirectionsOfCurve);
        add_direction(directions, cosine * u + sine * v);
    }
}

// A triangle between the axis and a sharp edge.
bool is_strip(const MedialComplex& complex, Index f) {
    const std::span<const Index> corners = complex.faces[f];
    return corners.size() == 3 && std::ranges::any_of(corners, [&](Index v) { return is_on_sharp_edge(complex, v); });
}

// Where the contacts of the balls are, as seen from the vertices.
class ContactDirections {
   public:
    explicit ContactDirections(const MedialComplex& complex)
        : complex_(complex),
          faces_(faces_at_vertices(complex)),
          neighbors_(grouped_both_ways(complex.vertices.size(), curve_edges(complex))) {}

    bool is_foot(Index v) const {
        return std::ranges::any_of(faces_[v], [&](Index f) { return is_strip(complex_, f); });
    }

    // Those that differ from one that is known.
    std::vector<Point> at(Index v, const Point& known) const {
        std::vector<Point> result{known};
        const Point& p = complex_.vertices[v];
        for (const Index f : faces_[v]) {
            if (complex_.has_contacts()) {
                for (const Index contact : complex_.face_contacts[f]) {
                    add_direction(result, unit(complex_.boundary_vertices[contact] - p));
                }
            }
            if (!complex_.has_contacts() || is_strip(complex_, f)) {
                for (const Point& direction : directions_of_slab(f)) {
                    add_direction(result, direction);
                }
            }
        }
        const std::span<const Index> along = neighbors_[v];
        if (faces_[v].empty() && along.size() == 2) {
            add_circle(result, unit(complex_.vertices[along[1]] - complex_.vertices[along[0]]));
        }
        result.erase(result.begin());
        return result;
    }

   private:
    // All corners of a triangle see the planes that its slab touches in the same directions. (A strip's contacts are
    // those of one of its balls.)
    std::array<Point, 2> directions_of_slab(Index f) const {
        const std::span<const Index> corners = complex_.faces[f];
        const std::array balls{ball_at(complex_, corners[0]), ball_at(complex_, corners[1]),
                               ball_at(complex_, corners[2])};
        return contact_directions(Slab(balls)).value_or(std::array<Point, 2>{});
    }

    const MedialComplex& complex_;
    IndexLists faces_;
    IndexLists neighbors_;  // along curves
};

// The move to the ball that touches all planes, or comes closest to it (least squares).
Point move_to_middle(std::span<const ContactPlane> planes) {
    const double part = 1.0 / static_cast<double>(planes.size());
    Eigen::Vector4d mean = Eigen::Vector4d::Zero();
    for (const auto& [n, d] : planes) {
        mean += part * Eigen::Vector4d(n.x, n.y, n.z, d);
    }
    Eigen::Matrix3d a = kDamping * Eigen::Matrix3d::Identity();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const auto& [n, d] : planes) {
        const Eigen::Vector3d normal = Eigen::Vector3d(n.x, n.y, n.z) - mean.head<3>();
        a += part * normal * normal.transpose();
        b += part * (d - mean[3]) * normal;
    }
    const Eigen::Vector3d move = a.ldlt().solve(b);
    return {move.x(), move.y(), move.z()};
}

// A vertex in the solid, and the point of the boundary nearest to it.
struct FirstContact {
    Index vertex = kNone;
    Point place;
};

// Which of these vertices lie in the solid. Where one end of an edge is nearby the other, beside its distance from the
// boundary, both lie on the same side: one vertex is asked for in place of all that are joined by such edges. Not all
// of that distance is taken, since solids that find the nearest point by a local search may miss a nearer one.
std::vector<FirstContact> in_solid(const MedialComplex& complex, const std::vector<FirstContact>& contacts,
                                   const Solid& solid) {
    std::vector<double> reaches(complex.vertices.size());
    for (const auto& [v, place] : contacts) {
        reaches[v] = kNearby * distance(complex.vertices[v], place);
    }
    DisjointSets sets(complex.vertices.size());
    for (const auto& [a, b] : complex.edges) {
        if (reaches[a] > 0.0 && reaches[b] > 0.0 &&
            distance(complex.vertices[a], complex.vertices[b]) < std::max(reaches[a], reaches[b])) {
            sets.join(a, b);
        }
    }
    std::vector<Index> first(complex.vertices.size(), kNone);  // number of the point asked for a set
    std::vector<Point> points;
    for (const FirstContact& contact : contacts) {
        Index& number = first[sets.find(contact.vertex)];
        if (number == kNone) {
            number = static_cast<Index>(points.size());
            points.push_back(complex.vertices[contact.vertex]);
        }
    }
    const std::vector<std::uint8_t> sides = sides_of(solid, points);
    std::vector<FirstContact> result;
    std::ranges::copy_if(contacts, std::back_inserter(result),
                         [&](const FirstContact& contact) { return sides[first[sets.find(contact.vertex)]] != 0; });
    return result;
}

// Those vertices whose balls are not much smaller than the largest around their centres.
std::vector<FirstContact> first_contacts(const MedialComplex& complex, std::span<const Index> vertices,
                                         const Solid& solid, double tolerance) {
    std::vector<Point> centers;
    std::vector<double> bounds;
    for (const Index v : vertices) {
        centers.push_back(complex.vertices[v]);
        bounds.push_back((1.0 + kRelativeRounding) * (complex.radii[v] + tolerance));
    }
    const std::vector<std::optional<Point>> nearest = nearest_of(solid, centers, bounds);
    std::vector<FirstContact> contacts;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (nearest[i]) {
            const double growth = distance(centers[i], *nearest[i]) - complex.radii[vertices[i]];
            if (growth >= -kFaceError * tolerance && growth <= tolerance) {
                contacts.push_back({vertices[i], *nearest[i]});
            }
        }
    }
    return in_solid(complex, contacts, solid);
}

// Balls that touch the solid.
struct Touching {
    std::vector<Index> vertices;
    std::vector<Ball> balls;     // of these vertices
    std::int64_t questions = 0;  // asked
};

Touching join(std::vector<Touching>& parts) {
    Touching all;
    for (const Touching& part : parts) {
        all.questions += part.questions;
    }
    all.vertices = joined(parts, &Touching::vertices);
    all.balls = joined(parts, &Touching::balls);
    return all;
}

// A few vertices, each of which goes its own way; the solid is asked for all of them at once.
class CenteringBatch {
   public:
    CenteringBatch(const MedialComplex& complex, const ContactDirections& directions, const Solid& solid,
                   double tolerance, Feet feet)
        : complex_(complex), directions_(directions), solid_(solid), tolerance_(tolerance), feet_(feet) {}

    Touching run(std::span<const FirstContact> contacts) && {
        start(contacts);
        for (int step = 0; step < kSteps; ++step) {
            move(step == 0);
        }
        return better_balls();
    }

   private:
    void start(std::span<const FirstContact> contacts) {
        for (const auto& [v, place] : contacts) {
            Centering& vertex = vertices_.emplace_back();
            vertex.vertex = v;
            vertex.center = complex_.vertices[v];
            vertex.radius = distance(vertex.center, place);
            vertex.directions = directions_.at(v, unit(place - vertex.center));
            vertex.places = {place};
            vertex.is_foot = feet_ == Feet::kComeToSeams && directions_.is_foot(v);
        }
    }

    std::vector<std::optional<Point>> asked(std::span<const Point> points, std::span<const double> bounds) {
        questions_ += std::ssize(points);
        std::vector<std::optional<Point>> nearest(points.size());
        solid_.nearest(points, bounds, nearest);
        return nearest;
    }

    // A place of the boundary near a contact that is expected in a direction.
    struct Contact {
        std::size_t vertex;  // its number
        Point direction;
        Point from{};  // where it was asked for
        std::optional<Point> place{};

        Point normal() const { return unit(*place - from); }
        bool is_on_plane(const Point& center) const {
            return dot(normal(), unit(*place - center)) > kSamePlaneDirection;
        }
    };

    void move(bool is_first) {
        std::vector<Contact> contacts;
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            for (const Point& direction : directions_of(vertices_[i])) {
                contacts.push_back({i, direction});
            }
        }
        find(contacts, [](const Contact& contact) { return std::optional(contact.direction); });
        // A face beside a re-entrant edge may not go on to where its plane is nearest: what is there in its place?
        find(contacts, [&](const Contact& contact) {
            return contact.place && !contact.is_on_plane(vertices_[contact.vertex].center)
                       ? std::optional(contact.normal())
                       : std::nullopt;
        });
        auto next = contacts.begin();
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            Centering& vertex = vertices_[i];
            if (!vertex.is_moving) {
                continue;
            }
            vertex.planes.clear();
            if (is_first) {
                vertex.planes.push_back({unit(vertex.places.front() - vertex.center), vertex.radius});
            }
            for (; next != contacts.end() && next->vertex == i; ++next) {
                add_plane(*next, vertex);
            }
            if (is_first && vertex.is_foot) {
                vertex.misfit = vertex.misfit_of(vertex.radius);
            }
            go(vertex);
        }
    }

    // Asks for places in the directions that are given for contacts.
    template <class DirectionOf>
    void find(std::vector<Contact>& contacts, const DirectionOf& direction_of) {
        std::vector<std::size_t> numbers;
        std::vector<Point> points;
        std::vector<double> bounds;
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            if (const std::optional<Point> direction = direction_of(contacts[i])) {
                const Centering& vertex = vertices_[contacts[i].vertex];
                const Point p = vertex.center + (1.0 - kDepth) * vertex.radius * *direction;
                numbers.push_back(i);
                points.push_back(p);
                bounds.push_back(std::min(kDepth * vertex.radius + 2.0 * tolerance_, bound(vertex, p)));
            }
        }
        const auto nearest = asked(points, bounds);
        for (std::size_t n = 0; n < numbers.size(); ++n) {
            Contact& contact = contacts[numbers[n]];
            contact.from = points[n];
            contact.place = nearest[n];
            if (nearest[n]) {
                vertices_[contact.vertex].places.push_back(*nearest[n]);
            }
        }
    }

    // The tangent plane in a contact; of a re-entrant edge, on which a ball touches no face, that across the way to it.
    void add_plane(const Contact& contact, Centering& vertex) const {
        if (!contact.place) {
            return;
        }
        const Point way = *contact.place - vertex.center;
        const Point normal = contact.is_on_plane(vertex.center) ? contact.normal() : unit(way);
        const double height = dot(normal, way);
        if (dot(normal, contact.direction) > 0.0 && std::abs(height - vertex.radius) <= tolerance_) {
            vertex.planes.push_back({normal, height});
        }
    }

    // Of the distance of a point from the boundary.
    double bound(const Centering& vertex, const Point& p) const {
        return (1.0 + kRelativeRounding) * vertex.reach(p) + kRelativeRounding * tolerance_;
    }

    static std::span<const Point> directions_of(const Centering& vertex) {
        return vertex.is_moving ? vertex.directions : std::span<const Point>();
    }

    void go(Centering& vertex) const {
        vertex.is_moving = false;
        if (stays(vertex)) {
            return;
        }
        vertex.directions.clear();
        for (const ContactPlane& plane : vertex.planes) {
            add_direction(vertex.directions, plane.normal);
        }
        if (vertex.directions.size() < 2) {
            return;
        }
        const Point way = move_to_middle(vertex.planes);
        const Point& start = complex_.vertices[vertex.vertex];
        // In the ball it starts from it stays in the solid.
        if (!(distance(vertex.center + way, start) < std::min(tolerance_, vertex.radius))) {
            return;
        }
        vertex.center = vertex.center + way;
        for (auto& [normal, height] : vertex.planes) {
            height -= dot(normal, way);
        }
        if (!stays(vertex)) {
            vertex.is_moving = add_nearer_contact(vertex) || norm(way) > kSmallLength * tolerance_;
        }
    }

    // Where something of the boundary lies before all of these planes, it is a contact, too: where sheets meet, those
    // of the faces at a vertex need not tell of it.
    static bool add_nearer_contact(Centering& vertex) {
        const std::size_t known = vertex.directions.size();
        const Point way = vertex.nearest_place(vertex.center) - vertex.center;
        if (std::ranges::all_of(vertex.planes, [&](const ContactPlane& plane) { return norm(way) < plane.distance; })) {
            add_direction(vertex.directions, unit(way));
        }
        return vertex.directions.size() > known;
    }

    // Where the ball has become smaller on the way, the vertex goes back: it will not grow again, unless by little, in
    // a junction of several sheets.
    bool stays(Centering& vertex) const {
        const double slack = vertex.is_foot ? tolerance_ : kNegligible * tolerance_;
        const bool is_smaller = !(vertex.reach(vertex.center) > vertex.radius - slack);
        if (is_smaller) {
            vertex.center = complex_.vertices[vertex.vertex];
        }
        return is_smaller;
    }

    // The better of the balls before and after the move: the larger one, or that which the planes fit.
    Touching better_balls() {
        Touching result;
        std::vector<std::size_t> moved;  // numbers of vertices
        std::vector<Point> centers;
        std::vector<double> bounds;
        for (const Centering& vertex : vertices_) {
            const Point& start = complex_.vertices[vertex.vertex];
            if (vertex.center != start) {
                moved.push_back(result.balls.size());
                centers.push_back(vertex.center);
                bounds.push_back(bound(vertex, vertex.center));
            }
            result.vertices.push_back(vertex.vertex);
            result.balls.push_back({start, vertex.radius});
        }
        const auto nearest = asked(centers, bounds);
        for (std::size_t i = 0; i < moved.size(); ++i) {
            Ball& ball = result.balls[moved[i]];
            const double radius = nearest[i] ? distance(centers[i], *nearest[i]) : 0.0;
            if (radius > ball.radius || fits_better(vertices_[moved[i]], radius)) {
                ball = {centers[i], radius};
            }
        }
        result.questions = questions_;
        return result;
    }

    // A foot of a strip comes to the seam, where the sheet that it was found on ends: often balls are smaller there,
    // and closer to touching the planes of their contacts.
    bool fits_better(const Centering& vertex, double radius) const {
        return vertex.is_foot && radius > vertex.radius - tolerance_ && vertex.misfit_of(radius) < vertex.misfit;
    }

    const MedialComplex& complex_;
    const ContactDirections& directions_;
    const Solid& solid_;
    double tolerance_;
    Feet feet_;
    std::vector<Centering> vertices_;
    std::int64_t questions_ = 0;
};

// `vertices` ascend, and have balls.
Touching touching_balls(const MedialComplex& complex, std::span<const Index> vertices, const Solid& solid,
                        double tolerance, Feet feet, const Execution& execution) {
    const ContactDirections directions(complex);
    const std::vector<FirstContact> contacts = first_contacts(complex, vertices, solid, tolerance);
    // Questions about places near to each other are answered faster one after the other.
    const auto centers =
        each_of<Point>(contacts, [&](const FirstContact& contact) { return complex.vertices[contact.vertex]; });
    const std::vector<Index> order = hilbert_order(centers);
    const auto ordered = each_of<FirstContact>(order, [&](Index i) { return contacts[i]; });
    std::vector<Touching> blocks = collect_blocks<Touching>(
        solid, ordered.size(), kBlocksOfProgress,
        [&](std::size_t begin, std::size_t end, Touching& out) {
            out = CenteringBatch(complex, directions, solid, tolerance, feet)
                      .run(std::span(ordered).subspan(begin, end - begin));
        },
        [&](double part) { report(execution, kCenteringStage, part); });
    const Touching found = join(blocks);
    Touching result{std::vector<Index>(contacts.size()), std::vector<Ball>(contacts.size()),
                    std::ssize(vertices) + found.questions};
    for (std::size_t k = 0; k < order.size(); ++k) {
        result.vertices[order[k]] = found.vertices[k];
        result.balls[order[k]] = found.balls[k];
    }
    return result;
}

std::vector<Index> vertices_from(std::size_t first, const MedialComplex& complex) {
    std::vector<Index> vertices(complex.vertices.size() - first);
    std::iota(vertices.begin(), vertices.end(), static_cast<Index>(first));
    return vertices;
}

void take(const Ball& ball, MedialComplex& complex, Index v) {
    complex.vertices[v] = ball.center;
    complex.radii[v] = ball.radius;
    complex.vertex_origins[v] = linear_vertex(ball.radius);
}

// Around vertices that move radii become linear, while those of the union dip between its balls: where the solid has a
// crevice, linear ones would fill it. Between which vertices is none needed? Between those that both stay, and between
// those that both come to touch the solid if the ball halfway does, too.
class DipsOfUnion {
   public:
    DipsOfUnion(const MedialComplex& complex, const Touching& touching, const Solid& solid, double tolerance)
        : touching_(touching), numbers_(complex.vertices.size(), kNone) {
        for (std::size_t i = 0; i < touching.vertices.size(); ++i) {
            numbers_[touching.vertices[i]] = static_cast<Index>(i);
        }
        std::vector<std::array<Index, 2>> pairs = pairs_off_linear(complex, kLeastDip * tolerance);
        std::erase_if(pairs, [&](const auto& pair) { return !touches(pair[0]) || !touches(pair[1]); });
        keep_touching(std::move(pairs), solid, kFaceError * tolerance);
    }

    bool needs_none(Index a, Index b) const {
        return std::ranges::binary_search(touching_pairs_, std::array{std::min(a, b), std::max(a, b)}) ||
               (!touches(a) && !touches(b));
    }

    std::int64_t questions() const { return questions_; }

   private:
    // New vertices stand for the union.
    bool touches(Index v) const { return v < std::ssize(numbers_) && numbers_[v] != kNone; }

    Ball ball_between(const std::array<Index, 2>& pair) const {
        const Ball& a = touching_.balls[numbers_[pair[0]]];
        const Ball& b = touching_.balls[numbers_[pair[1]]];
        return {midpoint(a.center, b.center), 0.5 * (a.radius + b.radius)};
    }

    void keep_touching(std::vector<std::array<Index, 2>> pairs, const Solid& solid, double error) {
        const auto balls = each_of<Ball>(pairs, [&](const auto& pair) { return ball_between(pair); });
        const std::vector<std::optional<double>> growths = growths_in(solid, balls, error);
        questions_ = std::ssize(pairs);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (touches_nearly(growths[i], error)) {
                touching_pairs_.push_back(pairs[i]);
            }
        }
        std::ranges::sort(touching_pairs_);
    }

    const Touching& touching_;
    std::vector<Index> numbers_;  // of the balls of vertices in `touching_`
    std::vector<std::array<Index, 2>> touching_pairs_;
    std::int64_t questions_ = 0;
};

// Halves edges where faces are large for how much the solid turns: beside its sharp edges, and around those that are
// re-entrant.
class FaceHalving {
   public:
    FaceHalving(CenteredComplex& centered, const Touching& touching, const Solid& solid, double tolerance)
        : complex_(centered.complex),
          statistics_(centered.statistics),
          solid_(solid),
          tolerance_(tolerance),
          touches_(complex_.vertices.size()) {
        note(touching.vertices);
    }

    void run() && {
        std::size_t known = 0;  // vertices that have been looked at
        for (int round = 0; round < kMostCenteringRounds; ++round) {
            const std::vector<std::uint8_t> faces = touching_faces_beside(known);
            const Halving halving =
                edges_to_halve(complex_, solid_, {.error = kFaceError * tolerance_, .asked_faces = faces});
            if (halving.count() == 0) {
                break;
            }
            known = complex_.vertices.size();
            complex_ = halved(complex_, halving);
            touches_.resize(complex_.vertices.size());
            statistics_.halved += static_cast<Index>(halving.count());
            center_new(known);
        }
        renew_object_angles();
    }

   private:
    // Where balls touch the solid, these angles are its own. Faces without an area keep what they have.
    void renew_object_angles() {
        const std::vector<double> before = complex_.face_angles;
        for (Index f = 0; f < static_cast<Index>(complex_.faces.size()); ++f) {
            if (all_touch(f)) {
                complex_.face_angles[f] = 0.0;
            }
        }
        find_object_angles(complex_, 1.0);
        for (std::size_t f = 0; f < before.size(); ++f) {
            if (complex_.face_angles[f] <= kFlatAngle) {
                complex_.face_angles[f] = before[f];
            }
        }
    }

    void note(std::span<const Index> vertices) {
        for (const Index v : vertices) {
            touches_[v] = 1;
        }
    }

    bool all_touch(Index f) const {
        return std::ranges::all_of(complex_.faces[f],
                                   [&](Index v) { return is_on_sharp_edge(complex_, v) || touches_[v] != 0; });
    }

    // Does a face have one of the vertices from this one on?
    bool is_beside(Index f, std::size_t first) const {
        return std::ranges::any_of(complex_.faces[f], [&](Index v) { return std::cmp_greater_equal(v, first); });
    }

    std::vector<std::uint8_t> touching_faces_beside(std::size_t first) const {
        std::vector<std::uint8_t> result(complex_.faces.size());
        for (Index f = 0; f < static_cast<Index>(result.size()); ++f) {
            result[f] = is_beside(f, first) && all_touch(f) && (is_strip(complex_, f) || may_stick_out(f)) ? 1 : 0;
        }
        return result;
    }

    // May balls between the corners of a face stick out of the solid by more than the error? By Apollonius's theorem a
    // point outside all balls at the corners is not nearer to their mean center than the root of the mean square of
    // their radii less that of their distances from it.
    bool may_stick_out(Index f) const {
        const std::span<const Index> corners = complex_.faces[f];
        if (sticks_out_at_most(corners) > kFaceError * tolerance_) {
            return true;
        }
        return std::ranges::any_of(complex_.face_edges[f], [&](Index e) {
            return sticks_out_at_most(complex_.edges[e]) > kFaceError * tolerance_;
        });
    }

    double sticks_out_at_most(std::span<const Index> corners) const {
        const Ball mean = mean_ball(complex_, corners);
        double square = 0.0;
        for (const Index v : corners) {
            square += complex_.radii[v] * complex_.radii[v] - squared_distance(complex_.vertices[v], mean.center);
        }
        square /= static_cast<double>(corners.size());
        return mean.radius - std::sqrt(std::max(0.0, square));
    }

    // Their neighbours have been centered before.
    void center_new(std::size_t first) {
        const Touching touching =
            touching_balls(complex_, vertices_from(first, complex_), solid_, tolerance_, Feet::kComeToSeams, {});
        statistics_.questions += touching.questions;
        note(touching.vertices);
        for (std::size_t i = 0; i < touching.vertices.size(); ++i) {
            take(touching.balls[i], complex_, touching.vertices[i]);
        }
    }

    MedialComplex& complex_;
    CenterStatistics& statistics_;
    const Solid& solid_;
    double tolerance_;
    std::vector<std::uint8_t> touches_;
};

CenteredComplex with_touching_balls(MedialComplex complex, const Touching& touching) {
    CenteredComplex result;
    CenterStatistics& statistics = result.statistics;
    statistics.questions = touching.questions;
    for (std::size_t i = 0; i < touching.vertices.size(); ++i) {
        const Index v = touching.vertices[i];
        const Ball& ball = touching.balls[i];
        const double move = distance(ball.center, complex.vertices[v]);
        ++statistics.fitted;
        statistics.moved += move > 0.0 ? 1 : 0;
        statistics.largest_move = std::max(statistics.largest_move, move);
        statistics.mean_growth += (ball.radius - complex.radii[v]) / static_cast<double>(complex.vertices.size());
        take(ball, complex, v);
    }
    result.complex = std::move(complex);
    return result;
}

Touching touching_balls_of_all(const MedialComplex& complex, const Solid& solid, const CenterOptions& options,
                               Feet feet, const Execution& execution) {
    require(options.tolerance > 0.0 && std::isfinite(options.tolerance),
            "the tolerance of centering must be a positive number");
    check_knows_nearest(solid);
    const auto vertices =
        indices_where(complex.vertices.size(), [&](Index v) { return !is_on_sharp_edge(complex, v); });
    return touching_balls(complex, vertices, solid, options.tolerance, feet, execution);
}

}  // namespace

CenteredComplex centered_as_it_is(MedialComplex complex, const Solid& solid, const CenterOptions& options, Feet feet,
                                  const Execution& execution) {
    return in_arena(execution, [&] {
        const Touching touching = touching_balls_of_all(complex, solid, options, feet, execution);
        return with_touching_balls(std::move(complex), touching);
    });
}

CenteredComplex centered(MedialComplex complex, const Solid& solid, const CenterOptions& options,
                         const Execution& execution) {
    return in_arena(execution, [&] {
        report(execution, kCenteringStage, 0.0);
        const double tolerance = options.tolerance;
        const std::size_t given = complex.vertices.size();
        Touching of_given = touching_balls_of_all(complex, solid, options, Feet::kComeToSeams, execution);
        const DipsOfUnion dips(complex, of_given, solid, tolerance);
        of_given.questions += dips.questions();
        complex = linearized(std::move(complex), kLeastDip * tolerance,
                             [&](Index a, Index b) { return dips.needs_none(a, b); });
        Touching of_new =
            touching_balls(complex, vertices_from(given, complex), solid, tolerance, Feet::kComeToSeams, {});
        std::vector parts{std::move(of_given), std::move(of_new)};
        const Touching touching = join(parts);
        CenteredComplex result = with_touching_balls(std::move(complex), touching);
        result.statistics.halved = static_cast<Index>(result.complex.vertices.size() - given);
        FaceHalving(result, touching, solid, tolerance).run();
        report(execution, kCenteringStage, 1.0);
        return result;
    });
}

CenteredComplex center(MedialComplex complex, const Solid& solid, const CenterOptions& options,
                       const Execution& execution) {
    check(complex);
    return centered(std::move(complex), solid, options, execution);
}

}  // namespace scaleaxis::inline v1
