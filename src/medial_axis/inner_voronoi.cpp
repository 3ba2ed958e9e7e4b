// SPDX-License-Identifier: GPL-3.0-or-later
#include "medial_axis/inner_voronoi.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "kernel/edges.hpp"
#include "kernel/parallel.hpp"
#include "kernel/spheres.hpp"

namespace scaleaxis {
namespace {

using kernel::is_ghost;
using kernel::Triangulation;

// Vertex positions of the facet opposite to each vertex, counter-clockwise as seen from that vertex.
constexpr std::array<std::array<int, 3>, 4> kFacetOfCell{{{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

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

// What a Delaunay cell of the boundary vertices is. Whether its vertices share a ball is known from their names; a cell
// whose vertices do has the ball's centre for its own, which no rounding may decide.
enum class Kind : std::uint8_t {
    kUnknown,
    kOutside,
    kInside,
    kBall,  // its vertices share one ball
    kFlat,  // its vertices share two balls: four points of a circle, with no centre of their own
};

struct LabelledCells {
    Triangulation triangulation;
    std::vector<Kind> kinds;
    std::vector<Index> balls;         // the ball of a `kBall` cell
    std::vector<std::uint8_t> walls;  // bit `k`: the vertices of facet `k` share a ball
    std::vector<Point> centers;       // of `kInside` cells
    std::vector<double> radii;
};

bool has_ball(const std::array<Index, 3>& balls, Index ball) {
    return (balls[0] == ball) | (balls[1] == ball) | (balls[2] == ball);
}

void label_by_names(LabelledCells& cells, const BoundaryVertices& vertices) {
    const Triangulation& t = cells.triangulation;
    cells.kinds.resize(t.size(), Kind::kUnknown);
    cells.balls.resize(t.size(), kNone);
    cells.walls.resize(t.size());
    constexpr std::array<Index, 3> kNoBalls{-2, -2, -2};  // what a ghost has
    kernel::for_each_index(t.size(), [&](std::size_t c) {
        const std::array<Index, 4>& v = t.vertices[c];
        std::array<std::array<Index, 3>, 4> names;
        for (int k = 0; k < 4; ++k) {
            names[k] = is_ghost(v[k]) ? kNoBalls : vertices.balls[v[k]];
        }
        unsigned walls = 0;
        int common_balls = 0;
        for (const Index ball : names[0]) {
            const unsigned has_1 = has_ball(names[1], ball);
            const unsigned has_2 = has_ball(names[2], ball);
            const unsigned has_3 = has_ball(names[3], ball);
            walls |= (has_2 & has_3) << 1 | (has_1 & has_3) << 2 | (has_1 & has_2) << 3;
            if ((has_1 & has_2 & has_3) != 0) {
                ++common_balls;
                cells.balls[c] = ball;
            }
        }
        for (const Index ball : names[1]) {
            walls |= unsigned{has_ball(names[2], ball)} & unsigned{has_ball(names[3], ball)};
        }
        if (is_ghost(v[0])) {  // ghosts come first; several of them share no ball
            cells.kinds[c] = Kind::kOutside;
            cells.balls[c] = kNone;
            walls = is_ghost(v[1]) ? 0 : walls & 1;
        } else if (common_balls > 0) {
            cells.kinds[c] = common_balls == 1 ? Kind::kBall : Kind::kFlat;
        }
        cells.walls[c] = static_cast<std::uint8_t>(walls);
    });
}

// Spreads `kind` from cells on the stack to all cells of unknown kind that no wall separates from them.
void flood(LabelledCells& cells, std::vector<Index>& stack, Kind kind) {
    const Triangulation& t = cells.triangulation;
    while (!stack.empty()) {
        const Index cell = stack.back();
        stack.pop_back();
        for (int k = 0; k < 4; ++k) {
            const Index neighbor = t.neighbors[cell][k];
            if (neighbor != kNone && cells.kinds[neighbor] == Kind::kUnknown && (cells.walls[cell] >> k & 1) == 0) {
                cells.kinds[neighbor] = kind;
                stack.push_back(neighbor);
            }
        }
    }
}

// One cell of the regular triangulation for each ball, to start walks from.
std::vector<Index> cells_of_balls(const DualComplex& complex, std::size_t balls) {
    std::vector<Index> cells(balls, 0);
    for (Index c = 0; c < static_cast<Index>(complex.triangulation.size()); ++c) {
        for (const Index v : complex.triangulation.vertices[c]) {
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
    std::vector<Index> stack;
    for (Index c = 0; c < count && cells.kinds[c] == Kind::kOutside; ++c) {  // cells with a ghost come first
        stack.push_back(c);
    }
    flood(cells, stack, Kind::kOutside);

    Box box;
    for (const Point& p : vertices.points) {
        box.extend(p);
    }
    // The radius of an inside cell is bounded by that of the union; the centres of balls may lie outside the box of the
    // boundary vertices, hence the factor.
    const double limit = 1e3 * box.diagonal();
    cells.centers.resize(t.size());
    cells.radii.resize(t.size());
    kernel::for_each_index(count, [&](Index c) {
        if (cells.kinds[c] == Kind::kUnknown) {
            const std::array<Index, 4>& v = t.vertices[c];
            const auto sphere = kernel::circumsphere(t.point(v[0]), t.point(v[1]), t.point(v[2]), t.point(v[3]), limit);
            cells.centers[c] = sphere.center;
            cells.radii[c] = sphere.radius;
        }
    });

    const std::vector<Index> hints = cells_of_balls(complex, balls);
    std::vector<Index> component;
    for (Index first = 0; first < count; ++first) {
        if (cells.kinds[first] != Kind::kUnknown) {
            continue;
        }
        // Taken for inside until its largest cell has been asked: most components are.
        component.assign(1, first);
        cells.kinds[first] = Kind::kInside;
        Index largest = first;
        for (std::size_t next = 0; next < component.size(); ++next) {
            const Index cell = component[next];
            largest = cells.radii[cell] > cells.radii[largest] ? cell : largest;
            for (int k = 0; k < 4; ++k) {
                const Index neighbor = t.neighbors[cell][k];
                if (neighbor != kNone && cells.kinds[neighbor] == Kind::kUnknown && (cells.walls[cell] >> k & 1) == 0) {
                    cells.kinds[neighbor] = Kind::kInside;
                    component.push_back(neighbor);
                }
            }
        }
        bool is_inside = std::isfinite(cells.radii[largest]);
        if (is_inside) {
            const Index ball = vertices.balls[t.vertices[largest][0]][0];
            const Index at = kernel::locate(complex.triangulation, cells.centers[largest], hints[ball]);
            is_inside = at != kNone && complex.has_cell[at] != 0;
        }
        if (!is_inside) {
            for (const Index cell : component) {
                cells.kinds[cell] = Kind::kOutside;
            }
        }
    }
}

// Polygons of the diagram as they are found, part by part.
struct Found {
    IndexLists polygons;
    std::vector<std::array<Index, 2>> contacts;
    std::vector<std::array<Index, 2>> edges;
    bool is_consistent = true;
};

void append(Found& all, const Found& part) {
    const auto shift = static_cast<Index>(all.polygons.items.size());
    kernel::append(all.polygons.items, part.polygons.items);
    for (std::size_t i = 1; i < part.polygons.offsets.size(); ++i) {
        all.polygons.offsets.push_back(part.polygons.offsets[i] + shift);
    }
    kernel::append(all.contacts, part.contacts);
    kernel::append(all.edges, part.edges);
    all.is_consistent = all.is_consistent && part.is_consistent;
}

class PolygonFinder {
   public:
    PolygonFinder(const LabelledCells& cells, const BoundaryVertices& vertices, std::span<const Ball> balls)
        : cells_(cells), vertices_(vertices), balls_(balls) {}

    // The polygon dual to the edge at two positions of a cell, if the cell is the first one around it that has a centre
    // inside the union.
    void find(Index cell, const std::array<int, 4>& positions, Found& found) const {
        const Triangulation& t = cells_.triangulation;
        thread_local std::vector<kernel::AroundEdge> around;  // without flat cells
        around.clear();
        const kernel::AroundEdge start{cell, positions[2], positions[3]};
        kernel::AroundEdge at = start;
        do {
            if (cells_.kinds[at.cell] != Kind::kFlat) {
                around.push_back(at);
            }
            at = kernel::next_around_edge(t, at);
            if (at.cell < cell && has_center(at.cell)) {
                return;
            }
        } while (at.cell != cell);

        const Index a = t.vertices[cell][positions[0]];
        const Index b = t.vertices[cell][positions[1]];
        SharedBalls shared(vertices_.balls[a]);
        shared.keep(vertices_.balls[b]);
        if (shared.count == 3) {
            return;  // the polygon is the triangle of the three centres, which the dual complex has
        }

        thread_local std::vector<Index> polygon;
        polygon.clear();
        for (std::size_t k = 0; k < around.size(); ++k) {
            push(polygon, center_of(around[k].cell));
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
            found.polygons.push_back(polygon);
            found.contacts.push_back({a, b});
        } else if (polygon.size() == 2) {
            found.edges.push_back({polygon[0], polygon[1]});
        }
    }

   private:
    static constexpr Index kOutsideCenter = -1;

    bool has_center(Index cell) const {
        return cells_.kinds[cell] == Kind::kInside || cells_.kinds[cell] == Kind::kBall;
    }

    Index center_of_ball(Index ball) const { return static_cast<Index>(cells_.triangulation.size()) + ball; }

    Index center_of(Index cell) const {
        switch (cells_.kinds[cell]) {
            case Kind::kInside:
                return cell;
            case Kind::kBall:
                return center_of_ball(cells_.balls[cell]);
            default:
                return kOutsideCenter;
        }
    }

    static void push(std::vector<Index>& polygon, Index center) {
        if (polygon.empty() || polygon.back() != center) {
            polygon.push_back(center);
        }
    }

    // A Voronoi edge passes through the centre of a ball that its three boundary vertices share. If neither end is this
    // centre, it lies in the middle of the edge. `shared`: the balls of two of the three.
    void push_walls(std::vector<Index>& polygon, SharedBalls shared, const kernel::AroundEdge& from, Index to) const {
        shared.keep(vertices_.balls[cells_.triangulation.vertices[from.cell][from.apex]]);
        std::array<Index, 2> middle{};
        int count = 0;
        for (int i = 0; i < shared.count && count < 2; ++i) {
            if (shared.balls[i] != cells_.balls[from.cell] && shared.balls[i] != cells_.balls[to]) {
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
            push(polygon, center_of_ball(middle[i]));
        }
    }

    // Points into the cell.
    Point facet_normal(Index cell, int k) const {
        const Triangulation& t = cells_.triangulation;
        const std::array<Index, 4>& v = t.vertices[cell];
        const Point p = t.point(v[kFacetOfCell[k][0]]);
        return cross(t.point(v[kFacetOfCell[k][1]]) - p, t.point(v[kFacetOfCell[k][2]]) - p);
    }

    // Removes the marks of outside cells and returns in how many runs they stood; the first entry is none of them.
    static int drop_outside(std::vector<Index>& polygon) {
        const auto runs = std::count(polygon.begin(), polygon.end(), kOutsideCenter);
        if (runs > 0) {
            std::erase(polygon, kOutsideCenter);
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

BoundaryVertices boundary_vertices(const DualComplex& complex, std::span<const Ball> balls) {
    struct Side {
        Index cell;
        int facet;
        bool is_second;  // of a triangle with two boundary vertices
    };
    const Triangulation& t = complex.triangulation;
    const auto sides =
        kernel::collect<std::vector<Side>>(static_cast<Index>(t.size()), [&](Index cell, std::vector<Side>& out) {
            for (int k = 0; k < 4; ++k) {
                const Index neighbor = t.neighbors[cell][k];
                if ((complex.facets[cell] >> k & 1) == 0 || neighbor < cell) {
                    continue;
                }
                const auto& back = t.neighbors[neighbor];
                const int mirror = static_cast<int>(std::find(back.begin(), back.end(), cell) - back.begin());
                const bool is_free_here = complex.has_cell[cell] == 0;
                const bool is_free_there = complex.has_cell[neighbor] == 0;
                if (is_free_here) {
                    out.push_back({cell, k, false});
                }
                if (is_free_there) {
                    out.push_back({neighbor, mirror, is_free_here});
                }
            }
        });

    BoundaryVertices vertices;
    vertices.points.resize(sides.size());
    vertices.balls.resize(sides.size());
    kernel::for_each_index(sides.size(), [&](std::size_t i) {
        const auto& cell = t.vertices[sides[i].cell];
        const auto& positions = kFacetOfCell[sides[i].facet];
        const std::array<Index, 3> facet{cell[positions[0]], cell[positions[1]], cell[positions[2]]};
        const Ball& p = balls[facet[0]];
        const Ball& q = balls[facet[1]];
        const Ball& r = balls[facet[2]];
        const kernel::OrthogonalSphere sphere = kernel::orthogonal_sphere(p, q, r);
        const Point normal = cross(q.center - p.center, r.center - p.center);
        vertices.points[i] = sphere.center + (std::sqrt(std::max(0.0, -sphere.power)) / norm(normal)) * normal;
        vertices.balls[i] = facet;
        std::sort(vertices.balls[i].begin(), vertices.balls[i].end());
    });
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i].is_second) {
            vertices.pairs.push_back({static_cast<Index>(i) - 1, static_cast<Index>(i)});
        }
    }
    return vertices;
}

InnerVoronoi inner_voronoi(const BoundaryVertices& vertices, const DualComplex& complex, std::span<const Ball> balls) {
    LabelledCells cells;
    cells.triangulation = kernel::triangulate(vertices.points);
    label_by_names(cells, vertices);
    label_by_flooding(cells, vertices, complex, balls.size());

    const PolygonFinder finder(cells, vertices, balls);
    const auto count = static_cast<Index>(cells.triangulation.size());
    Found found = kernel::collect<Found>(count, [&](Index cell, Found& out) {
        if (cells.kinds[cell] == Kind::kInside || cells.kinds[cell] == Kind::kBall) {
            for (const std::array<int, 4>& positions : kernel::kEdgesOfCell) {
                finder.find(cell, positions, out);
            }
        }
    });

    InnerVoronoi result;
    result.cells = count;
    result.flat_cells = static_cast<Index>(std::count(cells.kinds.begin(), cells.kinds.end(), Kind::kFlat));
    result.inside_cells = static_cast<Index>(std::count_if(cells.kinds.begin(), cells.kinds.end(), [](Kind kind) {
        return kind == Kind::kInside || kind == Kind::kBall;
    }));
    result.centers = std::move(cells.centers);
    result.radii = std::move(cells.radii);
    result.polygons = std::move(found.polygons);
    result.contacts = std::move(found.contacts);
    result.edges = std::move(found.edges);
    result.is_consistent = found.is_consistent;
    return result;
}

}  // namespace scaleaxis
