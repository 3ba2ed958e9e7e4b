// SPDX-License-Identifier: Apache-2.0
/// \file
/// scaleaxis-render: pictures of axes, balls and meshes, without a screen.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "render_draw.hpp"
#include "render_png.hpp"
#include "scaleaxis/errors.hpp"

namespace {

using namespace scaleaxis;
using namespace scaleaxis::render;

const std::map<std::string, Coloring> kColorings{{"sheet", Coloring::Sheet},
                                                 {"radius", Coloring::Radius},
                                                 {"angle", Coloring::Angle},
                                                 {"label", Coloring::Label},
                                                 {"plain", Coloring::Plain}};

enum ExitStatus { kDone = 0, kUsage = 2, kUnreadable = 3 };

struct Options {
    std::vector<std::string> inputs;
    std::string output;
    std::vector<std::string> shapes;
    std::vector<std::string> labels;
    std::string size = "800";
    int columns = 0;
    std::vector<double> view;
    double azimuth = 30.0;
    double elevation = 20.0;
    std::string up = "y";
    std::string color = "sheet";
    bool is_same_scale = false;
    Style style;
};

void add_options(CLI::App& app, Options& options) {
    app.add_option("INPUT", options.inputs,
                   "Axes (.ply, .ma), balls (.ply, .balls, .txt, .xyzr, .woff), meshes (.ply, .obj, .off, .stl)")
        ->required();
    app.add_option("-o,--output", options.output, "PNG file to write")->required();
    app.add_option("--size", options.size, "Pixels of a tile: SIDE or WIDTHxHEIGHT, each 64 to 2048")
        ->capture_default_str();
    app.add_option("--columns", options.columns, "Tiles in a row; 0: as many as look good")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    app.add_option("--azimuth", options.azimuth, "Turn of the viewer around the up axis, degrees")
        ->capture_default_str();
    app.add_option("--elevation", options.elevation, "Height of the viewer above the horizon, degrees")
        ->check(CLI::Range(-90.0, 90.0))
        ->capture_default_str();
    app.add_option("--view", options.view, "Direction from the scene to the viewer, in place of the two angles: X,Y,Z")
        ->delimiter(',')
        ->expected(3)
        ->excludes("--azimuth")
        ->excludes("--elevation");
    app.add_option("--up", options.up, "Axis that points upwards: x, y or z")
        ->check(CLI::IsMember({"x", "y", "z"}))
        ->capture_default_str();
    app.add_option("--color", options.color, "Colour of axes and balls: sheet, radius, angle, label or plain")
        ->check(CLI::IsMember(kColorings))
        ->capture_default_str();
    app.add_option("--shape", options.shapes,
                   "Mesh drawn as glass around the axis; once for all inputs, or once for each")
        ->type_size(1)
        ->allow_extra_args(false);
    app.add_option("--label", options.labels, "Text below a tile; once for each input (default: the file's name)")
        ->type_size(1)
        ->allow_extra_args(false);
    app.add_flag("!--no-labels", options.style.has_labels, "No text below the tiles");
    app.add_flag("!--no-seams", options.style.has_seams, "No lines where three or more faces meet");
    app.add_option("--line-width", options.style.line_width,
                   "Width of the curves of an axis, 0.5 to 50, for a tile of 800 pixels")
        ->capture_default_str();
    app.add_flag("--same-scale", options.is_same_scale,
                 "All tiles of a row show the same part of space at the same scale");
}

/// `style` with the width and height of "800" or "600x400".
Style sized(Style style, const std::string& size) {
    constexpr int kSmallest = 64;
    constexpr int kLargest = 2048;
    const std::size_t times = size.find('x');
    const auto pixels = [&](const std::string& number) {
        int value = 0;
        const char* end = number.data() + number.size();
        if (std::from_chars(number.data(), end, value).ptr != end || value < kSmallest || value > kLargest) {
            throw InvalidOption("--size " + size + ": must be SIDE or WIDTHxHEIGHT, each from " +
                                std::to_string(kSmallest) + " to " + std::to_string(kLargest) + " pixels");
        }
        return value;
    };
    style.width = pixels(size.substr(0, times));
    style.height = times == std::string::npos ? style.width : pixels(size.substr(times + 1));
    return style;
}

Camera camera_of(const Options& options) {
    // Up y: azimuth 0 looks from +z, 90 from +x. The other axes follow by rotating the names.
    const auto rotated = [&](const Point& p) {
        if (options.up == "x") return Point{p.y, p.z, p.x};
        if (options.up == "z") return Point{p.z, p.x, p.y};
        return p;
    };
    const auto turned = [&] {
        const double azimuth = options.azimuth * std::numbers::pi / 180.0;
        const double elevation = options.elevation * std::numbers::pi / 180.0;
        return rotated(
            {std::sin(azimuth) * std::cos(elevation), std::sin(elevation), std::cos(azimuth) * std::cos(elevation)});
    };
    const auto& view = options.view;
    const Point from = view.empty() ? turned() : Point{view[0], view[1], view[2]};
    if (!std::isnormal(squared_norm(from))) {
        throw InvalidOption("--view, --azimuth, --elevation: must be a direction; 0,0,0 and nan are none");
    }
    return camera_from(from, rotated({0, 1, 0}));
}

Tile read_tile(const Options& options, std::size_t i, const Camera& camera) {
    Tile tile;
    tile.scene = read_scene(options.inputs[i]);
    tile.label = options.labels.empty() ? std::filesystem::path(options.inputs[i]).stem().string() : options.labels[i];
    tile.extent = extent_of(tile.scene, camera);
    for (const double radius : tile.scene.radii) tile.largest_radius = std::max(tile.largest_radius, radius);
    if (!options.shapes.empty()) {
        tile.shape = read_scene(options.shapes[options.shapes.size() == 1 ? 0 : i]);
        tile.extent.extend(extent_of(*tile.shape, camera));
    }
    return tile;
}

void unify(std::vector<Tile>& row) {
    Extent extent;
    double largest_radius = 0.0;
    for (const Tile& tile : row) {
        extent.extend(tile.extent);
        largest_radius = std::max(largest_radius, tile.largest_radius);
    }
    for (Tile& tile : row) {
        tile.extent = extent;
        tile.largest_radius = largest_radius;
    }
}

void check(const Options& options) {
    const double line_width = options.style.line_width;
    if (!(line_width >= 0.5 && line_width <= 50.0)) throw InvalidOption("--line-width: must be from 0.5 to 50");
    const std::size_t inputs = options.inputs.size();
    if (!options.labels.empty() && options.labels.size() != inputs) {
        throw InvalidOption("--label: give one for each of the " + std::to_string(inputs) + " inputs, or none");
    }
    if (options.shapes.size() > 1 && options.shapes.size() != inputs) {
        throw InvalidOption("--shape: give one for all inputs, or one for each of the " + std::to_string(inputs));
    }
}

Image draw_sheet(const Options& options) {
    const Camera camera = camera_of(options);
    const Style& style = options.style;
    const std::size_t tiles = options.inputs.size();
    const std::size_t columns = options.columns > 0
                                    ? std::min<std::size_t>(options.columns, tiles)
                                    : static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(tiles))));
    const std::size_t rows = (tiles + columns - 1) / columns;
    Image sheet{static_cast<int>(columns) * style.width, static_cast<int>(rows) * style.height, {}};
    sheet.pixels.resize(static_cast<std::size_t>(sheet.width) * sheet.height);
    for (std::size_t row = 0; row < rows; ++row) {
        std::vector<Tile> row_tiles;
        for (std::size_t i = row * columns; i < std::min(tiles, (row + 1) * columns); ++i) {
            row_tiles.push_back(read_tile(options, i, camera));
        }
        if (options.is_same_scale) unify(row_tiles);
        for (std::size_t column = 0; column < row_tiles.size(); ++column) {
            paste(sheet, draw_tile(row_tiles[column], camera, style), static_cast<int>(column) * style.width,
                  static_cast<int>(row) * style.height);
        }
    }
    return sheet;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Draws axes, balls and meshes into one PNG picture: a tile for each input."};
    Options options;
    add_options(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kDone : kUsage;
    }
    try {
        check(options);
        options.style = sized(options.style, options.size);
        options.style.coloring = kColorings.at(options.color);
        write_png(options.output, draw_sheet(options));
    } catch (const InvalidOption& error) {
        std::cerr << "scaleaxis-render: " << error.what() << '\n';
        return kUsage;
    } catch (const std::exception& error) {
        std::cerr << "scaleaxis-render: " << error.what() << '\n';
        return kUnreadable;
    }
    return kDone;
}
