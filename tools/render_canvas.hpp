// SPDX-License-Identifier: Apache-2.0
/// \file
/// The rasteriser: triangles, capsules and spheres into a picture with a depth for each pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "render_color.hpp"

namespace scaleaxis::render {

struct Pixel {
    std::uint8_t r = 255;
    std::uint8_t g = 255;
    std::uint8_t b = 255;
};

/// Rows from top to bottom.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<Pixel> pixels;
};

/// White and infinitely far away at first.
struct Canvas {
    Canvas(int width, int height);

    Image image;
    std::vector<float> depth;  ///< for each pixel, in pixels; greater is nearer
};

/// A point of the canvas: pixels to the right and down from its upper left corner, and towards the viewer.
struct Corner {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    Color color;
};

/// All pixels whose centre lies in the triangle; depth and colour are interpolated.
void fill_triangle(Canvas& canvas, const Corner& a, const Corner& b, const Corner& c);

/// All pixels whose centre is at most `half_width` away from the segment: a line with round ends.
void fill_segment(Canvas& canvas, const Corner& a, const Corner& b, double half_width);

struct Sphere {
    Corner center;
    double radius = 0.0;
};

/// Spheres of the colours of their centres, lit as `brightness` says.
void fill_spheres(Canvas& canvas, std::vector<Sphere> spheres);

/// How bright a surface is whose normal, turned to the viewer, is `normal` (x right, y up, z to the viewer): a light at
/// the camera, a weaker one from the upper left, and some from everywhere. 0…1.
float brightness(const Point& normal);

/// Darkens what lies behind its surroundings within `radius` pixels: corners, and surfaces behind others.
void darken_creases(Canvas& canvas, int radius, float strength);

/// Multiplies the colours of `canvas` by those of `glass`, which is of the same size.
void lay_over(Canvas& canvas, const Canvas& glass);

/// The picture reduced by `factor` in width and height, each pixel the mean of those that it covers.
Image reduced(const Image& image, int factor);

/// Copies `tile` into `sheet` with its upper left corner at (x, y).
void paste(Image& sheet, const Image& tile, int x, int y);

}  // namespace scaleaxis::render
