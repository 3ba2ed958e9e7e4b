// SPDX-License-Identifier: Apache-2.0
#include "render_canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace scaleaxis::render {
namespace {

constexpr float kFarAway = -std::numeric_limits<float>::infinity();

Pixel pixel_of(const Color& color) {
    const auto byte = [](float value) { return static_cast<std::uint8_t>(std::clamp(256.0F * value, 0.0F, 255.0F)); };
    return {byte(color.r), byte(color.g), byte(color.b)};
}

/// The pixels whose centres lie in [low, high], as a half-open range within [0, size).
struct Range {
    int begin = 0;
    int end = 0;
};

Range centers_between(double low, double high, int size) {
    // A little too wide: surfaces that share a border must not leave a gap between them.
    constexpr double kOverlap = 1e-6;
    const double limit = size;
    const int begin = static_cast<int>(std::clamp(std::ceil(low - 0.5 - kOverlap), 0.0, limit));
    const int end = static_cast<int>(std::clamp(std::floor(high - 0.5 + kOverlap) + 1.0, 0.0, limit));
    return {begin, std::max(begin, end)};
}

std::size_t row_start(const Canvas& canvas, int y) { return static_cast<std::size_t>(y) * canvas.image.width; }

/// A function of the plane that is linear: value(x, y) = at_origin + x dx + y dy.
struct Plane {
    double at_origin;
    double dx;
    double dy;

    double operator()(double x, double y) const { return at_origin + x * dx + y * dy; }
};

/// The part of a sphere in a rectangle of the canvas.
void fill_sphere_in(Canvas& canvas, const Sphere& sphere, const Range& rows, const Range& columns) {
    const auto& [center, radius] = sphere;
    for (int row = rows.begin; row < rows.end; ++row) {
        const double dy = row + 0.5 - center.y;
        for (int column = columns.begin; column < columns.end; ++column) {
            const double dx = column + 0.5 - center.x;
            const double squared_dz = radius * radius - dx * dx - dy * dy;
            if (squared_dz < 0.0) continue;
            const double dz = std::sqrt(squared_dz);
            const std::size_t at = row_start(canvas, row) + column;
            const auto depth = static_cast<float>(center.z + dz);
            if (depth <= canvas.depth[at]) continue;
            canvas.depth[at] = depth;
            const Point normal = (1.0 / radius) * Point{dx, -dy, dz};
            canvas.image.pixels[at] = pixel_of(brightness(normal) * center.color);
        }
    }
}

float farthest_in(const Canvas& canvas, const Range& rows, const Range& columns) {
    float farthest = -kFarAway;
    for (int row = rows.begin; row < rows.end; ++row) {
        const float* depth = &canvas.depth[row_start(canvas, row)];
        for (int column = columns.begin; column < columns.end; ++column) farthest = std::min(farthest, depth[column]);
    }
    return farthest;
}

}  // namespace

Canvas::Canvas(int width, int height)
    : image{width, height, std::vector<Pixel>(static_cast<std::size_t>(width) * height)},
      depth(image.pixels.size(), kFarAway) {}

void fill_triangle(Canvas& canvas, const Corner& a, const Corner& b, const Corner& c) {
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    // Seen from its edge: nothing to fill, and nothing to divide by.
    if (!(std::abs(area) > 1e-12)) return;
    // Barycentric coordinate of the corner `p`, which is zero on the line through `q` and `r`.
    const auto barycentric = [&](const Corner& q, const Corner& r) {
        const double dx = (q.y - r.y) / area;
        const double dy = (r.x - q.x) / area;
        return Plane{-(q.x * dx + q.y * dy), dx, dy};
    };
    const std::array<Plane, 3> weights{barycentric(b, c), barycentric(c, a), barycentric(a, b)};
    const auto interpolated = [&](double at_a, double at_b, double at_c) {
        const auto part = [&](double Plane::*member) {
            return at_a * weights[0].*member + at_b * weights[1].*member + at_c * weights[2].*member;
        };
        return Plane{part(&Plane::at_origin), part(&Plane::dx), part(&Plane::dy)};
    };
    // A triangle seen almost from its edge has a steep plane, which must not reach beyond its corners.
    const auto [nearest_z, farthest_z] = std::pair(std::max({a.z, b.z, c.z}), std::min({a.z, b.z, c.z}));
    const Plane z = interpolated(a.z, b.z, c.z);

    const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
    const auto [low_y, high_y] = std::minmax({a.y, b.y, c.y});
    const Range rows = centers_between(low_y, high_y, canvas.image.height);
    for (int row = rows.begin; row < rows.end; ++row) {
        const double y = row + 0.5;
        double low = low_x;
        double high = high_x;
        for (const Plane& weight : weights) {
            const double crossing = -weight(0.0, y) / weight.dx;
            if (weight.dx > 0.0) low = std::max(low, crossing);
            if (weight.dx < 0.0) high = std::min(high, crossing);
        }
        const Range columns = centers_between(low, high, canvas.image.width);
        for (int column = columns.begin; column < columns.end; ++column) {
            const double x = column + 0.5;
            const std::size_t at = row_start(canvas, row) + column;
            const auto depth = static_cast<float>(std::clamp(z(x, y), farthest_z, nearest_z));
            if (depth <= canvas.depth[at]) continue;
            canvas.depth[at] = depth;
            const auto share = [&](std::size_t corner) { return static_cast<float>(weights[corner](x, y)); };
            canvas.image.pixels[at] = pixel_of(share(0) * a.color + share(1) * b.color + share(2) * c.color);
        }
    }
}

void fill_segment(Canvas& canvas, const Corner& a, const Corner& b, double half_width) {
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double squared_length = dx * dx + dy * dy;
    const Range rows =
        centers_between(std::min(a.y, b.y) - half_width, std::max(a.y, b.y) + half_width, canvas.image.height);
    for (int row = rows.begin; row < rows.end; ++row) {
        const double y = row + 0.5;
        // Only the part of the segment whose rows are near enough can reach this row.
        double from = 0.0;
        double to = 1.0;
        if (dy != 0.0) {
            const auto [first, last] = std::minmax({(y - half_width - a.y) / dy, (y + half_width - a.y) / dy});
            from = std::clamp(first, 0.0, 1.0);
            to = std::clamp(last, 0.0, 1.0);
        }
        const auto [low, high] = std::minmax({a.x + from * dx, a.x + to * dx});
        const Range columns = centers_between(low - half_width, high + half_width, canvas.image.width);
        for (int column = columns.begin; column < columns.end; ++column) {
            const double px = column + 0.5 - a.x;
            const double py = y - a.y;
            const double t = squared_length > 0.0 ? std::clamp((px * dx + py * dy) / squared_length, 0.0, 1.0) : 0.0;
            const double rx = px - t * dx;
            const double ry = py - t * dy;
            if (rx * rx + ry * ry > half_width * half_width) continue;
            const std::size_t at = row_start(canvas, row) + column;
            const auto depth = static_cast<float>(a.z + t * (b.z - a.z));
            if (depth <= canvas.depth[at]) continue;
            canvas.depth[at] = depth;
            canvas.image.pixels[at] = pixel_of(mix(a.color, b.color, static_cast<float>(t)));
        }
    }
}

void fill_spheres(Canvas& canvas, std::vector<Sphere> spheres) {
    // The nearest first. Overlapping balls hide most of each other: a block of pixels that is all before a sphere is
    // not looked at any more.
    std::ranges::stable_sort(spheres, std::greater{}, [](const Sphere& s) { return s.center.z + s.radius; });
    constexpr int kBlock = 8;
    const int blocks_across = (canvas.image.width + kBlock - 1) / kBlock;
    const int blocks_down = (canvas.image.height + kBlock - 1) / kBlock;
    std::vector<float> farthest(static_cast<std::size_t>(blocks_across) * blocks_down, kFarAway);
    for (const auto& [center, radius] : spheres) {
        const Range rows = centers_between(center.y - radius, center.y + radius, canvas.image.height);
        const Range columns = centers_between(center.x - radius, center.x + radius, canvas.image.width);
        for (int block_y = rows.begin / kBlock; block_y * kBlock < rows.end; ++block_y) {
            for (int block_x = columns.begin / kBlock; block_x * kBlock < columns.end; ++block_x) {
                const Range block_rows{block_y * kBlock, std::min((block_y + 1) * kBlock, canvas.image.height)};
                const Range block_columns{block_x * kBlock, std::min((block_x + 1) * kBlock, canvas.image.width)};
                const double dx = center.x - std::clamp<double>(center.x, block_columns.begin, block_columns.end);
                const double dy = center.y - std::clamp<double>(center.y, block_rows.begin, block_rows.end);
                const double squared_dz = radius * radius - dx * dx - dy * dy;
                float& limit = farthest[static_cast<std::size_t>(block_y) * blocks_across + block_x];
                if (squared_dz <= 0.0 || center.z + std::sqrt(squared_dz) <= limit) continue;
                fill_sphere_in(canvas, {center, radius}, block_rows, block_columns);
                limit = farthest_in(canvas, block_rows, block_columns);
            }
        }
    }
}

float brightness(const Point& normal) {
    constexpr Point kUpperLeft{-0.5, 0.65, 0.57};
    return static_cast<float>(std::min(1.0, 0.40 + 0.40 * normal.z + 0.32 * std::max(0.0, dot(normal, kUpperLeft))));
}

void darken_creases(Canvas& canvas, int radius, float strength) {
    // Sixteen directions that spread evenly over a disk (golden angle).
    std::array<std::array<int, 2>, 16> steps{};
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const double angle = 2.39996323 * static_cast<double>(i);
        const double length = radius * std::sqrt((static_cast<double>(i) + 0.5) / static_cast<double>(steps.size()));
        steps[i] = {static_cast<int>(std::lround(length * std::cos(angle))),
                    static_cast<int>(std::lround(length * std::sin(angle)))};
    }
    const int width = canvas.image.width;
    const int height = canvas.image.height;
    const auto reach = static_cast<float>(radius);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t at = row_start(canvas, y) + x;
            if (canvas.depth[at] == kFarAway) continue;
            float hidden = 0.0F;
            for (const auto& [sx, sy] : steps) {
                // The opposite neighbour cancels the slope of a plane.
                const auto rise = [&](int nx, int ny) {
                    if (nx < 0 || nx >= width || ny < 0 || ny >= height) return -reach;
                    return std::clamp(canvas.depth[row_start(canvas, ny) + nx] - canvas.depth[at], -reach, reach);
                };
                hidden += std::max(0.0F, rise(x + sx, y + sy) + rise(x - sx, y - sy));
            }
            const float shade = 1.0F - strength * std::min(1.0F, hidden / (reach * static_cast<float>(steps.size())));
            Pixel& pixel = canvas.image.pixels[at];
            for (std::uint8_t* part : {&pixel.r, &pixel.g, &pixel.b}) {
                *part = static_cast<std::uint8_t>(shade * static_cast<float>(*part));
            }
        }
    }
}

void lay_over(Canvas& canvas, const Canvas& glass) {
    const auto product = [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>((a * b + 127) / 255); };
    for (std::size_t i = 0; i < canvas.image.pixels.size(); ++i) {
        Pixel& pixel = canvas.image.pixels[i];
        const Pixel& tint = glass.image.pixels[i];
        pixel = {product(pixel.r, tint.r), product(pixel.g, tint.g), product(pixel.b, tint.b)};
    }
}

Image reduced(const Image& image, int factor) {
    Image result{image.width / factor, image.height / factor, {}};
    result.pixels.reserve(static_cast<std::size_t>(result.width) * result.height);
    const int area = factor * factor;
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            std::array<int, 3> sum{};
            for (int row = y * factor; row < (y + 1) * factor; ++row) {
                const Pixel* pixels = &image.pixels[static_cast<std::size_t>(row) * image.width + x * factor];
                for (int column = 0; column < factor; ++column) {
                    sum[0] += pixels[column].r;
                    sum[1] += pixels[column].g;
                    sum[2] += pixels[column].b;
                }
            }
            const auto mean = [&](int total) { return static_cast<std::uint8_t>((total + area / 2) / area); };
            result.pixels.push_back({mean(sum[0]), mean(sum[1]), mean(sum[2])});
        }
    }
    return result;
}

void paste(Image& sheet, const Image& tile, int x, int y) {
    for (int row = 0; row < tile.height; ++row) {
        std::copy_n(tile.pixels.begin() + static_cast<std::ptrdiff_t>(row) * tile.width, tile.width,
                    sheet.pixels.begin() + static_cast<std::ptrdiff_t>(y + row) * sheet.width + x);
    }
}

}  // namespace scaleaxis::render
