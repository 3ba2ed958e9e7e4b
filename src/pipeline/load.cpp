// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/load.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "axis/complex.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/progress.hpp"
#include "base/text.hpp"
#include "pipeline/run.hpp"
#include "pipeline/solid_of_triangles.hpp"
#include "scaleaxis/balls.hpp"
#include "solid/cloud/outliers.hpp"
#include "solid/image/mask_volume.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Points closer together than this part of the tolerance tell nothing that samples would show.
constexpr double kThinning = 0.25;

// What smoothing promises to keep the volume of a mask to.
constexpr double kVolumeKept = 0.02;

/// A loading in progress.
struct Loading {
    const LoadOptions& options;
    Run run;
    LoadedSolid result = {};

    Loading(const LoadOptions& given, const Execution& execution, double stages)
        : options(given), run(execution, stages) {}

    template <class Work>
    auto stage(const std::string& name, const Work& work) {
        return run.stage(name, 1.0, result.costs, work);
    }
    void warn(const Diagnostic& warning) {
        result.warnings.push_back(warning);
        if (options.on_warning) {
            options.on_warning(warning);
        }
    }
    void warn(const std::vector<Diagnostic>& warnings) {
        for (const Diagnostic& warning : warnings) {
            warn(warning);
        }
    }
    LoadedSolid finished() {
        run.finish();
        return std::move(result);
    }
};

LoadedSolid of_triangles(SolidOfTriangles made, const std::string& unit, Loading& loading) {
    if (!made.solid) {
        throw UnusableInput(made.report.fault);
    }
    made.report.unit = unit;
    loading.result.input = std::move(made.report);
    loading.result.solid = std::move(made.solid);
    if (loading.options.keeps_mesh) {
        loading.result.mesh = std::move(made.mesh);
    }
    loading.result.left_out = std::move(made.left_out);
    return loading.finished();
}

/// "1 'base', 2 'lid'", the first ones.
std::string list_of(const std::vector<MeshObject>& objects) {
    constexpr std::size_t kMost = 5;
    std::string result;
    for (std::size_t i = 0; i < objects.size() && i < kMost; ++i) {
        result +=
            (i > 0 ? ", " : "") + std::to_string(i + 1) + (objects[i].name.empty() ? "" : " '" + objects[i].name + "'");
    }
    return result + (objects.size() > kMost ? "..." : "");
}

/// One mesh of the objects that are asked for. \throws InvalidOption if there is no such object
TriangleMesh chosen_objects(std::vector<MeshObject> objects, const std::vector<Index>& numbers) {
    if (numbers.empty()) {
        return joined(std::move(objects));
    }
    const std::set<Index> wanted(numbers.begin(), numbers.end());
    std::vector<MeshObject> chosen;
    for (const Index number : wanted) {
        require(number >= 1 && static_cast<std::size_t>(number) <= objects.size(),
                "there is no object " + std::to_string(number) + ": the file has " + std::to_string(objects.size()) +
                    " (" + list_of(objects) + ")");
        chosen.push_back(std::move(objects[number - 1]));
    }
    return joined(std::move(chosen));
}

/// All that follows the reading.
LoadedSolid solid_of_objects(MeshObjects read, Loading& loading) {
    const LoadOptions& options = loading.options;
    loading.warn(read.warnings);
    TriangleMesh mesh = chosen_objects(std::move(read.objects), options.objects);
    if (options.solid.kind == SolidKind::kWrap || options.solid.kind == SolidKind::kThicken) {
        SolidOfTriangles made = loading.stage(std::string(name_of(options.solid.kind)), [&](const Execution& inner) {
            return solid_of_triangles(std::move(mesh), options.solid, inner);
        });
        loading.warn(made.report.warnings());
        return of_triangles(std::move(made), read.unit, loading);
    }
    RepairedMesh repaired =
        loading.stage("repair", [&](const Execution& inner) { return repair(std::move(mesh), inner); });
    loading.warn(repaired.report.warnings());
    SolidOfTriangles made = loading.stage(
        "search tree", [&](const Execution& inner) { return solid_of_repaired(std::move(repaired), inner); });
    return of_triangles(std::move(made), read.unit, loading);
}

/// \param file or its bytes
LoadedSolid load_mesh(const auto& file, const LoadOptions& options, const Execution& execution) {
    Loading loading(options, execution, 3.0);
    MeshObjects read = loading.stage("reading", [&](const Execution&) { return read_objects(file); });
    return solid_of_objects(std::move(read), loading);
}

/// Is the image a mask, so that there is no doubt about what is solid?
bool is_mask(const Image& image) { return labels(image).size() == 1; }

constexpr std::size_t kShownItems = 12;  // of labels or values, in messages

/// The first of some items, as a list for people.
template <class Items, class Print>
std::string listed(const Items& items, const Print& print) {
    Words text;
    for (std::size_t i = 0; i < std::min(items.size(), kShownItems); ++i) {
        text << (i == 0 ? "" : ", ");
        print(text, items[i]);
    }
    text << (items.size() > kShownItems ? ", ..." : "");
    return text.str();
}

std::string in_words(const std::vector<LabelCount>& labels) {
    return labels.empty() ? "it has no labels"
                          : "its labels are " + listed(labels, [](Words& text, const LabelCount& count) {
                                text << count.label << (count.name.empty() ? "" : " '" + count.name + "'");
                            });
}

/// What can be chosen of an image: its labels, or values that are none.
std::string labels_in_words(const Image& image) {
    if (const std::vector<LabelCount> counts = report_of(image).labels; !counts.empty()) {
        return in_words(counts);
    }
    if (std::ranges::any_of(image.values, [](float value) { return std::abs(value) > kMostExactFloat; })) {
        return "labels beyond 2^24 cannot be told apart in single precision; number them anew, as by numpy.unique "
               "with return_inverse, and save the image again";
    }
    std::set<float> found;
    for (const float value : image.values) {
        if (value != 0.0F && found.size() <= kShownItems) {
            found.insert(value);
        }
    }
    if (found.empty()) {
        return "all its values are 0";
    }
    const std::vector<float> values(found.begin(), found.end());
    return "its values " + listed(values, [](Words& text, float value) { text << value; }) +
           " are not whole numbers, as labels are; round them and save the image again, or choose an iso value, or all "
           "that is not 0";
}

/// The labels that the options name, by number or by name. \throws UnusableInput if the image has not all of them
std::vector<float> chosen_labels(const Image& image, const LoadOptions& options) {
    std::vector<float> labels = options.labels;
    for (const std::string& name : options.label_names) {
        const auto found = std::ranges::find(image.label_names, name, &LabelName::name);
        if (found == image.label_names.end()) {
            throw UnusableInput("no label is called '" + name + "': " + labels_in_words(image));
        }
        labels.push_back(found->label);
    }
    for (const float label : labels) {
        if (std::abs(label) > kMostExactFloat || std::ranges::find(image.values, label) == image.values.end()) {
            Words text;
            text << "no voxel has the label " << label << ": " << labels_in_words(image);
            throw UnusableInput(text.str());
        }
    }
    return labels;
}

/// \throws InvalidOption if the options do not say what of the image is solid
Image chosen_mask(Image image, const LoadOptions& options) {
    const std::vector<float> labels = chosen_labels(image, options);
    if (labels.empty() && !options.is_nonzero && !is_mask(image)) {
        const auto [least, most] = std::ranges::minmax_element(image.values);
        if (*least != 0.0F || *most != 0.0F) {  // zeros are an empty mask
            Words text;
            text << "what of the image is solid? Its values are " << *least << " ... " << *most
                 << ": choose an iso value, labels, or all that is not 0";
            throw InvalidOption(Diagnostic{
                .code = "option", .message = text.str(), .hints = {{"iso"}, {"label"}, {"nonzero"}, {"each-label"}}});
        }
    }
    return mask(std::move(image), labels);
}

double smoothing_width(const LoadOptions& options) { return options.mask_smoothing.value_or(MaskSmoothing().width); }

/// Says so if the solid of a mask that is not smoothed has another volume than its voxels: edges of the staircase are
/// cut off, which takes much of thin parts.
void check_volume(const Image& mask, Loading& loading) {
    const auto voxels = static_cast<double>(std::ranges::count_if(mask.values, [](float v) { return v > 0.5F; }));
    const double volume = volume_above(mask, 0.5F, voxels);
    const double difference = volume - voxels;
    if (std::abs(difference) > kVolumeKept * voxels && std::abs(difference) > volume_uncertainty(mask)) {
        Words text;
        text << "the solid has " << std::lround(100.0 * std::abs(difference) / voxels) << " % "
             << (difference < 0.0 ? "less" : "more") << " volume than the " << std::lround(voxels)
             << " voxels of the mask; smoothing keeps their volume";
        Words width;
        width << MaskSmoothing().width;
        loading.warn({.code = "image.mask_volume", .message = text.str(), .hints = {{"mask-smoothing", width.str()}}});
    }
}

Image filled_mask(Image mask, Loading& loading) {
    FilledImage filled = without_voids(std::move(mask));
    if (filled.open > 0) {
        loading.warn({"image.open_voids",
                      std::to_string(filled.open) + (filled.open == 1 ? " space" : " spaces") + " beside the solid " +
                          (filled.open == 1 ? "is" : "are") +
                          " closed except at the border of the image, as the inside of a vessel that it cuts: "
                          "such spaces are not filled"});
    }
    return std::move(filled.image);
}

/// All that follows the choice of what is solid. \param image the mask, or the image itself if there is an `iso`
LoadedSolid solid_of_chosen(Image image, Loading& loading) {
    const LoadOptions& options = loading.options;
    const Level level{options.iso.value_or(Level().iso), options.is_below};
    if (const std::int64_t count = border_voxels(image, level); count > 0) {
        loading.warn({"image.border", "the solid is closed at the border of the image, where it has " +
                                          std::to_string(count) + " voxels"});
    }
    const MaskSmoothing smoothing{smoothing_width(options)};
    std::optional<Topology> of_mask;
    if (!options.iso) {
        if (options.fills_voids) {
            image = filled_mask(std::move(image), loading);
        }
        image = loading.stage("mask", [&](const Execution& inner) {
            if (smoothing.width > 0.0) {
                of_mask = topology(image, level, part_of(inner, 0.0, 0.3));
            }
            image = smoothed_mask(std::move(image), smoothing, part_of(inner, 0.3, 1.0));
            // Smoothing closes dents.
            return options.fills_voids ? without_voids(std::move(image), level.iso, inner).image : std::move(image);
        });
        if (smoothing.width == 0.0) {
            check_volume(image, loading);
        }
    }
    loading.result.solid =
        loading.stage("image", [&](const Execution& inner) { return image_solid(std::move(image), level, inner); });
    const std::optional<Topology> of_solid = loading.result.solid->topology();
    if (of_mask && *of_mask != *of_solid) {
        loading.warn({"image.smoothed_topology", "smoothing the mask changes its topology: from " + in_words(*of_mask) +
                                                     " to " + in_words(*of_solid) +
                                                     "; a mask smoothing of 0 keeps it"});
    }
    return loading.finished();
}

/// All that follows the reading.
LoadedSolid solid_of_image(Image image, Loading& loading) {
    loading.result.input = report_of(image);
    if (!loading.options.iso) {
        image = chosen_mask(std::move(image), loading.options);
    }
    return solid_of_chosen(std::move(image), loading);
}

double image_stages(const LoadOptions& options) { return options.iso ? 1.0 : 2.0; }

/// \param file or its bytes
LoadedSolid load_image(const auto& file, const LoadOptions& options, const Execution& execution) {
    Loading loading(options, execution, 1.0 + image_stages(options));
    Image image = loading.stage("reading", [&](const Execution&) { return read_image(file); });
    return solid_of_image(std::move(image), loading);
}

/// \param file or its bytes
LoadedSolid load_points(const auto& file, const LoadOptions& options, const Execution& execution) {
    Loading loading(options, execution, 4.0);
    PointCloud points = loading.stage("reading", [&](const Execution&) { return read_points(file); });
    const PrepareOptions preparation = prepare_options(points.points, options.delta);
    const PreparedCloud cloud = loading.stage(
        "normals", [&](const Execution& inner) { return prepare(std::move(points), preparation, inner); });
    loading.warn(cloud.report.warnings());
    if (!cloud.report.fault.empty()) {
        throw UnusableInput(cloud.report.fault);
    }
    CloudChoice choice = loading.stage("method", [&](const Execution& inner) {
        return options.cloud_method ? CloudChoice{*options.cloud_method, "as asked for", std::nullopt}
                                    : choose_method(cloud, inner);
    });
    if (choice.method == CloudMethod::kCrust) {
        require(!options.kernel, "the kernel has no effect, since the crust suits these points (" + choice.reason +
                                     "): leave it out, or choose the points method mls");
        loading.result.samples = loading.stage("crust", [&](const Execution& inner) {
            return choice.samples ? std::move(*choice.samples) : crust(cloud, inner);
        });
    } else {
        loading.result.solid = loading.stage(
            "search tree", [&](const Execution& inner) { return cloud_solid(cloud, {options.kernel}, inner); });
    }
    loading.result.input = PointsReport{cloud.report, choice.method, choice.reason};
    return loading.finished();
}

std::vector<Ball> union_in(const auto& file) {
    return file_kind(file) == FileKind::kAxis ? balls_of(read_axis(file)) : read_balls(file);
}

/// \param file or its bytes
LoadedSolid load_balls(const auto& file, const LoadOptions& options, const Execution& execution) {
    Loading loading(options, execution, 2.0);
    std::vector<Ball> balls = loading.stage("reading", [&](const Execution&) { return read_union(file); });
    loading.result.input = report_of(balls);
    loading.result.solid =
        loading.stage("union of balls", [&](const Execution& inner) { return union_solid(std::move(balls), inner); });
    return loading.finished();
}

LoadedSolid load_file(const auto& file, const LoadOptions& options, const Execution& execution) {
    const FileKind kind = options.kind ? *options.kind : file_kind(file);
    validate(options, name_of(kind));
    switch (kind) {
        case FileKind::kMesh:
            return load_mesh(file, options, execution);
        case FileKind::kImage:
            return load_image(file, options, execution);
        case FileKind::kPoints:
            return load_points(file, options, execution);
        default:
            return load_balls(file, options, execution);
    }
}

/// The least and the largest radius; 0 where there are no balls.
std::pair<double, double> radii_of(std::span<const Ball> balls) {
    if (balls.empty()) {
        return {0.0, 0.0};
    }
    const auto [least, most] = std::ranges::minmax_element(balls, {}, &Ball::radius);
    return {least->radius, most->radius};
}

}  // namespace

PrepareOptions prepare_options(std::span<const Point> points, const std::optional<Length>& delta) {
    std::vector<Point> usable;
    std::ranges::copy_if(points, std::back_inserter(usable), is_usable);
    const std::vector<std::uint8_t> is_far = find_far_points(usable);
    Box box;
    for (std::size_t i = 0; i < usable.size(); ++i) {
        if (is_far[i] == 0) {
            box.extend(usable[i]);
        }
    }
    const double diagonal = box.diagonal();
    return {delta && std::isfinite(diagonal) ? kThinning * delta->of(diagonal) : 0.0};
}

ImageReport report_of(const ImageView& image) {
    ImageReport report;
    report.sizes = image.sizes;
    report.origin = image.origin;
    for (std::size_t k = 0; k < 3; ++k) {
        report.spacing[k] = norm(image.steps[k]);
        report.directions[k] = (1.0 / report.spacing[k]) * image.steps[k];
    }
    if (!image.values.empty()) {
        const auto [least, most] = std::ranges::minmax_element(image.values);
        report.min = *least;
        report.max = *most;
    }
    report.labels = labels(image);
    return report;
}

ImageReport report_of(const Image& image) {
    ImageReport report = report_of(ImageView(image));
    report.unit = image.unit;
    report.space = image.space;
    for (LabelCount& count : report.labels) {
        const auto found = std::ranges::find(image.label_names, count.label, &LabelName::label);
        count.name = found == image.label_names.end() ? "" : found->name;
    }
    return report;
}

UnionReport report_of(std::span<const Ball> balls) {
    const std::vector<Ball> distinct = distinct_balls(balls);
    const auto [least, most] = radii_of(distinct);
    return {static_cast<std::int64_t>(balls.size()), static_cast<std::int64_t>(distinct.size()), bounds(distinct),
            least, most};
}

ComplexReport report_of(const MedialComplex& complex) {
    const std::vector<Ball> balls = balls_at_vertices(complex);
    const auto [least, most] = radii_of(balls);
    return {static_cast<std::int64_t>(complex.vertices.size()),
            static_cast<std::int64_t>(complex.edges.size()),
            static_cast<std::int64_t>(complex.faces.size()),
            complex.sheets,
            topology(complex),
            bounds(balls),
            least,
            most};
}

std::string unit_of(const InputReport& input) {
    if (const auto* mesh = std::get_if<MeshReport>(&input)) {
        return mesh->unit;
    }
    const auto* image = std::get_if<ImageReport>(&input);
    return image != nullptr ? image->unit : std::string();
}

std::string_view name_of(FileKind kind) {
    switch (kind) {
        case FileKind::kMesh:
            return "mesh";
        case FileKind::kPoints:
            return "points";
        case FileKind::kBalls:
            return "balls";
        case FileKind::kAxis:
            return "axis";
        default:
            return "image";
    }
}

void validate(const LoadOptions& options, std::string_view kind) {
    validate(options.solid);
    const auto exclude = [](bool is_given, bool is_other_given, const std::string& option, const std::string& other) {
        require(!is_given || !is_other_given, option + " has no effect beside " + other + ": leave one of them out");
    };
    const bool has_labels = !options.labels.empty() || !options.label_names.empty();
    exclude(has_labels, options.iso.has_value(), "labels", "iso");
    exclude(options.is_nonzero, options.iso.has_value(), "nonzero", "iso");
    exclude(options.mask_smoothing.has_value(), options.iso.has_value(), "mask smoothing", "iso");
    exclude(options.fills_voids, options.iso.has_value(), "fill voids", "iso");
    exclude(options.is_nonzero, has_labels, "nonzero", "labels");
    require(!options.is_below || options.iso, "below has no effect without iso: leave it out");
    require(!options.kernel || options.cloud_method != CloudMethod::kCrust,
            "the kernel has no effect with the points method crust: it is for mls");
    const auto check = [&](bool is_given, const std::string& option, const std::string& its_kind) {
        require(!is_given || kind == its_kind, option + " is for inputs of kind " + its_kind +
                                                   ", this one is of kind " + std::string(kind) + ": leave it out");
    };
    check(options.solid.kind != SolidKind::kAuto, "the kind of solid", "mesh");
    check(!options.objects.empty(), "a choice of objects", "mesh");
    check(options.iso.has_value(), "iso", "image");
    check(has_labels, "a choice of labels", "image");
    check(options.is_nonzero, "nonzero", "image");
    check(options.mask_smoothing.has_value(), "mask smoothing", "image");
    check(options.fills_voids, "fill voids", "image");
    check(options.cloud_method.has_value(), "the points method", "points");
    check(options.kernel.has_value(), "the kernel", "points");
}

LoadedSolid load_solid(const std::filesystem::path& file, const LoadOptions& options, const Execution& execution) {
    return load_file(file, options, execution);
}

LoadedSolid load_solid(const FileBytes& file, const LoadOptions& options, const Execution& execution) {
    return load_file(file, options, execution);
}

LoadedSolid load_solid(Image image, const LoadOptions& options, const Execution& execution) {
    validate(options, name_of(FileKind::kImage));
    check(image);
    Loading loading(options, execution, image_stages(options));
    return solid_of_image(std::move(image), loading);
}

LoadedSolid load_solid(MeshObjects objects, const LoadOptions& options, const Execution& execution) {
    validate(options, name_of(FileKind::kMesh));
    Loading loading(options, execution, 2.0);
    return solid_of_objects(std::move(objects), loading);
}

LoadedSolid load_label(const ImageView& image, const ImageReport& report, float label, LoadOptions options,
                       const Execution& execution) {
    options.labels = {label};
    validate(options, name_of(FileKind::kImage));
    const auto count = std::ranges::find(report.labels, label, &LabelCount::label);
    if (count == report.labels.end()) {
        Words text;
        text << "no voxel has the label " << label << ": " << in_words(report.labels);
        throw UnusableInput(text.str());
    }
    Loading loading(options, execution, image_stages(options));
    loading.result.input = report;
    return solid_of_chosen(label_mask(image, *count, smoothing_width(options)), loading);
}

std::vector<Ball> balls_of(const MedialComplex& complex) {
    std::vector<Ball> balls = balls_at_vertices(complex);
    std::erase_if(balls, [](const Ball& ball) { return ball.radius == 0.0; });
    return balls;
}

std::vector<Ball> read_union(const std::filesystem::path& file) { return union_in(file); }
std::vector<Ball> read_union(const FileBytes& file) { return union_in(file); }

}  // namespace scaleaxis::inline v1
