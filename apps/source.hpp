// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a solid is made from: files of any kind with the options that say what in them is solid, or a function.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "report.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/points.hpp"

namespace scaleaxis::app {

/// What of an image is solid, as the options say.
struct ImageChoice {
    std::optional<double> iso;
    bool is_below = false;
    std::vector<float> labels;
    bool is_nonzero = false;
    bool is_each_label = false;
    std::optional<double> mask_smoothing;  ///< unset: the default
};

/// How a point cloud becomes a solid, as the options say.
struct PointChoice {
    std::optional<CloudMethod> method;  ///< unset: what suits the points
    std::optional<double> kernel;       ///< unset: what suits the points
};

/// A function, where it is asked, and its smallest feature.
struct FunctionChoice {
    std::string expression;  ///< empty: none
    std::vector<double> bounds;
    double smallest_feature = 0.0;  ///< 0: the default
};

struct SourceOptions {
    std::optional<FileKind> kind;  ///< unset: that of the file
    ImageChoice image;
    PointChoice points;
    FunctionChoice function;
};

/// `--as`
void add_kind_option(CLI::App& command, std::optional<FileKind>& kind);
void add_source_options(CLI::App& command, SourceOptions& options);

Json to_json(const SourceOptions& options);

/// Reads images and keeps the last one, for all solids that are made from it.
class ImageReader {
   public:
    /// \throws FileError
    const Image& read(const std::filesystem::path& file);

   private:
    std::filesystem::path file_;
    Image image_;
};

/// One solid to be. Its `name` is what messages and output files call it after.
struct Source {
    std::filesystem::path name;
    std::filesystem::path file;  ///< empty for a function
    SourceOptions options;
    std::shared_ptr<ImageReader> images;  ///< of a label: what has read the image already; else null
};

/// The sources that inputs and options mean, with `--each-label` one for each label.
/// \throws InvalidOption if they do not go together
std::vector<Source> sources_of(const std::vector<std::filesystem::path>& inputs, const SourceOptions& options);

/// The kind of the file, as the options or else its content say.
/// \throws FileError, InvalidOption naming an option that is about another kind
FileKind kind_of(const Source& source);

}  // namespace scaleaxis::app
