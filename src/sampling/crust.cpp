// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "delaunay/power_diagram.hpp"
#include "delaunay/triangulation.hpp"
#include "sampling/restricted_facets.hpp"
#include "sampling/umbrellas.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/crust.hpp"
#include "scaleaxis/errors.hpp"
#include "spatial/extent.hpp"
#include "spatial/spheres.hpp"

namespace scaleaxis::inline v1 {
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
    Triangulation triangulation;
    std::vector<Circumsphere> spheres;
    Index samples = 0;

    bool is_corner(Index vertex) const { return vertex >= samples; }
    bool has_ghost(Index cell) const { return std::ranges::any_of(triangulation.cells[cell].vertices, is_ghost); }
    bool has_corner(Index cell) const {
        return std::ranges::any_of(triangulation.cells[cell].vertices, [&](Index v) { return is_corner(v); });
    }
};

Diagram diagram_of(const std::vector<Point>& points) {
    const Box box = box_around(points);
    const Point center = midpoint(box.min, box.max);
    const double reach = 0.5 * kSurrounding * box.diagonal();
    std::vector<Point> all = points;
    for (Index k = 0; k < kCorners; ++k) {
        all.push_back(center + Point{(k & 1) != 0 ? reach : -reach, (k & 2) != 0 ? reach : -reach,
                                     (k & 4) != 0 ? reach : -reach});
    }
    Diagram diagram{triangulate(all), {}, static_cast<Index>(points.size())};
    diagram.spheres.resize(diagram.triangulation.size());
    for_each_index(static_cast<Index>(diagram.triangulation.size()), [&](Index t) {
        std::array<Index, 4> v = diagram.triangulation.cells[t].vertices;
        std::ranges::sort(v);
        const auto p = [&](int k) { return diagram.triangulation.point(v[k]); };
        diagram.spheres[t] = circumsphere(p(0), p(1), p(2), p(3), 1e4 * reach);
    });
    return diagram;
}

/// The two poles of each sample: the farthest centre of its cells, and the farthest one on the other side. `kNone`
/// where there is none.
std::vector<std::array<Index, 2>> find_poles(const Diagram& diagram) {
    std::vector<std::array<Index, 2>> poles(diagram.samples, {kNone, kNone});
    CancellationPoint cancellation_point;
    const auto for_each_incidence = [&](const auto& visit) {
        for (Index t = 0; t < static_cast<Index>(diagram.spheres.size()); ++t) {
            cancellation_point();
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

/// The polar cells of a diagram.
struct Poles {
    std::vector<std::array<Index, 2>> of_sample;  ///< cells, as `find_poles` has them
    std::vector<Index> cells;                     ///< of all poles, ascending
    std::vector<Index> of_cell;                   ///< which pole a cell is, `kNone` if it is none
};

Poles poles_of(const Diagram& diagram) {
    Poles poles{find_poles(diagram), {}, std::vector<Index>(diagram.spheres.size(), kNone)};
    for (const auto& pair : poles.of_sample) {
        poles.cells.insert(poles.cells.end(), pair.begin(), pair.end());
    }
    std::ranges::sort(poles.cells);
    poles.cells.erase(std::unique(poles.cells.begin(), poles.cells.end()), poles.cells.end());
    std::erase(poles.cells, kNone);
    for (std::size_t i = 0; i < poles.cells.size(); ++i) {
        poles.of_cell[poles.cells[i]] = static_cast<Index>(i);
    }
    return poles;
}

/// What one pole tells about another: that it lies on the same side, or on the other one.
struct Link {
    Index pole = kNone;
    bool is_same_side = false;
    double certainty = 0.0;  ///< 0…1
};
using Links = std::vector<std::vector<Link>>;  // of each pole

/// The two poles of a sample lie on different sides, if their directions are about opposite.
void link_opposite_poles(const Diagram& diagram, const Poles& poles, Links& links) {
    for (std::size_t v = 0; v < poles.of_sample.size(); ++v) {
        const auto& [first, second] = poles.of_sample[v];
        if (first == kNone || second == kNone) {
            continue;
        }
        const Point& p = diagram.triangulation.points[v];
        const Point a = diagram.spheres[first].center - p;
        const Point b = diagram.spheres[second].center - p;
        const double opposite = -dot(a, b) / (norm(a) * norm(b));
        if (opposite > kOpposite) {
            links[poles.of_cell[first]].push_back({poles.of_cell[second], false, opposite});
            links[poles.of_cell[second]].push_back({poles.of_cell[first], false, opposite});
        }
    }
}

/// How deep two balls meet: the cosine of the angle between their spheres, 1 if one contains the other.
double depth(const Circumsphere& a, const Circumsphere& b) {
    const double square = squared_distance(a.center, b.center);
    return std::clamp((a.radius * a.radius + b.radius * b.radius - square) / (2.0 * a.radius * b.radius), -1.0, 1.0);
}

/// Poles whose balls meet deeply lie on the same side.
void link_meeting_poles(const Diagram& diagram, const Poles& poles, Links& links) {
    std::vector<Point> centers;
    std::vector<double> weights;
    for (const Index cell : poles.cells) {
        const auto& [center, radius] = diagram.spheres[cell];
        centers.push_back(center);
        weights.push_back(radius * radius);
    }
    const IndexLists neighbors = power_neighbors(triangulate(centers, weights), centers.size());
    for_each_index(poles.cells.size(), [&](std::size_t i) {
        for (const Index k : neighbors[i]) {
            const double deep = depth(diagram.spheres[poles.cells[i]], diagram.spheres[poles.cells[k]]);
            if (deep > kDeep) {
                links[i].push_back({k, true, deep});
            }
        }
    });
}

/// Spreads beliefs along the links from poles that are outside, the most certain ones first. Returns 1 for poles
/// believed to be inside, 0 for the others.
std::vector<std::uint8_t> spread_beliefs(const Links& links, const std::vector<Index>& outside) {
    std::vector<std::array<double, 2>> beliefs(links.size(), {0.0, 0.0});  // that a pole is outside [0], inside [1]
    std::vector<std::uint8_t> is_done(links.size());
    std::vector<std::uint8_t> is_inside(links.size());
    std::priority_queue<std::pair<double, Index>> queue;  // of equal certainties the first pole comes first
    const auto certainty = [&](Index i) { return std::abs(beliefs[i][0] - beliefs[i][1]); };
    for (const Index i : outside) {
        beliefs[i][0] = 1.0;
        queue.emplace(1.0, -i);
    }
    CancellationPoint cancellation_point;
    while (!queue.empty()) {
        cancellation_point();
        const auto [priority, negative] = queue.top();
        queue.pop();
        const Index i = -negative;
        if (is_done[i] != 0 || priority != certainty(i)) {
            continue;
        }
        is_done[i] = 1;
        is_inside[i] = beliefs[i][1] > beliefs[i][0] ? 1 : 0;
        for (const Link& link : links[i]) {
            if (is_done[link.pole] == 0) {
                double& belief = beliefs[link.pole][link.is_same_side ? is_inside[i] : 1 - is_inside[i]];
                belief = std::max(belief, beliefs[i][is_inside[i]] * link.certainty);
                queue.emplace(certainty(link.pole), -link.pole);
            }
        }
    }
    return is_inside;
}

/// Which of the poles lie inside.
std::vector<std::uint8_t> label_poles(const Diagram& diagram, const Poles& poles) {
    Links links(poles.cells.size());
    link_opposite_poles(diagram, poles, links);
    link_meeting_poles(diagram, poles, links);
    const auto outside = indices_where(poles.cells.size(), [&](Index i) { return diagram.has_corner(poles.cells[i]); });
    return spread_beliefs(links, outside);
}

/// Which cells have their centres in the power cell of a pole inside, as far as the poles of their own vertices tell.
std::vector<std::uint8_t> label_cells(const Diagram& diagram, const Poles& poles,
                                      const std::vector<std::uint8_t>& is_pole_inside) {
    std::vector<std::uint8_t> is_inside(diagram.spheres.size());
    for_each_index(static_cast<Index>(is_inside.size()), [&](Index t) {
        if (diagram.has_ghost(t) || diagram.has_corner(t) || !std::isfinite(diagram.spheres[t].radius)) {
            return;
        }
        if (poles.of_cell[t] != kNone) {
            is_inside[t] = is_pole_inside[poles.of_cell[t]];
            return;
        }
        double least = std::numeric_limits<double>::infinity();
        for (const Index v : diagram.triangulation.cells[t].vertices) {
            for (const Index pole : poles.of_sample[v]) {
                if (pole == kNone) {
                    continue;
                }
                const auto& [center, radius] = diagram.spheres[pole];
                const double power = squared_distance(center, diagram.spheres[t].center) - radius * radius;
                if (power < least) {
                    least = power;
                    is_inside[t] = is_pole_inside[poles.of_cell[pole]];
                }
            }
        }
    });
    return is_inside;
}

Samples samples_of(const Diagram& diagram, const std::vector<std::uint8_t>& is_inside) {
    Samples samples;
    const std::vector<Tetrahedron>& cells = diagram.triangulation.cells;
    std::vector<Index> new_index(cells.size(), kNone);
    CancellationPoint cancellation_point;
    for (std::size_t t = 0; t < cells.size(); ++t) {
        cancellation_point();
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
        radii.push_back(circumradius(samples.points[u], samples.points[v], samples.points[w]));
    }
    return median(std::move(radii));
}

std::string number(double value) { return value < 10.0 ? to_text(value, 2) : to_text(std::round(value), 9); }

}  // namespace

Samples crust(const PreparedCloud& cloud, const Execution& execution) {
    if (!cloud.report.fault.empty()) {
        throw UnusableInput(cloud.report.fault);
    }
    return in_arena(execution, [&] {
        report(execution, "crust", 0.0);
        const Diagram diagram = diagram_of(cloud.cloud.points);
        report(execution, "crust", 0.3);
        const Poles poles = poles_of(diagram);
        report(execution, "crust", 0.4);
        const std::vector<std::uint8_t> is_inside = label_cells(diagram, poles, label_poles(diagram, poles));
        report(execution, "crust", 0.8);
        if (std::ranges::find(is_inside, 1) == is_inside.end()) {
            throw UnusableInput(
                "no pole of the points lies inside: they are too few, too far apart or too noisy for the crust; use "
                "moving least squares");
        }
        Samples samples = samples_of(diagram, is_inside);
        samples.tolerance = typical_facet_radius(samples);
        samples.statistics.seeds = static_cast<Index>(samples.points.size());
        count_facets(samples);
        report(execution, "crust", 1.0);
        return samples;
    });
}

CloudChoice choose_method(const PreparedCloud& cloud, const Execution& execution) {
    constexpr double kCleanPoints = 0.25;
    constexpr double kFewIrregularPoints = 0.02;
    const auto smoothed_surface = [](const std::string& reason) {
        return CloudChoice{CloudMethod::kMovingLeastSquares, reason, std::nullopt};
    };
    const CloudReport& report = cloud.report;
    const std::string noise = "noise of " + number(100.0 * report.noise) + " % of the points' spacing";
    if (report.parts == 0 && report.fault.empty()) {
        return smoothed_surface("the points have normals");
    }
    if (report.is_open()) {
        return smoothed_surface("the surface is open");
    }
    if (report.noise > kCleanPoints) {
        return smoothed_surface(noise);
    }
    if (report.thinned > 0) {
        return smoothed_surface("the points are denser than the tolerance");
    }
    Samples samples = crust(cloud, execution);
    const std::string irregular = std::to_string(samples.statistics.irregular_samples) + " of " +
                                  std::to_string(samples.points.size()) + " points are irregular";
    if (samples.statistics.irregular_samples > kFewIrregularPoints * static_cast<double>(samples.points.size())) {
        return smoothed_surface("the points as they are form no surface: " + irregular);
    }
    return {CloudMethod::kCrust, "no normals, and the points as they are form a surface: " + irregular + ", " + noise,
            std::move(samples)};
}

}  // namespace scaleaxis::inline v1
