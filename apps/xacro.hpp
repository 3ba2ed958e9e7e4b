// SPDX-License-Identifier: Apache-2.0
/// \file
/// Descriptions of robots that xacro, a program of ROS's, expands.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace scaleaxis::app {

/// Is the file named as xacro's are?
bool is_xacro(const std::filesystem::path& file);

/// The URDF that the program xacro makes of a file: an own process, so that nothing of it runs in this one.
/// \param arguments as xacro takes them: "NAME:=VALUE"
/// \throws FileError if there is no such program, or with the last line of what it says
std::string expanded_xacro(const std::filesystem::path& file, const std::vector<std::string>& arguments);

}  // namespace scaleaxis::app
