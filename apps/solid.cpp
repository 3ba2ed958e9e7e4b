// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <sstream>
#include <utility>

#include "expression.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/points.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

std::string text_of(const Point& p) {
    std::ostringstream text;
    text << '(' << p.x << ", " << p.y << ", " << p.z << ')';
    return text.str();
}

Json coordinates(const Point& p) { return {p.x, p.y, p.z}; }

/// The radii and the bounds of balls, in both forms.
void describe_extent(const std::vector<Ball>& balls, Description& description) {
    const Box box = bounds(balls);
    description.json["bounds"] = to_json(box);
    description.json["radius"] = nullptr;
    if (!balls.empty()) {
        const auto [smallest, largest] = std::ranges::minmax_element(balls, {}, &Ball::radius);
        description.json["radius"] = {{"min", smallest->radius}, {"max", largest->radius}};
        std::ostringstream text;
        label(text, "radius") << smallest->radius << " ... " << largest->radius << '\n';
        print(text, box);
        description.text += text.str();
    }
}

void solid_of_mesh(const Source& source, bool keeps_mesh, const Execution& execution, Stopwatch& watch, Solid& solid) {
    TriangleMesh mesh = read_mesh(source.file);
    solid.costs.push_back(watch.lap("reading"));
    stop_if_interrupted();
    RepairedMesh repaired = repair(std::move(mesh), execution);
    solid.costs.push_back(watch.lap("repair"));
    solid.warnings = repaired.report.warnings();
    solid.description = described(repaired.report);
    if (!repaired.report.fault.empty()) {
        for (const std::string& warning : solid.warnings) {
            print_warning(source.name.string() + ": " + warning);
        }
        throw UnusableShape(source.name.string() + ": " + repaired.report.fault);
    }
    if (keeps_mesh) {
        solid.mesh = repaired.mesh;
    }
    solid.shape = mesh_shape(std::move(repaired), execution);
    solid.costs.push_back(watch.lap("search tree"));
}

/// Is the image a mask, so that there is no doubt about what is solid?
bool is_mask(const Image& image) { return labels(image).size() == 1; }

void solid_of_image(const Source& source, const Execution& execution, Stopwatch& watch, Solid& solid) {
    const ImageChoice& choice = source.options.image;
    Image image = source.images ? source.images->read(source.file) : read_image(source.file);
    solid.costs.push_back(watch.lap("reading"));
    stop_if_interrupted();
    solid.description = described(image);
    Level level{choice.iso.value_or(Level().iso), choice.is_below};
    if (!choice.iso) {
        if (choice.is_each_label) {  // otherwise each would be a source of its own
            throw InvalidOption("--each-label: the image has no labels, which are whole numbers other than 0");
        }
        if (choice.labels.empty() && !choice.is_nonzero && !is_mask(image)) {
            const auto [least, most] = std::ranges::minmax_element(image.values);
            std::ostringstream text;
            text << "what of the image is solid? Its values are " << *least << " ... " << *most
                 << ": choose by --iso, --label, --nonzero or --each-label";
            throw InvalidOption(text.str());
        }
        image = mask(std::move(image), choice.labels);
    }
    if (const std::int64_t count = border_voxels(image, level); count > 0) {
        solid.warnings.push_back("the solid is closed at the border of the image, where it has " +
                                 std::to_string(count) + " voxels");
    }
    if (!choice.iso) {
        image = smoothed_mask(std::move(image), {choice.mask_smoothing.value_or(MaskSmoothing().width)}, execution);
        solid.costs.push_back(watch.lap("mask"));
    }
    solid.shape = image_shape(std::move(image), level, execution);
    solid.costs.push_back(watch.lap("image"));
}

void solid_of_points(const Source& source, const Execution& execution, Stopwatch& watch, Solid& solid) {
    const PointChoice& options = source.options.points;
    PointCloud points = read_points(source.file);
    solid.costs.push_back(watch.lap("reading"));
    stop_if_interrupted();
    const PreparedCloud cloud = prepare(std::move(points), execution);
    solid.costs.push_back(watch.lap("normals"));
    solid.warnings = cloud.report.warnings();
    solid.description = described(cloud.report);
    if (!cloud.report.fault.empty()) {
        throw UnusableShape(source.name.string() + ": " + cloud.report.fault);
    }
    CloudChoice choice =
        options.method ? CloudChoice{*options.method, "as asked for", std::nullopt} : choose_method(cloud, execution);
    const bool is_crust = choice.method == CloudMethod::kCrust;
    if (is_crust) {
        solid.samples = choice.samples ? std::move(*choice.samples) : crust(cloud, execution);
        solid.costs.push_back(watch.lap("crust"));
    } else {
        solid.shape = moving_least_squares(cloud, {options.kernel}, execution);
        solid.costs.push_back(watch.lap("search tree"));
    }
    std::ostringstream text;
    label(text, "method") << (is_crust ? "crust" : "moving least squares") << ": " << choice.reason << '\n';
    solid.description.text += text.str();
    solid.description.json["method"] = {{"name", is_crust ? "crust" : "mls"}, {"reason", choice.reason}};
}

void solid_of_function(const FunctionChoice& choice, const Execution& execution, Stopwatch& watch, Solid& solid) {
    const std::vector<double>& b = choice.bounds;
    ImplicitOptions options{{{b[0], b[1], b[2]}, {b[3], b[4], b[5]}}, choice.smallest_feature};
    solid.shape = implicit_shape(compiled(choice.expression), options, execution);
    solid.costs.push_back(watch.lap("function"));
    std::ostringstream text;
    label(text, "function") << choice.expression << '\n';
    print(text, solid.shape->bounds());
    solid.description = {
        "function", {{"expression", choice.expression}, {"bounds", to_json(solid.shape->bounds())}}, text.str()};
}

void solid_of_balls(const Source& source, const Execution& execution, Stopwatch& watch, Solid& solid) {
    std::vector<Ball> balls = read_union(source.file);
    solid.costs.push_back(watch.lap("reading"));
    solid.description = described(balls);
    solid.description.kind = "union";  // "balls" are those of the result
    solid.shape = union_of_balls(std::move(balls), execution);
    solid.costs.push_back(watch.lap("union of balls"));
}

}  // namespace

Description described(const MeshReport& mesh) {
    std::ostringstream text;
    print(text, mesh);
    return {"mesh", to_json(mesh), text.str()};
}

Description described(const Image& image) {
    constexpr std::size_t kMostLabels = 256;
    const auto [least, most] = std::ranges::minmax_element(image.values);
    std::ostringstream text;
    label(text, "image") << image.sizes[0] << " x " << image.sizes[1] << " x " << image.sizes[2] << " voxels of "
                         << norm(image.steps[0]) << " x " << norm(image.steps[1]) << " x " << norm(image.steps[2])
                         << '\n';
    label(text, "origin") << text_of(image.origin) << '\n';
    Json spacing = Json::array();
    Json directions = Json::array();
    std::string axes;
    for (const Point& step : image.steps) {
        spacing.push_back(norm(step));
        directions.push_back(coordinates((1.0 / norm(step)) * step));
        axes += (axes.empty() ? "" : ", ") + text_of((1.0 / norm(step)) * step);
    }
    label(text, "directions") << axes << '\n';
    label(text, "values") << *least << " ... " << *most << '\n';
    Json counts = Json::array();
    if (const std::vector<LabelCount> found = labels(image); !found.empty() && found.size() <= kMostLabels) {
        constexpr std::size_t kShown = 12;
        label(text, "labels");
        for (std::size_t i = 0; i < found.size(); ++i) {
            counts.push_back({{"label", found[i].label}, {"voxels", found[i].voxels}});
            if (i < kShown) {
                text << (i == 0 ? "" : ", ") << static_cast<std::int64_t>(found[i].label) << " (" << found[i].voxels
                     << " voxels)";
            }
        }
        text << (found.size() > kShown ? ", ... " + std::to_string(found.size()) + " in all\n" : "\n");
    }
    return {"image",
            {{"sizes", image.sizes},
             {"spacing", spacing},
             {"origin", coordinates(image.origin)},
             {"directions", directions},
             {"values", {{"min", *least}, {"max", *most}}},
             {"labels", counts}},
            text.str()};
}

Description described(const CloudReport& cloud) {
    std::ostringstream text;
    print(text, cloud);
    return {"points", to_json(cloud), text.str()};
}

Description described(const std::vector<Ball>& balls) {
    const std::vector<Ball> distinct = cleaned(balls);
    std::ostringstream text;
    print_balls(text, balls.size(), std::nullopt);
    label(text, "distinct") << distinct.size() << '\n';
    Description description{"balls", {{"balls", balls.size()}, {"distinct", distinct.size()}}, text.str()};
    describe_extent(distinct, description);
    return description;
}

Description described(const MedialComplex& axis) {
    const Topology shape = topology(axis);
    std::ostringstream text;
    print(text, axis, shape);
    Description description{"axis",
                            {{"vertices", axis.vertices.size()},
                             {"edges", axis.edges.size()},
                             {"faces", axis.faces.size()},
                             {"sheets", axis.sheets},
                             {"topology", to_json(shape)}},
                            text.str()};
    describe_extent(balls_of(axis), description);
    return description;
}

Solid read_solid(const Source& source, const Execution& execution, bool keeps_mesh) {
    Solid solid;
    Stopwatch watch;
    if (source.file.empty()) {
        solid_of_function(source.options.function, execution, watch, solid);
    } else {
        switch (kind_of(source)) {
            case FileKind::kMesh:
                solid_of_mesh(source, keeps_mesh, execution, watch, solid);
                break;
            case FileKind::kImage:
                solid_of_image(source, execution, watch, solid);
                break;
            case FileKind::kPoints:
                solid_of_points(source, execution, watch, solid);
                break;
            case FileKind::kBalls:
            case FileKind::kAxis:
                solid_of_balls(source, execution, watch, solid);
                break;
        }
    }
    for (const std::string& warning : solid.warnings) {
        print_warning(source.name.string() + ": " + warning);
    }
    return solid;
}

std::vector<Ball> balls_of(const MedialComplex& complex) {
    std::vector<Ball> balls(complex.vertices.size());
    for (std::size_t v = 0; v < balls.size(); ++v) {
        balls[v] = {complex.vertices[v], complex.radii[v]};
    }
    return balls;
}

std::vector<Ball> read_union(const std::filesystem::path& file) {
    return file_kind(file) == FileKind::kAxis ? balls_of(read_axis(file)) : read_balls(file);
}

}  // namespace scaleaxis::app
