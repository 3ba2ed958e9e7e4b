// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files of spheres that stand for the links of a robot, or for one solid.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "documents.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::app {

struct LinkSpheres {
    std::string link;  ///< its name; of a solid that is no robot: that of the file
    std::vector<Ball> balls;
    Json statistics = {};  ///< written to JSON
};

/// The formats: "json", "yaml" (and "yml"), "csv", "srdf", "urdf", and those of `write_balls`.
/// \param format see `written_format` \throws FileError if none of them is meant, or the folder cannot be written to
void check_spheres_output(const std::filesystem::path& file, const std::string& format);

/// JSON with all that is known; YAML as cuRobo has it (`collision_spheres`: lists of centres and radii by link); CSV,
/// a row for each sphere; SRDF with a `link_sphere_approximation` for each link; URDF of a robot whose links have only
/// spheres to collide with; or all balls in a format of `write_balls`.
/// \param name of the robot \throws FileError
void write_spheres(const std::filesystem::path& file, const std::string& format, const std::string& name,
                   const std::vector<LinkSpheres>& links);

/// A number as text, the shortest that gives the same one.
std::string shortest(double value);

}  // namespace scaleaxis::app
