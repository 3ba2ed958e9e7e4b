// SPDX-License-Identifier: Apache-2.0
#include "axis/inner_voronoi.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/grouped.hpp"
#include "base/parallel.hpp"
#include "delaunay/edges.hpp"
#include "spatial/extent.hpp"
#include "spatial/spheres.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Balls that have all of some boundary vertices on their spheres: at most three.
struct SharedBalls {
    std::array<Index, 3> balls{};
    int count = 0;

    explicit SharedBalls(const std::array<Index, 3>& all) : balls(all), count(3) {}

    void keep(const std::array<Index, 3>& others) {
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            if (balls[i] == others[0] || balls[i] == others[1] || balls[i] == others[2]) {
                balls[kept++] = balls[i];
            }
        }
        count = kept;
    }
};

// What is known of a Delaunay cell of the boundary vertices: the number of its centre, or one of these. Whether its
// vertices share a ball is known from their names; a cell whose vertices do has the ball's centre for its own, which no
// rounding may decide.
using Label = Index;
constexpr Label kOutside = -1;    // its centre lies outside the union
constexpr Label kFlatLabel = -2;  // its vertices share two balls: four points of a circle, with no centre of their own
constexpr Label kUnknown = -3;    // and below: `kUnknown - i`, if its centre is the circumcentre `i`

bool is_unknown(Label label) { return label <= kUnknown; }

struct LabelledCells {
    Triangulation triangulation;
    std::vector<Label> labels;
    std::vector<std::uint8_t> walls;    // bit `k`: the vertices of facet `k` share a ball
    std::vector<Circumsphere> spheres;  // those that `InnerVoronoi` has
};

bool has_ball(const std::array<Index, 3>& balls, Index ball) {
    return (balls[0] == ball) | (balls[1] == ball) | (balls[2] == ball);
}

void label_by_names(LabelledCells& cells, const BoundaryVertices& vertices) {
    const Triangulation& t = cells.triangulation;
    cells.labels.resize(t.size());
    cells.walls.resize(t.size());
    constexpr std::array<Index, 3> kNoBalls{-2, -2, -2};  // what a ghost has
    for_each_index(t.size(), [&](std::size_t c) {
        const std::array<Index, 4>& v = t.cells[c].vertices;
        std::array<std::array<Index, 3>, 4> names;
        for (int k = 0; k < 4; ++k) {
            names[k] = is_ghost(v[k]) ? kNoBalls : vertices.balls[v[k]];
        }
        unsigned walls = 0;
        Label label = kUnknown;
        for (const Index ball : names[0]) {
            const unsigned has_1 = has_ball(names[1], ball);
            const unsigned has_2 = has_ball(names[2], ball);
            const unsigned has_3 = has_ball(names[3], ball);
            walls |= (has_2 & has_3) << 1 | (has_1 & has_3) << 2 | (has_1 & has_2) << 3;
            if ((has_1 & has_2 & has_3) != 0) {
                label = label == kUnknown ? ball : kFlatLabel;
            }
        }
        for (const Index ball : names[1]) {
            walls |= unsigned{has_ball(names[2], ball)} & unsigned{has_ball(names[3], ball)};
        }
        if (is_ghost(v[0])) {  // ghosts come first; several of them share no ball
            label = kOutside;
            walls = is_ghost(v[1]) ? 0 : walls & 1;
        }
        cells.labels[c] = label;
        cells.walls[c] = static_cast<std::uint8_t>(walls);
    });
}

// Extends the list, from position `next` on, by all unknown cells that no wall separates from those in it. `reach`
// gives each a label that is known.
template <class Reach>
void flood(const LabelledCells& cells, std::vector<Index>& list, std::size_t next, const Reach& reach) {
    CancellationPoint cancellation_point;
    for (; next < list.size(); ++next) {
        cancellation_point();
        const Index cell = list[next];
        for (int k = 0; k < 4; ++k) {
            const Index neighbor = cells.triangulation.cells[cell].neighbors[k];
            if (neighbor != kNone && is_unknown(cells.labels[neighbor]) && (cells.walls[cell] >> k & 1) == 0) {
                reach(neighbor);
                list.push_back(neighbor);
            }
        }
    }
}

// The circumspheres of the cells that are still unknown, numbered in their order.
void find_circumspheres(LabelledCells& cells, double limit) {
    std::vector<Index> unknown;
    for (Index c = 0; c < static_cast<Index>(cells.labels.size()); ++c) {
        if (is_unknown(cells.labels[c])) {
            cells.labels[c] = kUnknown - static_cast<Index>(unknown.size());
            unknown.push_back(c);
        }
    }
    cells.spheres = mapped<Circumsphere>(unknown.size(), [&](std::size_t i) {
        const Triangulation& t = cells.triangulation;
        const std::array<Index, 4>& v = t.cells[unknown[i]].vertices;
        return circumsphere(t.point(v[0]), t.point(v[1]), t.point(v[2]), t.point(v[3]), limit);
    });
}

// One cell of the regular triangulation for each ball, to start walks from.
std::vector<Index> cells_of_balls(const DualComplex& complex, std::size_t balls) {
    std::vector<Index> cells(balls, 0);
    for (Index c = 0; c < static_cast<Index>(complex.triangulation.size()); ++c) {
        for (const Index v : complex.triangulation.cells[c].vertices) {
            if (!is_ghost(v)) {
                cells[v] = c;
            }
        }
    }
    return cells;
}

// A Voronoi edge leaves the dual complex only through the centre of a ball, where it meets a cell of that ball or a
// wall. So all cells that can be reached without passing one lie on one side, and the largest of them tells which: its
// centre is the farthest from where the sides meet.
void label_by_flooding(LabelledCells& cells, const BoundaryVertices& vertices, const DualComplex& complex,
                       std::size_t balls) {
    const Triangulation& t = cells.triangulation;
    const auto count = static_cast<Index>(t.size());
    std::vector<Index> list;
    for (Index c = 0; c < count && cells.labels[c] == kOutside; ++c) {  // cells with a ghost come first
        list.push_back(c);
    }
    std::vector<Index> hints;
    run_together([&] { flood(cells, list, 0, [&](Index cell) { cells.labels[cell] = kOutside; }); },
                 [&] { hints = cells_of_balls(complex, balls); });

    const Box box = box_around(vertices.points);
    // The radius of an inside cell is bounded by that of the union; the centres of balls may lie outside the box of the
    // boundary vertices, hence the factor.
    find_circumspheres(cells, 1e3 * box.diagonal());

    CancellationPoint cancellation_point;
    for (Index first = 0; first < count; ++first) {
        cancellation_point();
        if (!is_unknown(cells.labels[first])) {
            continue;
        }
        // Taken for inside until its largest cell has been asked: most components are.
        Index largest = first;
        double radius = -1.0;
        const auto reach = [&](Index cell) {
            const Index sphere = kUnknown - cells.labels[cell];
            cells.labels[cell] = static_cast<Label>(balls) + sphere;
            if (cells.spheres[sphere].radius > radius) {
                largest = cell;
                radius = cells.spheres[sphere].radius;
            }
        };
        list.assign(1, first);
        reach(first);
        flood(cells, list, 0, reach);
        bool is_inside = std::isfinite(radius);
        if (is_inside) {
            const Point& center = cells.spheres[cells.labels[largest] - static_cast<Label>(balls)].center;
            const Index ball = vertices.balls[t.cells[largest].vertices[0]][0];
            const Index at = locate(complex.triangulation, center, hints[ball]);
            is_inside = at != kNone && complex.has_cell[at] != 0;
        }
        if (!is_inside) {
            for (const Index cell : list) {
                cells.labels[cell] = kOutside;
            }
        }
    }
}

// Polygons of the diagram as they are found, part by part.
struct Found {
    std::vector<Index> corners;
    std::vector<Index> ends;  // of the polygons, among the corners
    std::vector<std::array<Index, 2>> contacts;
    std::vector<std::array<Index, 2>> edges;
    bool is_consistent = true;
};

Found join(std::vector<Found>& parts) {
    Index corners = 0;
    bool is_consistent = true;
    for (Found& part : parts) {
        for (Index& end : part.ends) {
            end += corners;
        }
        corners += static_cast<Index>(part.corners.size());
        is_consistent = is_consistent && part.is_consistent;
    }
    return {joined(parts, &Found::corners), joined(parts, &Found::ends), joined(parts, &Found::contacts),
            joined(parts, &Found::edges), is_consistent};
}

class PolygonFinder {
   public:
    PolygonFinder(const LabelledCells& cells, const BoundaryVertices& vertices, std::span<const Ball> balls)
        : cells_(cells), vertices_(vertices), balls_(balls) {}

    // The polygon dual to an edge, from the cells around it, of which the first one has a centre inside the union.
    void find(std::vector<AroundEdge>& around, Found& found) const {
        const auto [a, b] = ends_of_edge(cells_.triangulation, around.front());
        std::erase_if(around, [&](const AroundEdge& at) { return cells_.labels[at.cell] == kFlatLabel; });
        SharedBalls shared(vertices_.balls[a]);
        shared.keep(vertices_.balls[b]);
        if (shared.count == 3) {
            return;  // the polygon is the triangle of the three centres, which the dual complex has
        }

        thread_local std::vector<Index> polygon;
        polygon.clear();
        for (std::size_t k = 0; k < around.size(); ++k) {
            push(polygon, cells_.labels[around[k].cell]);
            if ((cells_.walls[around[k].cell] >> around[k].exit & 1) != 0) {
                push_walls(polygon, shared, around[k], around[k + 1 < around.size() ? k + 1 : 0].cell);
            }
        }

        const int outside_runs = drop_outside(polygon);
        while (polygon.size() > 1 && polygon.front() == polygon.back()) {
            polygon.pop_back();
        }
        if (polygon.size() < 2) {
            return;  // a face outside the union that ends at the centre of a ball
        }
        if (outside_runs > (shared.count == 2 ? 1 : 0) || has_repetition(polygon)) {
            found.is_consistent = false;
            return;
        }
        if (polygon.size() >= 3) {
            append(found.corners, polygon);
            found.ends.push_back(static_cast<Index>(found.corners.size()));
            found.contacts.push_back({a, b});
        } else if (polygon.size() == 2) {
            found.edges.push_back({polygon[0], polygon[1]});
        }
    }

   private:
    static void push(std::vector<Index>& polygon, Index center) {
        if (polygon.empty() || polygon.back() != center) {
            polygon.push_back(center);
        }
    }

    // A Voronoi edge passes through the centre of a ball that its three boundary vertices share. If neither end is this
    // centre, it lies in the middle of the edge. `shared`: the balls of two of the three.
    void push_walls(std::vector<Index>& polygon, SharedBalls shared, const AroundEdge& from, Index to) const {
        shared.keep(vertices_.balls[cells_.triangulation.cells[from.cell].vertices[from.apex]]);
        std::array<Index, 2> middle{};
        int count = 0;
        for (int i = 0; i < shared.count && count < 2; ++i) {
            if (shared.balls[i] != cells_.labels[from.cell] && shared.balls[i] != cells_.labels[to]) {
                middle[count++] = shared.balls[i];
            }
        }
        if (count == 2) {
            const Point along = -1.0 * facet_normal(from.cell, from.exit);
            if (dot(along, balls_[middle[1]].center - balls_[middle[0]].center) < 0.0) {
                std::swap(middle[0], middle[1]);
            }
        }
        for (int i = 0; i < count; ++i) {
            push(polygon, middle[i]);
        }
    }

    // Points into the cell.
    Point facet_normal(Index cell, int k) const {
        const Triangulation& t = cells_.triangulation;
        const std::array<Index, 3> facet = facet_of_cell(t.cells[cell].vertices, k);
        const Point p = t.point(facet[0]);
        return cross(t.point(facet[1]) - p, t.point(facet[2]) - p);
    }

    // Removes the marks of outside cells and returns in how many runs they stood; the first entry is none of them.
    static int drop_outside(std::vector<Index>& polygon) {
        const auto runs = std::count(polygon.begin(), polygon.end(), kOutside);
        if (runs > 0) {
            std::erase(polygon, kOutside);
            polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
        }
        return static_cast<int>(runs);
    }

    static bool has_repetition(const std::vector<Index>& polygon) {
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            if (std::find(polygon.begin() + static_cast<std::ptrdiff_t>(i) + 1, polygon.end(), polygon[i]) !=
                polygon.end()) {
                return true;
            }
        }
        return false;
    }

    const LabelledCells& cells_;
    const BoundaryVertices& vertices_;
    std::span<const Ball> balls_;
};

}  // namespace

InnerVoronoi inner_voronoi(const BoundaryVertices& vertices, const DualComplex& complex, std::span<const Ball> balls) {
    LabelledCells cells;
    cells.triangulation = triangulate(vertices.points);
    label_by_names(cells, vertices);
    label_by_flooding(cells, vertices, complex, balls.size());

    const PolygonFinder finder(cells, vertices, balls);
    const auto has_center = [&](Index cell) { return cells.labels[cell] >= 0; };
    Found found = collect_edges<Found>(cells.triangulation, has_center,
                                       [&](std::vector<AroundEdge>& around, Found& out) { finder.find(around, out); });

    InnerVoronoi result;
    result.cells = static_cast<Index>(cells.triangulation.size());
    for (const Label label : cells.labels) {
        result.flat_cells += label == kFlatLabel ? 1 : 0;
        result.inside_cells += label >= 0 ? 1 : 0;
    }
    result.spheres = std::move(cells.spheres);
    result.polygons.items = std::move(found.corners);
    append(result.polygons.offsets, found.ends);
    result.contacts = std::move(found.contacts);
    result.edges = std::move(found.edges);
    result.is_consistent = found.is_consistent;
    return result;
}

}  // namespace scaleaxis::inline v1
