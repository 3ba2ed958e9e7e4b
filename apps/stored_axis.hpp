// SPDX-License-Identifier: Apache-2.0
/// \file
/// What all commands share that make an axis of a stored one: `scaleaxis COMMAND AXIS -o OUT`.
#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "documents.hpp"
#include "options.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "status.hpp"

namespace scaleaxis::app {

struct StoredAxisOptions {
    std::filesystem::path input;
    std::string format;  ///< of the input; empty: its name or content tells
    std::string output;
    std::string output_format;
    bool has_polygons = false;
    std::optional<double> scale;  ///< by which the balls had been grown, and the radii divided; unset: as the file says
    CommonOptions common;
};

/// `AXIS`, `-o`, `--polygons`, `--scale`, and what all commands have.
/// \param name of the command, and what a file in a folder is called after
/// \param scales that `--scale` takes
void add_stored_axis_options(CommandLine command, const std::string& name, StoredAxisOptions& options,
                             const Range& scales = kScaleRange);

/// `--scale`
Option add_stored_scale_option(CommandLine command, std::optional<double>& scale, const Range& scales);

/// What a command has made of an axis.
struct DerivedAxis {
    MedialComplex complex;
    Json statistics = Json::object();  ///< added to the document
    std::string summary;               ///< printed between the axis before and after
    std::vector<Diagnostic> warnings = {};
};

/// The warning that a complex has too few vertices for a command that looks at vertices alone; nothing if it has
/// enough.
std::vector<Diagnostic> coarse_axis_warning(const MedialComplex& complex);

/// \param complex where it is a medial mesh of another program, radii are linear between vertices (`with_linear_radii`)
/// \param diagonal of the box around its balls, which relative lengths refer to
using Derivation =
    std::function<DerivedAxis(const MedialComplex& complex, double diagonal, const Execution& execution)>;

/// Reads the axis, derives the other one, writes it, and tells about both. \param name of the command
Status run_stored_axis(const std::string& name, StoredAxisOptions options, const std::stop_token& cancel,
                       const Derivation& derive);

}  // namespace scaleaxis::app
