// SPDX-License-Identifier: Apache-2.0
/// \file
/// Names of output files, and checks of them before the work begins.
///
/// What a user gives after `-o` is a file, a folder, or a pattern with `{name}` (name of the input without its folder
/// and extension) and `{scale}`:
///   folder             folder/{name}-axis.ply
///   file.ply           file.ply
///   {name}.vtp         as it stands
///   -                  /dev/stdout
/// With several scales a file name without `{scale}` gets `-s{scale}` before its extension.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::app {

/// The pattern that `output` stands for. \param kind what a file in a folder is called after: `{name}-<kind>.ply`
/// \param format the extension of a file in a folder, without its dot; empty: `otherwise`
std::string output_pattern(const std::string& output, const std::string& kind, bool has_several_scales,
                           const std::string& format = {}, const std::string& otherwise = "ply");

bool is_stdout(const std::filesystem::path& file);

/// The extension of a file, or the format that takes its place, in lower case and without a dot.
std::string format_of(const std::filesystem::path& file, const std::string& format);

/// The format in which a file is written: the one that is chosen, or for stdout `otherwise`; empty: that of its name.
std::string written_format(const std::filesystem::path& file, const std::string& format,
                           const std::string& otherwise = "ply");

/// The name of a file without its folder and extension (two of them where the last is `.gz`); `stdin` for `-`.
std::string stem_of(const std::filesystem::path& file);

/// The pattern with the name of `input` and the shortest decimal form of `scale` filled in.
std::filesystem::path expand(const std::string& pattern, const std::filesystem::path& input, double scale);

/// A file that will be written.
struct Output {
    std::filesystem::path file;
    std::filesystem::path input = {};  ///< whose result it holds; empty: that of all
};

/// \throws InvalidOption if two of the outputs are the same file
void check_distinct(const std::vector<Output>& outputs);

/// Throws `FileError` if a file cannot be written.
using OutputCheck = std::function<void(const std::filesystem::path&)>;

/// The check of a file that is written in its `written_format`.
template <class Check>
OutputCheck with_format(const Check& check, const std::string& format, const std::string& otherwise = "ply") {
    return [=](const std::filesystem::path& file) { check(file, written_format(file, format, otherwise)); };
}

/// Makes the folder of an output where that is missing, and runs the check, after one that it is no input. What is
/// wrong with an output is wrong usage. \throws InvalidOption in place of FileError
void check_output(const std::filesystem::path& file, const OutputCheck& check);

/// The check of an axis in its `written_format`. \param has_polygons whether it is to be written as polygons, which
/// only PLY tells from triangles
OutputCheck axis_output_check(const std::string& format, bool has_polygons);

/// Writes an axis with the erosion thickness of its vertices, where the format has attributes of vertices.
/// \param format of the file, as `written_format` has it \param has_polygons see `AxisFileOptions`
void write_axis_file(const std::filesystem::path& file, const MedialComplex& complex, const std::string& format,
                     bool has_polygons, const Execution& execution);

/// Adds the file for statistics to the outputs, unless there is none.
/// \throws InvalidOption if it cannot be written
void add_statistics_file(const std::string& file, std::vector<Output>& outputs);

/// The file that the only output goes to, after all checks: `expand`, `check_output`, statistics, `check_distinct`.
/// \throws InvalidOption
std::filesystem::path checked_output(const std::string& pattern, const std::filesystem::path& input, double scale,
                                     const std::string& statistics, const OutputCheck& check);

/// Writes to a temporary name and renames. \throws FileError
void write_text(const std::filesystem::path& file, const std::string& text);

/// Writes `text` to stdout. \throws FileError if it does not get there
void print_text(const std::string& text);

}  // namespace scaleaxis::app
