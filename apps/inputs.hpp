// SPDX-License-Identifier: Apache-2.0
/// \file
/// The files that the inputs of a command line stand for.
///
///   FILE      itself; `-`: standard input
///   FOLDER    the files in it that have the extension of a format, in the order of their names; not .txt, which may
///             be anything
///   @LIST     the files and folders that a text names, one on each line, relative to the folder of the list; empty
///             lines and those that begin with # are passed over; @-: from standard input, relative to where one is
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace scaleaxis::app {

struct Input {
    std::filesystem::path file;
    std::string origin;  ///< which line of which list names it; empty: the command line
};

/// The same for all names of a file.
std::filesystem::path without_links(const std::filesystem::path& file);

/// Files that the command line names as inputs, of any option, are not overwritten: `CommandLine` and `expanded` add
/// them.
void protect_input(const std::filesystem::path& file);
/// \throws InvalidOption if the file is one of them
void check_is_no_input(const std::filesystem::path& file);
/// Another command line begins.
void forget_inputs();

/// Is it a folder in which no file is an input by its name?
bool is_folder_without_inputs(const std::filesystem::path& file);

/// \throws InvalidOption if a list names nothing, or standard input would be read twice
/// \throws FileError if a list cannot be read, or a folder
std::vector<Input> expanded(const std::vector<std::filesystem::path>& inputs);

}  // namespace scaleaxis::app
