// SPDX-License-Identifier: Apache-2.0
#include "source.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "expression.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "readable.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/ranges.hpp"
#include "scaleaxis/sampling.hpp"
#include "stopwatch.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr Range kAnyNumber{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()};
constexpr Range kLabelRange{-16777216, 16777216};
constexpr Range kObjectRange{1, std::numeric_limits<Index>::max()};

const Choices<FileKind> kKindNames{
    {"mesh", FileKind::kMesh}, {"image", FileKind::kImage}, {"points", FileKind::kPoints}, {"balls", FileKind::kBalls}};

const Choices<std::optional<CloudMethod>> kPointsMethods{
    {"auto", std::nullopt}, {"mls", CloudMethod::kMovingLeastSquares}, {"crust", CloudMethod::kCrust}};

std::string name_of(const std::optional<CloudMethod>& method) {
    return std::ranges::find(kPointsMethods, method, &std::pair<std::string, std::optional<CloudMethod>>::second)
        ->first;
}

const Choices<SolidKind> kSolidKinds{{"auto", SolidKind::kAuto},
                                     {"winding", SolidKind::kWinding},
                                     {"wrap", SolidKind::kWrap},
                                     {"thicken", SolidKind::kThicken}};

/// Of an image whose labels are solids of their own, one source each.
std::vector<Source> by_label(const Source& source) {
    std::vector<Source> result;
    try {
        for (const LabelCount& count : source.images->read(source.file, source.options).report.labels) {
            Source one = source;
            // Labels are whole numbers.
            const std::string label = std::to_string(static_cast<std::int64_t>(count.label));
            one.name = source.name.parent_path() / (stem_of(source.name) + "-label" + label);
            one.options.load.kind = FileKind::kImage;  // the file need not be looked at again
            one.options.is_each_label = false;
            one.label = count;
            result.push_back(one);
        }
    } catch (const Error&) {
        return {source};  // it will be met again where errors of this input are reported
    }
    return result.empty() ? std::vector{source} : result;
}

/// What `read(path)` returns for an input that has to be of this kind. \param option what demands it
template <class Read>
auto reading_kind(FileKind kind, const std::string& option, const fs::path& file, const SourceOptions& options,
                  const Read& read) {
    return reading(file, options.format, [&](const fs::path& path) {
        const FileKind found = options.load.kind ? *options.load.kind : file_kind(path);
        if (found != kind) {
            throw InvalidOption(option + " is for inputs of kind " + std::string(name_of(kind)) +
                                ", this one is of kind " + std::string(name_of(found)));
        }
        return read(path);
    });
}

/// Of a mesh whose objects are solids of their own, one source each.
std::vector<Source> by_object(const Source& source) {
    std::vector<Source> result;
    try {
        const std::size_t count = source.meshes->read(source.file, source.options).objects.size();
        for (std::size_t i = 1; i <= count; ++i) {
            Source one = source;
            one.name = source.name.parent_path() / (stem_of(source.name) + "-object" + std::to_string(i));
            one.options.load.kind = FileKind::kMesh;
            one.options.load.objects = {static_cast<Index>(i)};
            one.options.is_each_object = false;
            result.push_back(one);
        }
    } catch (const Error&) {
        return {source};  // it will be met again where errors of this input are reported
    }
    return result.empty() ? std::vector{source} : result;
}

LoadedSolid load_function(const FunctionChoice& choice, const Execution& execution) {
    const std::vector<double>& b = choice.bounds;
    const FunctionOptions options{{{b[0], b[1], b[2]}, {b[3], b[4], b[5]}}, choice.smallest_feature, choice.is_clipped};
    LoadedSolid result;
    Stopwatch watch;
    result.solid = function_solid(compiled(choice.expression), options, execution);
    result.costs.push_back(watch.lap("function"));
    result.input = FunctionReport{choice.expression, result.solid->bounds()};
    return result;
}

}  // namespace

void add_kind_option(CommandLine command, std::optional<FileKind>& kind) {
    add_choice(command, "--as", kind, kKindNames, "What the input is; by default its content tells, or else its name");
}

void add_solid_options(CommandLine command, SolidOptions& options, const std::string& group) {
    const Range any_length{std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()};
    const Option solid =
        add_choice(command, "--solid", options.kind, kSolidKinds,
                   "What triangles make solid: 'winding': what they wind around, holes closed; 'wrap': what a\n"
                   "ball cannot reach from outside; 'thicken': what is close to them; 'auto' says what it takes\n"
                   "[default auto]");
    const Option opening = command
                               .add_option("--opening", options.opening,
                                           "With --solid wrap: the diameter of the ball, in units of the mesh")
                               .check(in_range(any_length))
                               .needs(solid)
                               .value_text("LENGTH");
    const Option thickness =
        command
            .add_option("--thickness", options.thickness,
                        "With --solid thicken: twice the distance from the triangles, in units of the mesh")
            .check(in_range(any_length))
            .needs(solid)
            .value_text("LENGTH");
    for (Option option : {solid, opening, thickness}) {
        if (!group.empty()) {
            option.group(group);
        }
    }
}

void add_source_options(CommandLine command, SourceOptions& options, const std::vector<std::string>& for_solids) {
    const std::string group = "Input";
    add_kind_option(command, options.load.kind);
    command.option("--as").group(group);
    add_format_option(command, options.format).group(group);
    add_solid_options(command, options.load.solid, group);
    LoadOptions& load = options.load;
    const Option object =
        command
            .add_option("--object", load.objects,
                        "Of a file with several objects (glTF, 3MF and others), those of these numbers, from 1")
            .check(whole_in_range(kObjectRange))
            .delimiter(',')
            .one_text_each()
            .value_text("N[,M...]")
            .group(group);
    command
        .add_flag("--each-object", options.is_each_object,
                  "Every object of such a file as a solid of its own, named {name}-object{N}")
        .excludes(object)
        .value_text(" ")
        .group(group);
    const Option iso =
        command.add_option("--iso", load.iso, "Of a grey image, what is above this value (interpolated between voxels)")
            .check(in_range(kAnyNumber))
            .value_text("V")
            .group(group);
    command.add_flag("--below", load.is_below, "With --iso: what is below it").needs(iso).value_text(" ").group(group);
    const Option label =
        command
            .add_option("--label", options.labels,
                        "Of a label image, the voxels with one of these values, or names as 3D Slicer gives them")
            .check([is_label = in_range(kLabelRange)](std::string& text) {
                double number = 0.0;
                return parse_value(text, number) ? is_label(text) : std::string();
            })
            .delimiter(',')
            .one_text_each()
            .excludes(iso)
            .value_text("N[,M...]")
            .group(group);
    const Option nonzero =
        command.add_flag("--nonzero", load.is_nonzero, "Of a mask or label image, all voxels that are not 0")
            .excludes(iso)
            .excludes(label)
            .value_text(" ")
            .group(group);
    command
        .add_flag("--each-label", options.is_each_label,
                  "Every label of a label image as a solid of its own, named {name}-label{N}")
        .excludes(iso)
        .excludes(label)
        .excludes(nonzero)
        .value_text(" ")
        .group(group);
    command
        .add_option("--mask-smoothing", load.mask_smoothing,
                    "Smooths the staircase of masks and labels by a Gaussian of this width, in voxels;\n"
                    "volume is kept; 0: as it is" +
                        range_and_default(kMaskSmoothingRange, MaskSmoothing().width))
        .check(in_range(kMaskSmoothingRange))
        .excludes(iso)
        .value_text("W")
        .group(group);
    command
        .add_flag("--fill-voids", load.fills_voids,
                  "Fills the voids of masks and labels, such as those that noise leaves in vessels: a curve skeleton\n"
                  "has none")
        .excludes(iso)
        .value_text(" ")
        .group(group);
    add_choice(
        command, "--points", load.cloud_method, kPointsMethods,
        "How points become a solid: 'mls': a surface near them, by moving least squares; 'crust': their poles as\n"
        "they are, for dense points without noise (they take no --delta); 'auto' says what it takes\n"
        "[default auto]")
        .group(group);
    command
        .add_option(
            "--kernel", load.kernel,
            "Of moving least squares: how far points count, in distances between them; larger ones smooth more\n"
            "[1.5 ... 100; default 3, more where there is noise]")
        .check(in_range(kKernelRange))
        .value_text("W")
        .group(group);
    FunctionChoice& function = options.function;
    const Option implicit = command
                                .add_option("--implicit", function.expression,
                                            "In place of a file: where this function of x, y and z is negative")
                                .value_text("EXPR")
                                .group(group);
    const Option bounds = command.add_option("--bounds", function.bounds, "With --implicit: a box around the solid")
                              .check(in_range(kAnyNumber))
                              .delimiter(',')
                              .expected(6)
                              .needs(implicit)
                              .value_text("X0,Y0,Z0,X1,Y1,Z1")
                              .group(group);
    implicit.needs(bounds);
    command.add_flag("--clip", function.is_clipped, "With --implicit: closes the solid where the bounds cut it")
        .needs(implicit)
        .value_text(" ")
        .group(group);
    command
        .add_option("--smallest-feature", function.smallest_feature,
                    "With --implicit: parts of this diameter are found, and walls and gaps as thick as this\n"
                    "[default 1/128 of the diagonal of the bounds]")
        .check(in_range({std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()}))
        .needs(implicit)
        .value_text("LENGTH")
        .group(group);
    command.on_parsed([command, &options, group, for_solids] {
        options.given = command.given_options(group);
        std::ranges::copy_if(for_solids, std::back_inserter(options.given),
                             [&](const std::string& name) { return command.option(name).count() > 0; });
        for (const std::string& text : options.labels) {
            if (double number = 0.0; parse_value(text, number)) {
                options.load.labels.push_back(static_cast<float>(number));
            } else {
                options.load.label_names.push_back(text);
            }
        }
    });
}

void check_unused(const SourceOptions& options, const std::string& what, const std::vector<std::string>& used) {
    for (const std::string& name : options.given) {
        if (std::ranges::find(used, name) == used.end()) {
            throw InvalidOption(name + " has no effect on " + what + ": leave it out");
        }
    }
}

void check_unused_beside_axis(const SourceOptions& options, const std::vector<std::string>& used) {
    check_unused(options, "an axis that is there already", used);
}

Json to_json(const SourceOptions& options) {
    const LoadOptions& load = options.load;
    const FunctionChoice& function = options.function;
    const auto length = [](double value) { return value > 0.0 ? Json(value) : Json(nullptr); };
    Json labels = load.labels;
    for (const std::string& name : load.label_names) {
        labels.push_back(name);
    }
    Json json{{"as", nullptr},
              {"format", options.format.empty() ? Json(nullptr) : Json(options.format)},
              {"solid", name_of(load.solid.kind)},
              {"opening", length(load.solid.opening)},
              {"thickness", length(load.solid.thickness)},
              {"objects", load.objects},
              {"each_object", options.is_each_object},
              {"iso", load.iso ? Json(*load.iso) : Json(nullptr)},
              {"below", load.is_below},
              {"labels", labels},
              {"nonzero", load.is_nonzero},
              {"each_label", options.is_each_label},
              {"mask_smoothing", load.mask_smoothing.value_or(MaskSmoothing().width)},
              {"fill_voids", load.fills_voids},
              {"points", name_of(load.cloud_method)},
              {"kernel", load.kernel ? Json(*load.kernel) : Json(nullptr)},
              {"implicit", function.expression.empty() ? Json(nullptr) : Json(function.expression)},
              {"bounds", function.bounds},
              {"clip", function.is_clipped},
              {"smallest_feature", length(function.smallest_feature)}};
    for (const auto& [name, kind] : kKindNames) {
        if (load.kind == kind) {
            json["as"] = name;
        }
    }
    return json;
}

std::vector<Source> sources_of(const std::vector<Input>& inputs, const SourceOptions& options) {
    if (!options.function.expression.empty()) {
        if (!inputs.empty()) {
            throw InvalidOption("--implicit takes the place of a file: leave out " + inputs.front().file.string());
        }
        if (options.load.kind) {
            throw InvalidOption("--as is for files, not for --implicit");
        }
        if (!options.format.empty()) {
            throw InvalidOption("--format is for files, not for --implicit");
        }
        validate(options.load, "function");
        return {{"implicit", "", options}};
    }
    if (inputs.empty()) {
        throw InvalidOption("INPUT is needed: a file, or --implicit with --bounds");
    }
    if (options.is_each_label && options.is_each_object) {
        throw InvalidOption("--each-label is for images, --each-object for meshes: leave one of them out");
    }
    const auto images = std::make_shared<ImageReader>();
    const auto meshes = std::make_shared<ObjectReader>();
    std::vector<Source> sources;
    for (const auto& [input, origin] : inputs) {
        Source source{input, input, options};
        source.origin = origin;
        std::vector<Source> parts{source};
        if (options.is_each_label) {
            source.images = images;
            parts = by_label(source);
        } else if (options.is_each_object) {
            source.meshes = meshes;
            parts = by_object(source);
        }
        sources.insert(sources.end(), parts.begin(), parts.end());
    }
    return sources;
}

const LabelImage& ImageReader::read(const fs::path& file, const SourceOptions& options) {
    if (file_ != file) {
        image_ = {};
        file_.clear();
        Stopwatch watch;
        image_.image = reading_kind(FileKind::kImage, "--each-label", file, options,
                                    [](const fs::path& path) { return read_image(path); });
        image_.report = report_of(image_.image);
        image_.costs = {watch.lap("reading")};
        file_ = file;
    }
    return image_;
}

const MeshObjects& ObjectReader::read(const fs::path& file, const SourceOptions& options) {
    if (file_ != file) {
        objects_ = {};
        file_.clear();
        objects_ = reading_kind(FileKind::kMesh, "--each-object", file, options,
                                [](const fs::path& path) { return read_objects(path); });
        file_ = file;
    }
    return objects_;
}

LoadedSolid load_source(const Source& source, const Execution& execution,
                        const std::function<void(const Diagnostic&)>& warn, bool keeps_mesh) {
    if (source.file.empty()) {
        return load_function(source.options.function, execution);
    }
    LoadOptions options = source.options.load;
    options.keeps_mesh = keeps_mesh;
    options.on_warning = warn;
    if (source.meshes) {
        Stopwatch watch;
        const MeshObjects& all = source.meshes->read(source.file, source.options);
        MeshObjects one{{}, all.warnings, all.unit};
        if (!options.objects.empty()) {
            one.objects = {all.objects[static_cast<std::size_t>(options.objects.front()) - 1]};
            options.objects.clear();
        }
        const StageCost reading_cost = watch.lap("reading");
        LoadedSolid result = load_solid(std::move(one), options, execution);
        result.costs.insert(result.costs.begin(), reading_cost);
        return result;
    }
    if (!source.images) {
        return reading(source, [&](const fs::path& path) { return load_solid(path, options, execution); });
    }
    const LabelImage& image = source.images->read(source.file, source.options);
    if (!source.label) {  // otherwise each would be a source of its own
        std::ostringstream text;
        text
            << "--each-label: the image has no labels, which are whole numbers other than 0 and up to 2^24: its values "
               "are "
            << image.report.min << " ... " << image.report.max;
        throw InvalidOption(text.str());
    }
    LoadedSolid result = load_label(image.image, image.report, source.label->label, options, execution);
    if (source.label->label == image.report.labels.front().label) {  // the reading was done for all of them
        result.costs.insert(result.costs.begin(), image.costs.begin(), image.costs.end());
    }
    return result;
}

void check_sampling_options(const SourceOptions& options, bool is_given) {
    if (is_given && options.load.cloud_method == CloudMethod::kCrust) {
        throw InvalidOption(
            "--delta and --sampling have no effect with --points crust, for which the points are the samples: "
            "leave them out");
    }
}

void check_can_fit(const LoadedSolid& input, const std::optional<UnionKind>& kind) {
    if (kind == UnionKind::kFitted && input.samples) {
        throw InvalidOption(
            "--union fitted: the points are taken as samples (--points crust), and there is no solid that balls could "
            "be "
            "fitted to: take --union polar, or --points mls");
    }
}

Diagnostic unused_sampling_options() {
    return {"points.unused_options", "the points are the samples (see method): delta and sampling have no effect"};
}

TriangleMesh take_surface(LoadedSolid& input, const std::optional<Length>& delta, std::uint64_t seed,
                          const Execution& execution) {
    if (!input.mesh.triangles.empty()) {
        return std::move(input.mesh);
    }
    SamplingOptions sampling;
    sampling.tolerance = delta.value_or(kDefaultDelta).of(input.solid->bounds().diagonal());
    sampling.needs_manifold = true;
    sampling.seed = seed;
    return boundary_mesh(sample(*input.solid, sampling, execution), execution).mesh;
}

std::array<Point, 3> steps_of(const ImageReport& report) {
    std::array<Point, 3> steps;
    for (int axis = 0; axis < 3; ++axis) {
        steps[axis] = report.spacing[axis] * report.directions[axis];
    }
    return steps;
}

}  // namespace scaleaxis::app
