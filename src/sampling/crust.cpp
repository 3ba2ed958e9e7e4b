// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "kernel/parallel.hpp"
#include "kernel/power_diagram.hpp"
#include "kernel/spheres.hpp"
#include "kernel/triangulation.hpp"
#include "sampling/restricted_facets.hpp"
#include "sampling/umbrellas.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/points.hpp"

namespace scaleaxis {
namespace {

// The corners of the box around everything are so many times as far from its centre as those of the points' box.
constexpr double kSurrounding = 5.0;

// Polar balls that meet at an angle with a smaller cosine tell nothing about each other: both cases occur.
constexpr double kDeep = 0.3;

// The same of the directions from a sample to its two poles, which should be opposite.
constexpr double kOpposite = 0.3;

constexpr Index kCorners = 8;

/// The Delaunay triangulation of the points and the corners of a box far around them; the corners come last.
struct Diagram {
    kernel::Triangulation triangulation;
    std::vector<kernel::Circumsphere> spheres;
    Index samples = 0;

    bool is_corner(Index vertex) const { return vertex >= samples; }
    bool has_ghost(Index cell) const {
        return std::ranges::any_of(triangulation.cells[cell].vertices, kernel::is_ghost);
    }
    bool has_corner(Index cell) const {
        return std::ranges::any_of(triangulation.cells[cell].vertices, [&](Index v) { return is_corner(v); });
    }
};

Diagram diagram_of(const std::vector<Point>& points) {
    Box box;
    for (const Point& p : points) {
        box.extend(p);
    }
    const Point center = midpoint(box.min, box.max);
    const double reach = 0.5 * kSurrounding * box.diagonal();
    std::vector<Point> all = points;
    for (Index k = 0; k < kCorners; ++k) {
        all.push_back(center + Point{(k & 1) != 0 ? reach : -reach, (k & 2) != 0 ? reach : -reach,
                                     (k & 4) != 0 ? reach : -reach});
    }
    Diagram diagram{kernel::triangulate(all), {}, static_cast<Index>(points.size())};
    diagram.spheres.resize(diagram.triangulation.size());
    kernel::for_each_index(static_cast<Index>(diagram.triangulation.size()), [&](Index t) {
        std::array<Index, 4> v = diagram.triangulation.cells[t].vertices;
        std::ranges::sort(v);
        const auto p = [&](int k) { return diagram.triangulation.point(v[k]); };
        diagram.spheres[t] = kernel::circumsphere(p(0), p(1), p(2), p(3), 1e4 * reach);
    });
    return diagram;
}

/// The two poles of each sample: the farthest centre of its cells, and the farthest one on the other side. `kNone`
/// where there is none.
std::vector<std::array<Index, 2>> find_poles(const Diagram& diagram) {
    std::vector<std::array<Index, 2>> poles(diagram.samples, {kNone, kNone});
    const auto for_each_incidence = [&](const auto& visit) {
        for (Index t = 0; t < static_cast<Index>(diagram.spheres.size()); ++t) {
            if (!diagram.has_ghost(t) && std::isfinite(diagram.spheres[t].radius)) {
                for (const Index v : diagram.triangulation.cells[t].vertices) {
                    if (!diagram.is_corner(v)) {
                        visit(t, v);
                    }
                }
            }
        }
    };
    const auto keep_larger = [&](Index& pole, Index t) {
        if (pole == kNone || diagram.spheres[t].radius > diagram.spheres[pole].radius) {
            pole = t;
        }
    };
    for_each_incidence([&](Index t, Index v) { keep_larger(poles[v][0], t); });
    for_each_incidence([&](Index t, Index v) {
        const Point& p = diagram.triangulation.points[v];
        if (dot(diagram.spheres[t].center - p, diagram.spheres[poles[v][0]].center - p) < 0.0) {
            keep_larger(poles[v][1], t);
        }
    });
    return poles;
}

/// What one pole says about another: that it lies on the same side, or on the other one.
struct Link {
    Index pole = kNone;
    bool is_same_side = false;
    double certainty = 0.0;  ///< 0…1
};

/// How deep two balls meet: the cosine of the angle between their spheres, 1 if one contains the other.
double depth(const kernel::Circumsphere& a, const kernel::Circumsphere& b) {
    const double square = squared_distance(a.center, b.center);
    return std::clamp((a.radius * a.radius + b.radius * b.radius - square) / (2.0 * a.radius * b.radius), -1.0, 1.0);
}

/// Which of the poles lie inside. Beliefs spread from the poles outside, the most certain ones first: balls that meet
/// deeply are on the same side, the two poles of a sample on different ones.
std::vector<std::uint8_t> label_poles(const Diagram& diagram, const std::vector<std::array<Index, 2>>& poles,
                                      const std::vector<Index>& pole_cells, const std::vector<Index>& pole_of_cell) {
    std::vector<std::vector<Link>> links(pole_cells.size());
    for (std::size_t v = 0; v < poles.size(); ++v) {
        const auto& [first, second] = poles[v];
        if (first == kNone || second == kNone) {
            continue;
        }
        const Point& p = diagram.triangulation.points[v];
        const Point a = diagram.spheres[first].center - p;
        const Point b = diagram.spheres[second].center - p;
        const double opposite = -dot(a, b) / (norm(a) * norm(b));
        if (opposite > kOpposite) {
            links[pole_of_cell[first]].push_back({pole_of_cell[second], false, opposite});
            links[pole_of_cell[second]].push_back({pole_of_cell[first], false, opposite});
        }
    }
    std::vector<Point> centers;
    std::vector<double> weights;
    for (const Index cell : pole_cells) {
        const auto& [center, radius] = diagram.spheres[cell];
        centers.push_back(center);
        weights.push_back(radius * radius);
    }
    const IndexLists neighbors = kernel::power_neighbors(kernel::triangulate(centers, weights), centers.size());
    for (std::size_t i = 0; i < pole_cells.size(); ++i) {
        for (const Index k : neighbors[i]) {
            const double deep = depth(diagram.spheres[pole_cells[i]], diagram.spheres[pole_cells[k]]);
            if (deep > kDeep) {
                links[i].push_back({k, true, deep});
            }
        }
    }

    // Belief that a pole is outside [0] or inside [1].
    std::vector<std::array<double, 2>> beliefs(pole_cells.size(), {0.0, 0.0});
    std::vector<bool> is_done(pole_cells.size());
    std::priority_queue<std::pair<double, Index>> queue;
    const auto certainty = [&](Index i) { return std::abs(beliefs[i][0] - beliefs[i][1]); };
    for (std::size_t i = 0; i < pole_cells.size(); ++i) {
        if (diagram.has_corner(pole_cells[i])) {
            beliefs[i][0] = 1.0;
            queue.emplace(1.0, -static_cast<Index>(i));
        }
    }
    std::vector<std::uint8_t> is_inside(pole_cells.size());
    while (!queue.empty()) {
        const auto [priority, negative] = queue.top();
        queue.pop();
        const Index i = -negative;
        if (is_done[i] || priority != certainty(i)) {
            continue;
        }
        is_done[i] = true;
        is_inside[i] = beliefs[i][1] > beliefs[i][0] ? 1 : 0;
        const double belief = beliefs[i][is_inside[i]];
        for (const Link& link : links[i]) {
            if (is_done[link.pole]) {
                continue;
            }
            double& side = beliefs[link.pole][link.is_same_side ? is_inside[i] : 1 - is_inside[i]];
            side = std::max(side, belief * link.certainty);
            queue.emplace(certainty(link.pole), -link.pole);
        }
    }
    return is_inside;
}

/// Which cells have their centres in the power cell of a pole inside, as far as the poles of their own vertices tell.
std::vector<std::uint8_t> label_cells(const Diagram& diagram, const std::vector<std::array<Index, 2>>& poles,
                                      const std::vector<Index>& pole_of_cell,
                                      const std::vector<std::uint8_t>& is_pole_inside) {
    std::vector<std::uint8_t> is_inside(diagram.spheres.size());
    kernel::for_each_index(static_cast<Index>(is_inside.size()), [&](Index t) {
        if (diagram.has_ghost(t) || diagram.has_corner(t) || !std::isfinite(diagram.spheres[t].radius)) {
            return;
        }
        if (pole_of_cell[t] != kNone) {
            is_inside[t] = is_pole_inside[pole_of_cell[t]];
            return;
        }
        double least = std::numeric_limits<double>::infinity();
        for (const Index v : diagram.triangulation.cells[t].vertices) {
            for (const Index pole : poles[v]) {
                if (pole == kNone) {
                    continue;
                }
                const auto& [center, radius] = diagram.spheres[pole];
                const double power = squared_distance(center, diagram.spheres[t].center) - radius * radius;
                if (power < least) {
                    least = power;
                    is_inside[t] = is_pole_inside[pole_of_cell[pole]];
                }
            }
        }
    });
    return is_inside;
}

Samples samples_of(const Diagram& diagram, const std::vector<std::uint8_t>& is_inside) {
    Samples samples;
    const std::vector<kernel::Tetrahedron>& cells = diagram.triangulation.cells;
    std::vector<Index> new_index(cells.size(), kNone);
    for (std::size_t t = 0; t < cells.size(); ++t) {
        const auto cell = static_cast<Index>(t);
        if (!diagram.has_ghost(cell) && !diagram.has_corner(cell)) {
            new_index[t] = static_cast<Index>(samples.tetrahedra.size());
            samples.tetrahedra.push_back(cells[t].vertices);
            samples.centers.push_back(diagram.spheres[t].center);
            samples.radii.push_back(diagram.spheres[t].radius);
            samples.inside.push_back(is_inside[t]);
        }
    }
    for (std::size_t t = 0; t < cells.size(); ++t) {
        if (new_index[t] != kNone) {
            std::array<Index, 4> neighbors = cells[t].neighbors;
            for (Index& neighbor : neighbors) {
                neighbor = neighbor != kNone ? new_index[neighbor] : kNone;
            }
            samples.neighbors.push_back(neighbors);
        }
    }
    samples.points.assign(diagram.triangulation.points.begin(), diagram.triangulation.points.begin() + diagram.samples);
    return samples;
}

/// The median circumradius of the facets between inside and outside.
double typical_facet_radius(const Samples& samples) {
    std::vector<double> radii;
    for (const RestrictedFacet& facet : restricted_facets(samples)) {
        const auto [u, v, w] = vertices_of(samples, facet);
        const Point a = samples.points[v] - samples.points[u];
        const Point b = samples.points[w] - samples.points[u];
        radii.push_back(norm(a) * norm(b) * norm(a - b) / (2.0 * norm(cross(a, b))));
    }
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    return *middle;
}

}  // namespace

Samples crust(const PreparedCloud& cloud, const Execution& execution) {
    if (!cloud.report.fault.empty()) {
        throw UnusableShape(cloud.report.fault);
    }
    return kernel::in_arena(execution, [&] {
        kernel::report(execution, "crust", 0.0);
        const Diagram diagram = diagram_of(cloud.cloud.points);
        const std::vector<std::array<Index, 2>> poles = find_poles(diagram);
        std::vector<Index> pole_cells;
        for (const auto& [first, second] : poles) {
            pole_cells.push_back(first);
            pole_cells.push_back(second);
        }
        std::ranges::sort(pole_cells);
        const auto repeated = std::ranges::unique(pole_cells);
        pole_cells.erase(repeated.begin(), repeated.end());
        std::erase(pole_cells, kNone);
        std::vector<Index> pole_of_cell(diagram.spheres.size(), kNone);
        for (std::size_t i = 0; i < pole_cells.size(); ++i) {
            pole_of_cell[pole_cells[i]] = static_cast<Index>(i);
        }
        kernel::report(execution, "crust", 0.4);
        const std::vector<std::uint8_t> is_pole_inside = label_poles(diagram, poles, pole_cells, pole_of_cell);
        const std::vector<std::uint8_t> is_inside = label_cells(diagram, poles, pole_of_cell, is_pole_inside);
        if (std::ranges::find(is_inside, 1) == is_inside.end()) {
            throw UnusableShape(
                "no pole of the points lies inside: they are too few, too far apart or too noisy for the crust; use "
                "moving least squares");
        }
        Samples samples = samples_of(diagram, is_inside);
        samples.tolerance = typical_facet_radius(samples);
        samples.statistics.seeds = static_cast<Index>(samples.points.size());
        count_umbrellas(samples);
        kernel::report(execution, "crust", 1.0);
        return samples;
    });
}

}  // namespace scaleaxis
