// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/midsurface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <queue>
#include <span>
#include <string_view>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/collapse.hpp"
#include "axis/edit/remainder.hpp"
#include "axis/edit/slivers.hpp"
#include "axis/edit/triangulated.hpp"
#include "axis/envelope_data.hpp"
#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/shrinking.hpp"
#include "solid/mesh/repair/orientation.hpp"
#include "solid/mesh/triangle_edges.hpp"
#include "spatial/mesh_parts.hpp"
#include "spatial/point_tree.hpp"
#include "uses/ascent.hpp"
#include "uses/boundary_ahead.hpp"
#include "uses/uphill.hpp"
#include "uses/wide_parts.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kMidsurfaceStage = "midsurface";

using Flags = std::vector<std::uint8_t>;

double length_of(const MedialComplex& complex, Index e) {
    return distance(complex.vertices[complex.edges[e][0]], complex.vertices[complex.edges[e][1]]);
}

// Faces between two opposite sides.
Flags between_sides(const MedialComplex& complex, double angle) {
    Flags result(complex.faces.size());
    const std::vector<std::uint8_t> is_steep = steep_vertices(complex, complex.edges, cosine_of_degrees(angle));
    for_each_index(result.size(), [&](std::size_t f) {
        const bool is_flat = std::ranges::none_of(complex.faces[f], [&](Index v) { return is_steep[v] != 0; });
        result[f] = complex.face_angles[f] >= angle && is_flat ? 1 : 0;
    });
    return result;
}

// Vertices of the border from which balls of the solid grow as in an edge go to where they no longer do, unless the
// surface becomes larger: where the axis is as coarse as the wall is thick, a face may lie across the seam, and have an
// angle between those of both sheets.
MedialComplex without_slopes(MedialComplex walls, double angle, const Solid& solid) {
    const std::vector<std::uint8_t> is_on_border = vertices_at_borders(walls);
    const IndexLists faces_at = faces_at_vertices(walls);
    const auto balls = mapped<Ball>(
        walls.vertices.size(),
        [&](std::size_t v) {
            const Ball ball = ball_at(walls, static_cast<Index>(v));
            return is_on_border[v] != 0 && ball.radius > 0.0 ? uphill(solid, ball, cosine_of_degrees(angle)) : ball;
        },
        std::size_t{16});
    const auto area_at = [&](Index v) {
        double area = 0.0;
        std::ranges::for_each(faces_at[v], [&](Index f) { area += face_area(walls, f); });
        return area;
    };
    for (Index v = 0; v < static_cast<Index>(balls.size()); ++v) {
        if (walls.radii[v] < (1.0 - kRadiusError) * balls[v].radius) {
            const double before = area_at(v);
            const Point place = std::exchange(walls.vertices[v], balls[v].center);
            if (area_at(v) > before) {
                walls.vertices[v] = place;
            } else {
                walls.radii[v] = balls[v].radius;
            }
        }
    }
    return walls;
}

// The faces with their edges and vertices; sheets are found anew.
MedialComplex part(const MedialComplex& complex, const Flags& keeps_face) {
    Flags keeps_edge(complex.edges.size());
    Flags keeps_vertex(complex.vertices.size());
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (keeps_face[f] != 0) {
            std::ranges::for_each(complex.face_edges[f], [&](Index e) { keeps_edge[e] = 1; });
            std::ranges::for_each(complex.faces[f], [&](Index v) { keeps_vertex[v] = 1; });
        }
    }
    MedialComplex result = subcomplex(complex, keeps_vertex, keeps_edge, keeps_face);
    label_sheets(result);
    return result;
}

// Of these faces those in parts of sheets that are wide enough.
Flags in_wide_parts(const MedialComplex& complex, const Flags& faces) {
    const IndexLists faces_at = faces_at_edges(complex);
    const SurfaceParts found = parts_of_faces(
        faces, [&](Index f) { return face_area(complex, f); },
        [&](Index f) { return mean_ball(complex, complex.faces[f]); },
        [&](Index f, const auto& use) {
            for (const Index e : complex.face_edges[f]) {
                const std::span<const Index> at = faces_at[e];
                const auto& [from, to] = complex.edges[e];
                use(at.size() == 2 ? at[at[0] == f ? 1 : 0] : kNone, complex.vertices[from], complex.vertices[to]);
            }
        });
    Flags keeps(complex.faces.size());
    for (std::size_t f = 0; f < keeps.size(); ++f) {
        if (found.numbers[f] != kNone) {
            const SurfacePart& part = found.parts[found.numbers[f]];
            const bool is_large = part.area * part.area * part.area >= 4.0 * part.weight * part.weight;
            keeps[f] = is_large && part.is_wide() ? 1 : 0;
        }
    }
    return keeps;
}

// The faces that belong to walls. Where walls meet, balls grow beyond the thickness of each: where a rib stands on a
// plate they roll off the two re-entrant edges, which they see at a small angle. Such a face belongs to the wall
// towards which radii shrink from it; from a face that runs into a convex edge they shrink towards that edge. A
// watershed of the radius parts both (F. Meyer, "Un algorithme optimal pour la ligne de partage des eaux", 1991). From
// a wall balls grow towards junctions: it floods no face that has a smaller ball than its own. Sheets are flooded
// first; then walls flood what lies between seams alone.
Flags in_walls(const MedialComplex& complex, const Flags& is_core) {
    const auto count = static_cast<Index>(complex.faces.size());
    const IndexLists at_edge = faces_at_edges(complex);
    std::vector<double> radii(complex.faces.size());
    const auto least_radius = [&](Index f) {
        return complex
            .radii[*std::ranges::min_element(complex.faces[f], {}, [&](Index v) { return complex.radii[v]; })];
    };
    // Whether the flood has crossed a seam, its level, the face that it enters, and the least radius of the face of a
    // wall that it comes from, if any.
    using Entry = std::tuple<bool, double, Index, double>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    for (Index f = 0; f < count; ++f) {
        radii[f] = mean_ball(complex, complex.faces[f]).radius;
        const auto is_outlet = [&](Index e) {
            return at_edge[e].size() == 1 && mean_ball(complex, complex.edges[e]).radius < radii[f];
        };
        if (is_core[f] != 0 || std::ranges::any_of(complex.face_edges[f], is_outlet)) {
            front.emplace(false, radii[f], f, is_core[f] != 0 ? least_radius(f) : 0.0);
        }
    }
    Flags is_flooded(is_core);
    Flags result(is_core);
    while (!front.empty()) {
        const auto [has_crossed, level, f, wall] = front.top();
        front.pop();
        if (is_flooded[f] != 0 && is_core[f] == 0) {
            continue;
        }
        is_flooded[f] = 1;
        result[f] = wall > 0.0 ? 1 : 0;
        for (const Index e : complex.face_edges[f]) {
            for (const Index neighbor : at_edge[e]) {
                const bool crosses = has_crossed || at_edge[e].size() > 2;
                const bool enters = wall > 0.0 ? least_radius(neighbor) >= (1.0 - kRadiusError) * wall : !crosses;
                if (is_flooded[neighbor] == 0 && enters) {
                    front.emplace(crosses, std::max(level, radii[neighbor]), neighbor, wall);
                }
            }
        }
    }
    return result;
}

// A few small faces at a convex edge may have a wrong angle. They have less area than the square of the largest radius
// of what runs into the edge around them.
Flags without_crumbs(const MedialComplex& complex, Flags walls) {
    const std::size_t count = walls.size();
    DisjointSets sheets(count);
    DisjointSets parts(count);  // of sheets
    const IndexLists faces_at = faces_at_edges(complex);
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (const std::span<const Index> faces = faces_at[e]; faces.size() == 2) {
            sheets.join(faces[0], faces[1]);
            if (walls[faces[0]] == walls[faces[1]]) {
                parts.join(faces[0], faces[1]);
            }
        }
    }
    std::vector<double> areas(count);
    std::vector<double> radii(count);  // of the sheets, outside walls
    for (Index f = 0; f < static_cast<Index>(count); ++f) {
        areas[parts.find(f)] += face_area(complex, f);
        if (walls[f] == 0) {
            double& radius = radii[sheets.find(f)];
            radius = std::max(radius, mean_ball(complex, complex.faces[f]).radius);
        }
    }
    for (Index f = 0; f < static_cast<Index>(count); ++f) {
        const double radius = radii[sheets.find(f)];
        walls[f] = walls[f] != 0 && areas[parts.find(f)] >= radius * radius ? 1 : 0;
    }
    return walls;
}

// An edge with one face, and the direction in which the sheet ends there.
struct BorderEdge {
    Index face = kNone;
    std::array<Index, 2> ends{kNone, kNone};  // as the face passes them
    double length = 0.0;
    Point outwards;
};

// A part of a sheet: its centroid, and a normal.
struct Patch {
    Point center;
    Point normal;
};

// The part of a sheet around one of its faces, up to a distance from a place. Single faces at a border may be so small
// that errors of their corners tilt them.
Patch patch_around(const MedialComplex& complex, const IndexLists& faces_at, Index face, const Point& place,
                   double reach) {
    std::vector<Index> next{face};  // a stack
    std::unordered_set<Index> passed{face};
    Point sum;
    Point normal;
    double area = 0.0;
    while (!next.empty()) {
        const Index f = next.back();
        next.pop_back();
        const Point part = area_vector(complex, f);
        const double part_area = norm(part);
        sum = sum + part_area * center_of_face(complex, f);
        normal = dot(part, normal) < 0.0 ? normal - part : normal + part;
        area += part_area;
        for (const Index e : complex.face_edges[f]) {
            for (const Index neighbor : faces_at[e]) {
                if (faces_at[e].size() == 2 && !passed.contains(neighbor) &&
                    distance(center_of_face(complex, neighbor), place) < reach) {
                    passed.insert(neighbor);
                    next.push_back(neighbor);
                }
            }
        }
    }
    return {area > 0.0 ? (1.0 / area) * sum : center_of_face(complex, face), unit(normal)};
}

std::vector<BorderEdge> border_of(const MedialComplex& complex) {
    std::vector<BorderEdge> border;
    const IndexLists faces_at = faces_at_edges(complex);
    for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
        if (faces_at[e].size() == 1) {
            const Index f = faces_at[e].front();
            const std::span<const Index> face = complex.faces[f];
            const auto k =
                static_cast<std::size_t>(std::ranges::find(complex.face_edges[f], e) - complex.face_edges[f].begin());
            border.push_back({f, {face[k], face[(k + 1) % face.size()]}, length_of(complex, e), {}});
        }
    }
    for_each_index(
        border.size(),
        [&](std::size_t b) {
            BorderEdge& edge = border[b];
            const auto& [start, end] = edge.ends;
            const Point middle = midpoint(complex.vertices[start], complex.vertices[end]);
            const Patch patch = patch_around(complex, faces_at, edge.face, middle,
                                             kNearby * std::max(complex.radii[start], complex.radii[end]));
            // Neither along the border nor out of the tangent plane: the centroid of a curved sheet lies beside it.
            const Point sideways = cross(complex.vertices[end] - complex.vertices[start], patch.normal);
            const Point outwards = (dot(sideways, middle - patch.center) < 0.0 ? -1.0 : 1.0) * sideways;
            edge.outwards = squared_norm(outwards) > 0.0 ? unit(outwards) : Point();
        },
        std::size_t{16});
    return border;
}

// The direction in which the surface goes on at a vertex of the border: the mean over the border up to a radius away,
// which faces of a ragged border do not turn. Around a corner directions fan out, so that the corner is filled.
class SideDirections {
   public:
    SideDirections(const MedialComplex& complex, std::span<const BorderEdge> border)
        : complex_(complex), border_(border), at_(complex.vertices.size()) {
        for (std::size_t b = 0; b < border.size(); ++b) {
            for (const Index v : border[b].ends) {
                at_[v].push_back(static_cast<Index>(b));
            }
        }
    }

    bool is_border(Index v) const { return !at_[v].empty(); }

    /// Zero if there is none.
    Point of(Index v) const {
        struct Step {
            Index vertex;
            double way;
        };
        const double reach = complex_.radii[v];
        std::vector<Step> steps{{v, 0.0}};
        std::vector<Index> passed;
        Point sum;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const Step step = steps[i];
            for (const Index b : at_[step.vertex]) {
                const BorderEdge& edge = border_[b];
                if (step.way >= reach || std::ranges::find(passed, b) != passed.end()) {
                    continue;
                }
                passed.push_back(b);
                const double covered = std::min(edge.length, reach - step.way);
                const double weight = covered * (1.0 - (step.way + 0.5 * covered) / reach);
                sum = sum + weight * edge.outwards;
                steps.push_back({edge.ends[edge.ends[0] == step.vertex ? 1 : 0], step.way + edge.length});
            }
        }
        return norm(sum) > 0.0 ? unit(sum) : Point();
    }

   private:
    const MedialComplex& complex_;
    std::span<const BorderEdge> border_;
    std::vector<std::vector<Index>> at_;
};

// Where sheets touch in a vertex of the border alone, each gets its own: otherwise all go on to the same place, and
// meet in a seam there.
MedialComplex with_sheets_apart(const MedialComplex& walls) {
    const IndexLists faces_at = faces_at_vertices(walls);
    MedialComplex result = vertices_of(walls);
    std::vector<std::vector<Index>> faces(walls.faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        faces[f].assign(walls.faces[f].begin(), walls.faces[f].end());
    }
    const std::vector<std::uint8_t> is_at_border = vertices_at_borders(walls);
    for (Index v = 0; v < static_cast<Index>(walls.vertices.size()); ++v) {
        if (is_at_border[v] == 0) {
            continue;
        }
        const std::span<const Index> at = faces_at[v];
        std::map<Index, Index> first_at;  // of the edges at the vertex, the first face
        DisjointSets fans(at.size());
        for (std::size_t i = 0; i < at.size(); ++i) {
            for (const Index e : walls.face_edges[at[i]]) {
                if (walls.edges[e][0] == v || walls.edges[e][1] == v) {
                    fans.join(first_at.try_emplace(e, static_cast<Index>(i)).first->second, static_cast<Index>(i));
                }
            }
        }
        std::map<Index, Index> vertex_of;  // of fans
        for (std::size_t i = 0; i < at.size(); ++i) {
            const auto [entry, is_new] = vertex_of.try_emplace(fans.find(static_cast<Index>(i)), v);
            if (is_new && i > 0) {
                entry->second = add_vertex(result, ball_at(walls, v), walls.vertex_origins[v]);
            }
            std::ranges::replace(faces[at[i]], v, entry->second);
        }
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
        add_face(result, faces[f], values_of(walls, static_cast<Index>(f)));
    }
    build_edges(result, {});
    return result;
}

// How far a border may go on before it is nearer to one that comes towards it: across a neck narrower than the wall is
// thick, which has no sheet between its sides. There two borders meet halfway.
double way_to_opposite_border(Index v, std::span<const Point> directions, std::span<const Point> places,
                              const PointTree& border, std::span<const Index> at, double way) {
    double result = way;
    for_each_point_near(border, places[v], 2.0 * way, [&](Index position, double squared) {
        const Index w = at[border.order[position]];
        const double ahead = dot(directions[v], places[w] - places[v]);
        if (ahead > 0.0 && dot(directions[v], directions[w]) < 0.0) {
            result = std::min(result, 0.5 * squared / ahead);
        }
    });
    return result;
}

// Strips of triangles from the border to the boundary of the solid.
void extend(Midsurface& surface, const MedialComplex& complex, const DistanceInside& distance) {
    const std::vector<BorderEdge> border = border_of(complex);
    const SideDirections sides(complex, border);
    std::vector<Index> at;
    for (Index v = 0; v < static_cast<Index>(complex.vertices.size()); ++v) {
        if (sides.is_border(v) && complex.radii[v] > 0.0) {
            at.push_back(v);
        }
    }
    if (at.empty()) {
        return;
    }
    std::vector<Point> directions(complex.vertices.size());
    for_each_index(
        at.size(), [&](std::size_t i) { directions[at[i]] = sides.of(at[i]); }, std::size_t{16});
    const PointTree tree = build_point_tree(each_of<Point>(at, [&](Index v) { return complex.vertices[v]; }));
    std::vector<Point> ends(complex.vertices);
    for_each_index(
        at.size(),
        [&](std::size_t i) {
            const Index v = at[i];
            if (directions[v] != Point()) {
                const double way = way_to_boundary(ends[v], directions[v], complex.radii[v], distance).value_or(0.0);
                ends[v] =
                    ends[v] + way_to_opposite_border(v, directions, complex.vertices, tree, at, std::max(way, 0.0)) *
                                  directions[v];
            }
        },
        std::size_t{16});
    std::vector<Index> ahead(complex.vertices.size());
    for (std::size_t v = 0; v < ends.size(); ++v) {
        ahead[v] = static_cast<Index>(v);
        if (ends[v] != complex.vertices[v]) {
            ahead[v] = static_cast<Index>(surface.mesh.vertices.size());
            surface.mesh.vertices.push_back(ends[v]);
            surface.thickness.push_back(2.0 * complex.radii[v]);
        }
    }
    const auto add = [&](Index a, Index b, Index c, Index face) {
        if (a != b && b != c && c != a) {
            surface.mesh.triangles.push_back({a, b, c});
            surface.triangle_sheets.push_back(complex.face_sheets[face]);
        }
    };
    for (const BorderEdge& edge : border) {
        const auto& [a, b] = edge.ends;
        if (squared_distance(complex.vertices[a], ends[b]) < squared_distance(complex.vertices[b], ends[a])) {
            add(b, a, ahead[b], edge.face);
            add(a, ahead[a], ahead[b], edge.face);
        } else {
            add(b, a, ahead[a], edge.face);
            add(b, ahead[a], ahead[b], edge.face);
        }
    }
}

// Turns triangles so that each agrees with its neighbours in its sheet, whose first one stays.
void turn_to_agree(TriangleMesh& mesh) {
    const Orientation orientation =
        orient(mesh.triangles, opposite_sides(sides_of_edges(mesh.triangles, mesh.vertices.size())));
    std::vector<Index> first(static_cast<std::size_t>(orientation.components), kNone);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Index& stays = first[orientation.component[t]];
        stays = stays == kNone ? static_cast<Index>(t) : stays;
        if (orientation.is_reversed[t] != orientation.is_reversed[stays]) {
            reverse(mesh.triangles[t]);
        }
    }
}

void measure_sheets(Midsurface& surface, Index count) {
    surface.sheets.assign(static_cast<std::size_t>(count), {});
    const TriangleMesh& mesh = surface.mesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const auto [least, most] = std::minmax({surface.thickness[a], surface.thickness[b], surface.thickness[c]});
        MidsurfaceSheet& sheet = surface.sheets[surface.triangle_sheets[t]];
        const double area = triangle_area(mesh, mesh.triangles[t]);
        sheet.mean += area * (surface.thickness[a] + surface.thickness[b] + surface.thickness[c]) / 3.0;
        sheet.min = sheet.max == 0.0 ? least : std::min(sheet.min, least);
        sheet.max = std::max(sheet.max, most);
        sheet.area += area;
    }
    for (MidsurfaceSheet& sheet : surface.sheets) {
        sheet.mean = sheet.area > 0.0 ? sheet.mean / sheet.area : sheet.min;
    }
    const auto order = sorted_indices(
        surface.sheets.size(), [&](Index s) { return surface.sheets[s].area; }, std::greater<>());
    const std::vector<Index> numbers = places_in(order);
    surface.sheets = each_of<MidsurfaceSheet>(order, [&](Index s) { return surface.sheets[s]; });
    std::ranges::for_each(surface.triangle_sheets, [&](Index& s) { s = numbers[s]; });
}

void measure_edges(Midsurface& surface) {
    const TriangleMesh& mesh = surface.mesh;
    const IndexLists edges = sides_of_edges(mesh.triangles, mesh.vertices.size());
    std::vector<std::array<Index, 2>> seams;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const std::array<Index, 2> ends{start_of(mesh.triangles, edges[e][0]), end_of(mesh.triangles, edges[e][0])};
        const double length = distance(mesh.vertices[ends[0]], mesh.vertices[ends[1]]);
        if (edges[e].size() == 1) {
            surface.border_length += length;
        } else if (edges[e].size() > 2) {
            surface.seam_length += length;
            seams.push_back(ends);
        }
    }
    std::vector<std::vector<Index>> seams_at(mesh.vertices.size());
    for (std::size_t s = 0; s < seams.size(); ++s) {
        std::ranges::for_each(seams[s], [&](Index v) { seams_at[v].push_back(static_cast<Index>(s)); });
    }
    surface.seams = static_cast<Index>(seams.size());
    DisjointSets chains(seams.size());
    for (const std::vector<Index>& at : seams_at) {
        if (at.size() == 2 && chains.join(at[0], at[1])) {
            --surface.seams;
        }
    }
}

// Sheets smaller than a square of half a radius, as contractions leave them beside seams, collapse from their border.
MedialComplex without_flaps(const MedialComplex& walls) {
    std::vector<double> areas(static_cast<std::size_t>(walls.sheets));
    std::vector<double> radii(static_cast<std::size_t>(walls.sheets));
    for (Index f = 0; f < static_cast<Index>(walls.faces.size()); ++f) {
        const Index sheet = walls.face_sheets[f];
        areas[sheet] += face_area(walls, f);
        radii[sheet] = std::max(radii[sheet], mean_ball(walls, walls.faces[f]).radius);
    }
    const auto is_flap = [&](const ElementaryCollapse& collapse) {
        const Index sheet = collapse.has_face ? walls.face_sheets[collapse.element] : kNone;
        return sheet == kNone || std::sqrt(areas[sheet]) < kNearby * radii[sheet];
    };
    return part(walls, after_collapses(walls, is_flap).has_face);
}

// The walls of a complex, with whole seams.
MedialComplex walls_of(const MedialComplex& complex, const Flags& cores) {
    // Where four sheets meet there are clusters of short seams and tiny faces, up to 0.05 radii long where δ is 0.7
    // radii: sheets that cross would stay joined at the ends of their seam.
    const auto with_whole_seams = [](const MedialComplex& walls) {
        MedialComplex result = without_short_edges_at_seams(walls, kRadiusError);
        const auto reaches = each_of<double>(result.radii, [](double radius) { return kNearby * radius; });
        return with_seams_to_borders(std::move(result), reaches, true);
    };
    const MedialComplex walls = with_whole_seams(part(complex, without_crumbs(complex, in_walls(complex, cores))));
    return without_flaps(with_whole_seams(without_slivers(walls, kInfinity)));
}

Midsurface midsurface_of(const MedialComplex& complex, const Solid* solid, const MidsurfaceOptions& options,
                         const DistanceInside& distance, const Execution& execution) {
    report(execution, kMidsurfaceStage, 0.0);
    const Flags cores = in_wide_parts(complex, between_sides(complex, options.angle));
    MedialComplex walls = walls_of(complex, cores);
    if (solid != nullptr) {
        walls = without_slopes(std::move(walls), options.angle, *solid);
    }
    if (options.extends) {
        walls = with_sheets_apart(walls);
    }
    report(execution, kMidsurfaceStage, 0.2);
    Midsurface surface;
    surface.mesh.vertices = walls.vertices;
    surface.thickness = each_of<double>(walls.radii, [](double radius) { return 2.0 * radius; });
    for (const FaceTriangle& triangle : face_triangles(walls)) {
        surface.mesh.triangles.push_back(triangle.corners);
        surface.triangle_sheets.push_back(walls.face_sheets[triangle.face]);
    }
    if (options.extends) {
        extend(surface, walls, distance);
    }
    report(execution, kMidsurfaceStage, 0.9);
    turn_to_agree(surface.mesh);
    measure_sheets(surface, walls.sheets);
    measure_edges(surface);
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        surface.left_out_area += face_area(complex, f);
    }
    for (Index f = 0; f < static_cast<Index>(walls.faces.size()); ++f) {
        surface.left_out_area -= face_area(walls, f);
    }
    surface.left_out_area = std::max(0.0, surface.left_out_area);
    const std::vector<std::array<Index, 2>> curves = curve_edges(complex);
    surface.left_out_curves = static_cast<Index>(curves.size());
    for (const auto& [a, b] : curves) {
        surface.left_out_length += norm(complex.vertices[b] - complex.vertices[a]);
    }
    report(execution, kMidsurfaceStage, 1.0);
    return surface;
}

void check_options(const MedialComplex& complex, const MidsurfaceOptions& options) {
    require(options.angle > 0.0 && options.angle <= 90.0,
            "the least object angle of a midsurface must be more than 0 and at most 90 degrees");
    check(complex);
    check_angles(complex);
}

}  // namespace

Midsurface midsurface(const MedialComplex& complex, const MidsurfaceOptions& options, const Execution& execution) {
    return in_arena(execution, [&] {
        check_options(complex, options);
        if (complex.faces.empty() || !options.extends) {
            return midsurface_of(complex, nullptr, options, {}, execution);
        }
        const EnvelopeData envelope(complex);
        return midsurface_of(
            complex, nullptr, options, [&](const Point& p) { return -envelope.signed_distance(p); }, execution);
    });
}

Midsurface midsurface(const MedialComplex& complex, const Solid& solid, const MidsurfaceOptions& options,
                      const Execution& execution) {
    if (!solid.knows_nearest()) {
        return midsurface(complex, options, execution);
    }
    return in_arena(execution, [&] {
        check_options(complex, options);
        return midsurface_of(complex, &solid, options, distance_inside(solid), execution);
    });
}

MedialComplex complex_of(const Midsurface& surface) {
    MedialComplex complex;
    complex.vertices = surface.mesh.vertices;
    complex.radii = each_of<double>(surface.thickness, [](double thickness) { return 0.5 * thickness; });
    complex.vertex_origins.resize(complex.vertices.size());
    complex = with_linear_radii(std::move(complex));
    for (const std::array<Index, 3>& triangle : surface.mesh.triangles) {
        complex.faces.push_back(triangle);
    }
    complex.face_angles.assign(complex.faces.size(), 0.0);
    complex.face_sheets = surface.triangle_sheets;
    complex.sheets = static_cast<Index>(surface.sheets.size());
    build_edges(complex, {});
    return complex;
}

}  // namespace scaleaxis::inline v1
