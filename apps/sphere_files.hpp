// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files of spheres that stand for the links of a robot, or for one solid.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "documents.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/robot.hpp"

namespace scaleaxis::app {

struct NamedSpheres {
    std::string link;  ///< its name; of a solid that is no robot: that of the file
    std::vector<Ball> balls;
    Json statistics = {};  ///< written to JSON
};

/// The formats: "json", "yaml" (and "yml"), "csv", "srdf", "urdf", those of `write_balls`, and for a robot also those
/// of `robot_files`. \param format see `written_format` \throws FileError if none of them is meant, or the folder
/// cannot be written to
void check_spheres_output(const std::filesystem::path& file, const std::string& format, bool is_robot);

/// Is it the format of a program that plans motions, in `robot_files`? \param format as `written_format` has it
bool is_robot_format(const std::filesystem::path& file, const std::string& format);

/// The extension of files in this format.
std::string spheres_extension(const std::string& format);

/// The files of `robot_files`; those of VAMP beside the one named. \throws FileError
void write_robot(const std::filesystem::path& file, const std::string& format, const Robot& robot,
                 const std::vector<NamedSpheres>& links, Index large);

/// JSON with all that is known; YAML as cuRobo has it (`collision_spheres`: lists of centres and radii by link); CSV,
/// a row for each sphere; SRDF with a `link_sphere_approximation` for each link; URDF of a robot whose links have only
/// spheres to collide with; or all balls in a format of `write_balls`.
/// \param name of the robot \param pairs that are ignored, for JSON \throws FileError
void write_spheres(const std::filesystem::path& file, const std::string& format, const std::string& name,
                   const std::vector<NamedSpheres>& links, const std::vector<IgnoredPair>& pairs = {});

/// A number as text, the shortest that gives the same one.
std::string shortest(double value);

}  // namespace scaleaxis::app
