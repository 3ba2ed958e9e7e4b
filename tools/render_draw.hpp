// SPDX-License-Identifier: Apache-2.0
/// \file
/// Scene → picture: camera, colours, and what of a scene is drawn how.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "render_canvas.hpp"
#include "render_scene.hpp"

namespace scaleaxis::render {

/// Unit vectors of an orthographic view.
struct Camera {
    Point right;
    Point up;
    Point to_viewer;
};

/// The camera that looks at the scene from direction `from`, with `up` upwards in the picture. Neither may be zero.
Camera camera_from(const Point& from, const Point& up);

/// The rectangle of the picture plane that holds all of a scene.
struct Extent {
    double min_x = std::numeric_limits<double>::infinity();
    double min_y = std::numeric_limits<double>::infinity();
    double max_x = -std::numeric_limits<double>::infinity();
    double max_y = -std::numeric_limits<double>::infinity();

    void extend(const Extent& other);
};

Extent extent_of(const Scene& scene, const Camera& camera);

enum class Coloring { Sheet, Radius, Angle, Label, Plain };

struct Style {
    int width = 800;  ///< of a tile, pixels
    int height = 800;
    Coloring coloring = Coloring::Sheet;
    bool has_seams = true;    ///< draw the edges where three or more faces meet
    double line_width = 4.0;  ///< of curves without faces, in pixels of a tile of 800
    bool has_labels = true;   ///< leave room for a label at the bottom, and for the scale of the colours
};

struct Tile {
    Scene scene;
    std::optional<Scene> shape;  ///< a mesh drawn as glass around it
    std::string label;
    Extent extent;                ///< what fits into the tile
    double largest_radius = 0.0;  ///< the end of the colour scale
};

/// \throws InvalidOption if the scene lacks what the colouring needs
Image draw_tile(const Tile& tile, const Camera& camera, const Style& style);

}  // namespace scaleaxis::render
