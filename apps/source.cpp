// SPDX-License-Identifier: GPL-3.0-or-later
#include "source.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "options.hpp"
#include "outputs.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr Range kSmoothingRange{0, 10};
constexpr Range kAnyNumber{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()};
constexpr Range kLabelRange{-16777216, 16777216};

const std::vector<std::pair<std::string, FileKind>> kKindNames{
    {"mesh", FileKind::kMesh}, {"image", FileKind::kImage}, {"points", FileKind::kPoints}, {"balls", FileKind::kBalls}};

constexpr Range kKernelRange{1.5, 100};

const std::vector<std::pair<std::string, std::optional<CloudMethod>>> kMethodNames{
    {"auto", std::nullopt}, {"mls", CloudMethod::kMovingLeastSquares}, {"crust", CloudMethod::kCrust}};

std::string name_of(const std::optional<CloudMethod>& method) {
    return std::ranges::find(kMethodNames, method, &std::pair<std::string, std::optional<CloudMethod>>::second)->first;
}

/// How a message calls an input of this kind.
std::string name_of(FileKind kind) {
    const auto found = std::ranges::find(kKindNames, kind, &std::pair<std::string, FileKind>::second);
    return found != kKindNames.end() ? found->first : "axis";
}

/// \throws InvalidOption naming an option that says nothing about an input of this kind
void check_options(const SourceOptions& options, const std::string& kind) {
    struct Given {
        std::string option;
        std::string kind;
        bool is_given;
    };
    const ImageChoice& image = options.image;
    const PointChoice& points = options.points;
    for (const Given& given :
         {Given{"--iso", "image", image.iso.has_value()}, Given{"--label", "image", !image.labels.empty()},
          Given{"--nonzero", "image", image.is_nonzero}, Given{"--each-label", "image", image.is_each_label},
          Given{"--mask-smoothing", "image", image.mask_smoothing.has_value()},
          Given{"--points", "points", points.method.has_value()},
          Given{"--kernel", "points", points.kernel.has_value()}}) {
        if (given.is_given && given.kind != kind) {
            throw InvalidOption(given.option + " is for inputs of kind " + given.kind + ", this one is of kind " +
                                kind);
        }
    }
}

/// Of an image whose labels are solids of their own, one source each.
std::vector<Source> by_label(const Source& source) {
    std::vector<Source> result;
    try {
        kind_of(source);
        for (const LabelCount& count : labels(source.images->read(source.file))) {
            Source one = source;
            // Labels are whole numbers.
            const std::string label = std::to_string(static_cast<std::int64_t>(count.label));
            one.name = source.name.parent_path() / (stem_of(source.name) + "-label" + label);
            one.options.kind = FileKind::kImage;  // the file need not be looked at again
            one.options.image.labels = {count.label};
            one.options.image.is_each_label = false;
            result.push_back(one);
        }
    } catch (const Error&) {
        return {source};  // it will be met again where errors of this input are reported
    }
    return result.empty() ? std::vector{source} : result;
}

}  // namespace

void add_kind_option(CLI::App& command, std::optional<FileKind>& kind) {
    command.add_option("--as", kind, "What the input is; by default its content tells, or else its name")
        ->transform(CLI::CheckedTransformer(kKindNames))
        ->option_text("mesh|image|points|balls");
}

void add_source_options(CLI::App& command, SourceOptions& options) {
    const std::string group = "Input";
    add_kind_option(command, options.kind);
    command.get_option("--as")->group(group);
    ImageChoice& image = options.image;
    CLI::Option* iso =
        command
            .add_option("--iso", image.iso, "Of a grey image, what is above this value (interpolated between voxels)")
            ->check(in_range(kAnyNumber))
            ->option_text("V")
            ->group(group);
    command.add_flag("--below", image.is_below, "With --iso: what is below it")
        ->needs(iso)
        ->option_text(" ")
        ->group(group);
    CLI::Option* label =
        command.add_option("--label", image.labels, "Of a label image, the voxels with one of these values")
            ->check(in_range(kLabelRange))
            ->delimiter(',')
            ->allow_extra_args(false)
            ->excludes(iso)
            ->option_text("N[,M...]")
            ->group(group);
    CLI::Option* nonzero =
        command.add_flag("--nonzero", image.is_nonzero, "Of a mask or label image, all voxels that are not 0")
            ->excludes(iso)
            ->excludes(label)
            ->option_text(" ")
            ->group(group);
    command
        .add_flag("--each-label", image.is_each_label,
                  "Every label of a label image as a solid of its own, named {name}-label{N}")
        ->excludes(iso)
        ->excludes(label)
        ->excludes(nonzero)
        ->option_text(" ")
        ->group(group);
    command
        .add_option("--mask-smoothing", image.mask_smoothing,
                    "Smooths the staircase of masks and labels by a Gaussian of this width, in voxels;\n"
                    "volume is kept; 0: as it is" +
                        range_and_default(kSmoothingRange, MaskSmoothing().width))
        ->check(in_range(kSmoothingRange))
        ->excludes(iso)
        ->option_text("W")
        ->group(group);
    PointChoice& points = options.points;
    command
        .add_option_function<std::string>(
            "--points",
            [&points](const std::string& name) {
                points.method =
                    std::ranges::find(kMethodNames, name, &decltype(kMethodNames)::value_type::first)->second;
            },
            "How points become a solid: 'mls': a surface near them, by moving least squares; 'crust': their poles as\n"
            "they are, for dense points without noise (then --delta is of no effect); 'auto' says what it takes\n"
            "[default auto]")
        ->check(CLI::IsMember({"auto", "mls", "crust"}))
        ->option_text("auto|mls|crust")
        ->group(group);
    command
        .add_option(
            "--kernel", points.kernel,
            "Of moving least squares: how far points count, in distances between them; larger ones smooth more\n"
            "[1.5 ... 100; default 3, more where there is noise]")
        ->check(in_range(kKernelRange))
        ->option_text("W")
        ->group(group);
    FunctionChoice& function = options.function;
    CLI::Option* implicit = command
                                .add_option("--implicit", function.expression,
                                            "In place of a file: where this function of x, y and z is negative")
                                ->option_text("EXPR")
                                ->group(group);
    CLI::Option* bounds = command.add_option("--bounds", function.bounds, "With --implicit: a box around the solid")
                              ->check(in_range(kAnyNumber))
                              ->delimiter(',')
                              ->expected(6)
                              ->needs(implicit)
                              ->option_text("X0,Y0,Z0,X1,Y1,Z1")
                              ->group(group);
    implicit->needs(bounds);
    command
        .add_option("--smallest-feature", function.smallest_feature,
                    "With --implicit: parts of this diameter are found, and walls and gaps as thick as this\n"
                    "[default 1/128 of the diagonal of the bounds]")
        ->check(in_range({std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()}))
        ->needs(implicit)
        ->option_text("LENGTH")
        ->group(group);
}

Json to_json(const SourceOptions& options) {
    const ImageChoice& image = options.image;
    const FunctionChoice& function = options.function;
    Json json{{"as", nullptr},
              {"iso", image.iso ? Json(*image.iso) : Json(nullptr)},
              {"below", image.is_below},
              {"labels", image.labels},
              {"nonzero", image.is_nonzero},
              {"each_label", image.is_each_label},
              {"mask_smoothing", image.mask_smoothing.value_or(MaskSmoothing().width)},
              {"points", name_of(options.points.method)},
              {"kernel", options.points.kernel ? Json(*options.points.kernel) : Json(nullptr)},
              {"implicit", function.expression.empty() ? Json(nullptr) : Json(function.expression)},
              {"bounds", function.bounds},
              {"smallest_feature", function.smallest_feature > 0.0 ? Json(function.smallest_feature) : Json(nullptr)}};
    for (const auto& [name, kind] : kKindNames) {
        if (options.kind == kind) {
            json["as"] = name;
        }
    }
    return json;
}

std::vector<Source> sources_of(const std::vector<fs::path>& inputs, const SourceOptions& options) {
    if (!options.function.expression.empty()) {
        if (!inputs.empty()) {
            throw InvalidOption("--implicit takes the place of a file: leave out " + inputs.front().string());
        }
        if (options.kind) {
            throw InvalidOption("--as is for files, not for --implicit");
        }
        check_options(options, "function");
        return {{"implicit", "", options, nullptr}};
    }
    if (inputs.empty()) {
        throw InvalidOption("INPUT is needed: a file, or --implicit with --bounds");
    }
    if (options.points.kernel && options.points.method == CloudMethod::kCrust) {
        throw InvalidOption("--kernel is for --points mls, not for --points crust");
    }
    const auto images = std::make_shared<ImageReader>();
    std::vector<Source> sources;
    for (const fs::path& input : inputs) {
        const Source source{input, input, options, options.image.is_each_label ? images : nullptr};
        if (options.image.is_each_label) {
            const std::vector<Source> parts = by_label(source);
            sources.insert(sources.end(), parts.begin(), parts.end());
        } else {
            sources.push_back(source);
        }
    }
    return sources;
}

const Image& ImageReader::read(const fs::path& file) {
    if (file_ != file) {
        image_ = {};
        file_.clear();
        image_ = read_image(file);
        file_ = file;
    }
    return image_;
}

FileKind kind_of(const Source& source) {
    const FileKind kind = source.options.kind ? *source.options.kind : file_kind(source.file);
    check_options(source.options, name_of(kind));
    return kind;
}

}  // namespace scaleaxis::app
