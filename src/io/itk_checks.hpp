// SPDX-License-Identifier: Apache-2.0
/// \file
/// What has to hold of an image before the Insight Toolkit is asked for it. The toolkit trusts what it reads: damaged
/// files make it read or write beyond its memory, stop the program, or never end. So it only sees heads that passed
/// `check_…_head`, one for each format; `check_…_length` asks, once the head is read, whether all data are there, which
/// it would fill with anything.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::io {

// What several formats need.

/// Throws a `FileError` unless so many bytes of data were found as the head promises.
void check_bytes(std::uintmax_t promised, std::uintmax_t found);
/// For what cannot be told without unpacking: are there enough of them for anything?
void check_packed_bytes(std::uintmax_t promised, std::uintmax_t packed);
/// The sum of the sizes of the files that a list names, one a line, beside `file`.
std::uintmax_t size_of_list(const std::filesystem::path& file, std::string_view names);
/// The size of a data file.
std::uintmax_t size_of_data(const std::filesystem::path& file);
/// A line of a head as it can be quoted: its number, for people.
[[noreturn]] void fail_at_line(std::size_t line, const std::string& what);

/// Numbers of a place: coordinates, directions, spacings. Beyond this bound the toolkit's own products overflow.
constexpr double kMostOfPlace = 1e12;
/// Is it finite and far from where products of three overflow?
bool is_of_place(double value);
/// The same for a distance of voxels, which is not 0 and has no reciprocal that is too large.
bool is_spacing(double value);

// nrrd_checks.cpp
void check_nrrd_head(std::string_view content);
void check_nrrd_length(const std::filesystem::path& file, std::string_view content, std::uintmax_t bytes);
/// The name of the file that has its data; empty if they follow the head.
/// The unit of lengths, which is empty where it is not said; and where its coordinates point, in words.
std::string nrrd_unit(std::string_view content);
std::string nrrd_space(std::string_view content);
std::string nrrd_data_file(std::string_view content);

// meta_image_checks.cpp
void check_meta_image_head(std::string_view content);
void check_meta_image_length(const std::filesystem::path& file, std::string_view content, std::uintmax_t bytes);
std::string meta_image_data_file(std::string_view content);
/// The unit of lengths: "um", "mm", "cm", or empty.
std::string meta_image_unit(std::string_view content);

// vtk_image_checks.cpp
void check_vtk_image_head(std::string_view content);
void check_vtk_image_length(std::string_view content, std::uintmax_t voxels, std::uintmax_t bytes);

// nifti_checks.cpp: the length too, since its head says where the data are
void check_nifti(const std::filesystem::path& file, std::string_view content);
/// The head, unpacked: enough for the questions below.
std::string nifti_head(std::string_view content);
/// The unit of lengths: "m", "mm", "um", or empty.
std::string nifti_unit(std::string_view content);
/// The steps along the axes and the origin, if it says them as a matrix. \pre it passed `check_nifti`
std::optional<std::array<Point, 4>> nifti_sform(std::string_view content);
bool has_nifti_data(std::string_view content);

// tiff_checks.cpp
void check_tiff(std::string_view content);

// dicom_checks.cpp
void check_dicom(std::string_view content);

}  // namespace scaleaxis::io
