// SPDX-License-Identifier: Apache-2.0
#include "render_draw.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "render_text.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::render {
namespace {

constexpr int kSupersampling = 3;
constexpr Color kInk{0.13F, 0.13F, 0.16F};
constexpr Color kPlainAxis{0.47F, 0.60F, 0.86F};
constexpr Color kPlainBalls{0.93F, 0.66F, 0.42F};
constexpr Color kPlainMesh{0.80F, 0.80F, 0.83F};
constexpr Color kGlass{0.46F, 0.55F, 0.68F};

Point normalized(const Point& v) {
    const double length = norm(v);
    return length > 0.0 ? (1.0 / length) * v : Point{};
}

/// Where points of space come to lie on a canvas.
struct View {
    Camera camera;
    Point center;  ///< what the middle of the free part of the tile shows, in coordinates of the camera
    double scale = 1.0;
    double middle_x = 0.0;
    double middle_y = 0.0;

    Corner operator()(const Point& p, const Color& color = kInk) const {
        return {middle_x + scale * (dot(p, camera.right) - center.x), middle_y - scale * (dot(p, camera.up) - center.y),
                scale * (dot(p, camera.to_viewer) - center.z), color};
    }
    /// The normal in coordinates of the picture, turned to the viewer: faces have two good sides.
    Point turned(const Point& normal) const {
        const Point n{dot(normal, camera.right), dot(normal, camera.up), dot(normal, camera.to_viewer)};
        return n.z < 0.0 ? -1.0 * n : n;
    }
};

/// Sizes of things that do not grow with the scene, in pixels of the canvas.
struct Pen {
    double unit;  ///< one pixel of a tile of 800
    double curve;
    double thin;
    double text;
    double margin;
};

Pen pen_of(const Style& style) {
    const double unit = kSupersampling * std::clamp(std::min(style.width, style.height) / 800.0, 0.4, 4.0);
    return {unit, 0.5 * style.line_width * unit, std::max(0.55 * unit, 0.35 * kSupersampling),
            std::max(15.0 * unit, 7.0 * kSupersampling), 24.0 * unit};
}

View view_of(const Tile& tile, const Camera& camera, const Style& style, const Pen& pen) {
    const Extent& e = tile.extent;
    const double width = kSupersampling * style.width;
    const double height = kSupersampling * style.height;
    const double label = style.has_labels ? 2.0 * pen.text : 0.0;
    const double free_width = std::max(width - 2.0 * pen.margin, 1.0);
    const double free_height = std::max(height - label - 2.0 * pen.margin, 1.0);
    const double scale = std::min(free_width / (e.max_x - e.min_x), free_height / (e.max_y - e.min_y));
    return {camera,
            {0.5 * (e.min_x + e.max_x), 0.5 * (e.min_y + e.max_y), dot(tile.scene.vertices[0], camera.to_viewer)},
            // A single point has no size; any scale shows it.
            std::isfinite(scale) ? scale : 1.0,
            0.5 * width,
            0.5 * (height - label)};
}

/// Newell's normal: right for planar polygons, and of some use for others. Not of unit length, but twice the area.
Point polygon_normal(const Scene& scene, std::span<const Index> polygon) {
    Point normal;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
        const Point& origin = scene.vertices[polygon[0]];
        normal = normal + cross(scene.vertices[polygon[k]] - origin, scene.vertices[polygon[k + 1]] - origin);
    }
    return normal;
}

/// Calls `action(a, b, c)` for the triangles of a convex polygon's fan: positions in the polygon.
template <typename Action>
void for_each_triangle(std::span<const Index> polygon, Action action) {
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) action(std::size_t{0}, k, k + 1);
}

/// Draws a convex polygon; `color(k)` is the colour of its corner `k`.
template <typename ColorOf>
void fill_polygon(Canvas& canvas, const View& view, const Scene& scene, std::span<const Index> polygon, ColorOf color) {
    const auto corner = [&](std::size_t k) { return view(scene.vertices[polygon[k]], color(k)); };
    for_each_triangle(polygon, [&](std::size_t a, std::size_t b, std::size_t c) {
        fill_triangle(canvas, corner(a), corner(b), corner(c));
    });
}

/// A corner whose colour a value on the scale 0…1 decides.
struct ValuedCorner {
    Corner corner;
    double value = 0.0;
};

/// Draws a triangle in the colours of the values between those of its corners. The colours between two colours of the
/// scale are not those of the scale: where the corners differ by much, the triangle is split.
void fill_by_value(Canvas& canvas, const ValuedCorner& a, const ValuedCorner& b, const ValuedCorner& c, float light) {
    constexpr double kStep = 1.0 / 16.0;
    const double ab = std::abs(a.value - b.value);
    const double bc = std::abs(b.value - c.value);
    const double ca = std::abs(c.value - a.value);
    // The two other cases are this one with the corners turned.
    if (bc > ab && bc >= ca) return fill_by_value(canvas, b, c, a, light);
    if (ca > ab) return fill_by_value(canvas, c, a, b, light);
    if (ab > kStep) {
        const Corner& p = a.corner;
        const Corner& q = b.corner;
        const ValuedCorner middle{{0.5 * (p.x + q.x), 0.5 * (p.y + q.y), 0.5 * (p.z + q.z), {}},
                                  0.5 * (a.value + b.value)};
        fill_by_value(canvas, a, middle, c, light);
        fill_by_value(canvas, middle, b, c, light);
        return;
    }
    const auto colored = [&](const ValuedCorner& v) {
        return Corner{v.corner.x, v.corner.y, v.corner.z, light * viridis(v.value)};
    };
    fill_triangle(canvas, colored(a), colored(b), colored(c));
}

/// For each corner of each face the normal of the surface there: the mean over the faces around the vertex that meet
/// this one smoothly. In the order of `scene.faces.items`.
std::vector<Point> smooth_normals(const Scene& scene) {
    constexpr double kCosOfCrease = 0.77;  // 40 degrees
    const IndexLists& faces = scene.faces;
    std::vector<Point> normals;
    for (std::size_t f = 0; f < faces.size(); ++f) normals.push_back(polygon_normal(scene, faces[f]));

    // The faces around vertex v: around[first[v]] … around[first[v + 1] - 1].
    std::vector<Index> first(scene.vertices.size() + 1, 0);
    for (const Index v : faces.items) ++first[v + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Index> around(faces.items.size());
    std::vector<Index> next(first.begin(), first.end() - 1);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        for (const Index v : faces[f]) around[next[v]++] = static_cast<Index>(f);
    }

    std::vector<Point> result;
    result.reserve(faces.items.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        for (const Index v : faces[f]) {
            Point sum;
            for (Index i = first[v]; i < first[v + 1]; ++i) {
                const Point& other = normals[around[i]];
                if (dot(normals[f], other) >= kCosOfCrease * norm(normals[f]) * norm(other)) sum = sum + other;
            }
            result.push_back(normalized(sum));
        }
    }
    return result;
}

void draw_mesh(Canvas& canvas, const View& view, const Scene& scene) {
    const std::vector<Point> normals = smooth_normals(scene);
    for (std::size_t f = 0; f < scene.faces.size(); ++f) {
        const Point* normal = &normals[scene.faces.offsets[f]];
        fill_polygon(canvas, view, scene, scene.faces[f],
                     [&](std::size_t k) { return brightness(view.turned(normal[k])) * kPlainMesh; });
    }
}

/// Lays the mesh over the canvas as a glass body: clear where it faces the viewer, tinted at its outline.
void draw_glass(Canvas& canvas, const View& view, const Scene& scene) {
    Canvas glass(canvas.image.width, canvas.image.height);
    const std::vector<Point> normals = smooth_normals(scene);
    for (std::size_t f = 0; f < scene.faces.size(); ++f) {
        const Point* normal = &normals[scene.faces.offsets[f]];
        fill_polygon(glass, view, scene, scene.faces[f], [&](std::size_t k) {
            const double slope = 1.0 - view.turned(normal[k]).z;
            return mix(kWhite, kGlass, static_cast<float>(0.10 + 0.55 * slope * slope));
        });
    }
    lay_over(canvas, glass);
}

void draw_balls(Canvas& canvas, const View& view, const Tile& tile, Coloring coloring) {
    const Scene& scene = tile.scene;
    std::vector<Sphere> spheres;
    for (std::size_t b = 0; b < scene.vertices.size(); ++b) {
        const Color color =
            coloring == Coloring::Radius ? viridis(on_scale(scene.radii[b], tile.largest_radius)) : kPlainBalls;
        spheres.push_back({view(scene.vertices[b], color), view.scale * scene.radii[b]});
    }
    fill_spheres(canvas, std::move(spheres));
}

/// An edge of the complex and the faces at it.
struct Side {
    std::array<Index, 2> ends;
    Index face;  ///< `kNone`: the file lists the edge
};

/// All sides of all faces and all listed edges, those of one edge next to each other, the listed one first.
std::vector<Side> sorted_sides(const Scene& scene) {
    std::vector<Side> sides;
    sides.reserve(scene.edges.size() + scene.faces.items.size());
    const auto add = [&](Index a, Index b, Index face) { sides.push_back({{std::min(a, b), std::max(a, b)}, face}); };
    for (const auto& [a, b] : scene.edges) add(a, b, kNone);
    for (std::size_t f = 0; f < scene.faces.size(); ++f) {
        const auto polygon = scene.faces[f];
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            add(polygon[k], polygon[(k + 1) % polygon.size()], static_cast<Index>(f));
        }
    }
    std::ranges::sort(sides, {}, [](const Side& side) { return std::tie(side.ends, side.face); });
    return sides;
}

/// Calls `action(ends, faces)` for each edge with the sides that are faces'.
template <typename Action>
void for_each_edge(std::span<const Side> sides, Action action) {
    for (std::size_t begin = 0; begin < sides.size();) {
        std::size_t end = begin;
        while (end < sides.size() && sides[end].ends == sides[begin].ends) ++end;
        std::size_t first_face = begin;
        while (first_face < end && sides[first_face].face == kNone) ++first_face;
        action(sides[begin].ends, sides.subspan(first_face, end - first_face));
        begin = end;
    }
}

void draw_axis(Canvas& canvas, const View& view, const Tile& tile, const Style& style, const Pen& pen) {
    const Scene& scene = tile.scene;
    const std::vector<Side> sides = sorted_sides(scene);
    const auto radius_color = [&](Index v) { return viridis(on_scale(scene.radii[v], tile.largest_radius)); };
    const auto face_color = [&](Index f) {
        if (style.coloring == Coloring::Sheet) return sheet_color(scene.face_sheets[f]);
        if (style.coloring == Coloring::Angle) return viridis(on_scale(scene.face_angles[f], 90.0));
        if (style.coloring == Coloring::Label) return sheet_color(scene.labels[scene.faces[f].front()]);
        return kPlainAxis;
    };
    const auto surface_color = [&](Index f, Index v) {
        return style.coloring == Coloring::Radius ? radius_color(v) : face_color(f);
    };
    for (std::size_t f = 0; f < scene.faces.size(); ++f) {
        const auto polygon = scene.faces[f];
        const float light = brightness(view.turned(normalized(polygon_normal(scene, polygon))));
        if (style.coloring == Coloring::Radius) {
            const auto corner = [&](std::size_t k) {
                return ValuedCorner{view(scene.vertices[polygon[k]]),
                                    on_scale(scene.radii[polygon[k]], tile.largest_radius)};
            };
            for_each_triangle(polygon, [&](std::size_t a, std::size_t b, std::size_t c) {
                fill_by_value(canvas, corner(a), corner(b), corner(c), light);
            });
        } else {
            const Color color = light * face_color(static_cast<Index>(f));
            fill_polygon(canvas, view, scene, polygon, [&](std::size_t) { return color; });
        }
    }
    darken_creases(canvas, static_cast<int>(10.0 * pen.unit), 0.6F);

    // Lines stand a little before the faces that they bound.
    const auto line = [&](const std::array<Index, 2>& ends, const std::array<Color, 2>& colors, double half_width,
                          double lift) {
        Corner from = view(scene.vertices[ends[0]], colors[0]);
        Corner to = view(scene.vertices[ends[1]], colors[1]);
        from.z += lift * pen.unit;
        to.z += lift * pen.unit;
        fill_segment(canvas, from, to, half_width);
    };
    std::vector<bool> is_used(scene.vertices.size(), false);
    for_each_edge(sides, [&](const std::array<Index, 2>& ends, std::span<const Side> faces) {
        is_used[ends[0]] = is_used[ends[1]] = true;
        if (faces.empty()) {
            const bool has_core = style.coloring == Coloring::Radius;
            line(ends, {kInk, kInk}, (has_core ? 1.3 : 1.0) * pen.curve, 1.5);
            if (has_core) line(ends, {radius_color(ends[0]), radius_color(ends[1])}, 0.8 * pen.curve, 6.0);
        } else if (faces.size() == 1) {
            // Without its border, a strip that is narrower than a pixel would fall apart into dots.
            const Index f = faces[0].face;
            line(ends, {0.6F * surface_color(f, ends[0]), 0.6F * surface_color(f, ends[1])}, pen.thin, 1.0);
        } else if (faces.size() > 2 && style.has_seams) {
            const Index f = faces[0].face;
            line(ends, {0.42F * surface_color(f, ends[0]), 0.42F * surface_color(f, ends[1])}, pen.thin, 1.0);
        }
    });
    std::vector<Sphere> dots;
    for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
        if (is_used[v]) continue;
        const Color color = style.coloring == Coloring::Radius ? radius_color(static_cast<Index>(v)) : kInk;
        dots.push_back({view(scene.vertices[v], color), 2.5 * pen.curve});
    }
    fill_spheres(canvas, std::move(dots));
}

std::string short_number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g", value);
    return text.data();
}

/// The part of `text` that fits into `width`: its end, which tells files of one folder apart best.
std::string fitting(std::string text, double height, double width) {
    if (text_width(text, height) <= width) return text;
    while (!text.empty() && text_width("..." + text, height) > width) text.erase(0, 1);
    return "..." + text;
}

/// The label in the middle of the lower edge, or at its left with the scale of the colours at the right.
void draw_captions(Canvas& canvas, const Tile& tile, const Style& style, const Pen& pen) {
    // Before everything that a scene can hold.
    constexpr double kFront = 1e9;
    const double baseline = canvas.image.height - pen.text;
    const bool has_scale =
        tile.scene.kind != Kind::Mesh && (style.coloring == Coloring::Radius || style.coloring == Coloring::Angle);
    double free_width = canvas.image.width - 2.0 * pen.margin;
    if (has_scale) {
        const std::string end = style.coloring == Coloring::Radius ? short_number(tile.largest_radius) : "90";
        const double right = canvas.image.width - pen.margin - text_width(end, 0.8 * pen.text);
        const double bar_right = right - 0.5 * pen.text;
        const double bar_left = bar_right - 7.0 * pen.text;
        const double left = bar_left - 0.5 * pen.text - text_width("0", 0.8 * pen.text);
        constexpr int kSteps = 64;
        for (int i = 0; i < kSteps; ++i) {
            const double x = bar_left + (bar_right - bar_left) * i / kSteps;
            const double next = bar_left + (bar_right - bar_left) * (i + 1) / kSteps;
            const Color color = viridis((i + 0.5) / kSteps);
            const double top = baseline - 0.8 * pen.text;
            fill_triangle(canvas, {x, top, kFront, color}, {next, top, kFront, color}, {x, baseline, kFront, color});
            fill_triangle(canvas, {next, top, kFront, color}, {next, baseline, kFront, color},
                          {x, baseline, kFront, color});
        }
        draw_text(canvas, "0", {left, baseline, kFront, kInk}, 0.8 * pen.text);
        draw_text(canvas, end, {right, baseline, kFront, kInk}, 0.8 * pen.text);
        free_width = left - pen.text - pen.margin;
    }
    const std::string label = fitting(tile.label, pen.text, free_width);
    const double space = has_scale ? 0.0 : 0.5 * (free_width - text_width(label, pen.text));
    draw_text(canvas, label, {pen.margin + space, baseline, kFront, kInk}, pen.text);
}

}  // namespace

Camera camera_from(const Point& from, const Point& up) {
    const Point to_viewer = normalized(from);
    Point right = cross(up, to_viewer);
    // Looking along `up`, any other direction may be upwards.
    if (norm(right) < 1e-6 * norm(up)) right = cross(up.y == 0.0 ? Point{0, 1, 0} : Point{0, 0, -1}, to_viewer);
    right = normalized(right);
    return {right, cross(to_viewer, right), to_viewer};
}

void Extent::extend(const Extent& other) {
    min_x = std::min(min_x, other.min_x);
    min_y = std::min(min_y, other.min_y);
    max_x = std::max(max_x, other.max_x);
    max_y = std::max(max_y, other.max_y);
}

Extent extent_of(const Scene& scene, const Camera& camera) {
    Extent extent;
    for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
        const double radius = scene.kind == Kind::Balls ? scene.radii[v] : 0.0;
        const double x = dot(scene.vertices[v], camera.right);
        const double y = dot(scene.vertices[v], camera.up);
        extent.extend({x - radius, y - radius, x + radius, y + radius});
    }
    return extent;
}

Image draw_tile(const Tile& tile, const Camera& camera, const Style& style) {
    if (style.coloring == Coloring::Angle && tile.scene.kind == Kind::Axis && tile.scene.face_angles.empty() &&
        !tile.scene.faces.empty()) {
        throw InvalidOption(tile.label + ": the file has no angles; choose another --color");
    }
    if (style.coloring == Coloring::Label && tile.scene.kind == Kind::Axis && tile.scene.labels.empty()) {
        throw InvalidOption(tile.label + ": the file has no labels; choose another --color");
    }
    Canvas canvas(kSupersampling * style.width, kSupersampling * style.height);
    const Pen pen = pen_of(style);
    const View view = view_of(tile, camera, style, pen);
    switch (tile.scene.kind) {
        case Kind::Axis:
            draw_axis(canvas, view, tile, style, pen);
            break;
        case Kind::Balls:
            draw_balls(canvas, view, tile, style.coloring);
            break;
        case Kind::Mesh:
            draw_mesh(canvas, view, tile.scene);
            break;
    }
    if (tile.shape) draw_glass(canvas, view, *tile.shape);
    if (style.has_labels) draw_captions(canvas, tile, style, pen);
    return reduced(canvas.image, kSupersampling);
}

}  // namespace scaleaxis::render
