// SPDX-License-Identifier: Apache-2.0
/// \file
/// Options as JavaScript gives them, under the names that Python has, in camel case.
#pragma once

#include <string>
#include <vector>

#include "base/formats/json.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/skeleton.hpp"
#include "scaleaxis/thickness.hpp"

namespace scaleaxis::wasm {

/// What a call asks for besides its results as arrays.
struct Outputs {
    std::vector<std::string> formats;  ///< of files: "ply", "glb"
    bool has_view = false;             ///< whether the result holds the data of the interactive page
};

struct Options {
    LoadOptions load;
    ScaleAxisOptions pipeline;
    SkeletonOptions skeleton;
    std::optional<Length> node_spacing;
    ThicknessOptions thickness;
    double edge = 0.01;  ///< of thickness: longest edge of the surface, in diagonals; as in the program
    Outputs outputs;
};

/// \throws InvalidOption for what is unknown, or of another type
Options read_options(const Json& given);

}  // namespace scaleaxis::wasm
