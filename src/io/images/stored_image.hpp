// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the formats of images have in common: a head that says what the numbers are and where they lie, and the
/// numbers. A format's reader turns the head into a `StoredImage`; `read_stored` checks it and reads the numbers of all
/// of them.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/number_type.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/image.hpp"

namespace scaleaxis::io {

enum class Packing { kNone, kZlib, kBzip2, kText, kHex };  // gzip too is kZlib

/// Where numbers are: in memory, and after these in a file, if that has a name.
struct StoredData {
    std::string_view bytes;
    std::filesystem::path file = {};
    std::uintmax_t begin = 0;  ///< in the file
};

/// The data after a head. \param rest of the content, behind the head
/// \param content the beginning of the file, or all there is, if the file has no name \throws FileError
StoredData data_behind_head(std::string_view rest, std::string_view content, const std::filesystem::path& file);

struct StoredImage {
    std::vector<std::int64_t> sizes;  ///< along the axes; those beyond the third have to be 1
    std::int64_t channels = 1;        ///< values a voxel, which have to be one
    Image frame;                      ///< origin, steps, unit and space
    NumberType type = NumberType::kU1;
    std::endian order = std::endian::little;
    bool is_last_axis_fastest = false;  ///< of numbers that are not packed; else it is the first
    Packing packing = Packing::kNone;
    std::vector<StoredData> parts;  ///< one after the other, each with what is skipped before its numbers:
    std::int64_t skipped_lines = 0;
    std::int64_t skipped_bytes = 0;  ///< once they are unpacked; -1: the numbers are at the end
    bool is_exact = false;           ///< nothing may follow the numbers
};

/// \throws FileError unless it is one volume, of a size and at a place that an image can have, and all its numbers are
/// there. No memory is taken for what the head promises and the data cannot hold.
Image read_stored(const StoredImage& stored);

/// The first half of it: sizes and place.
Image frame_of(const StoredImage& stored);

/// Throws a `FileError` unless as many bytes of data were found as the head promises.
void check_bytes(std::uintmax_t promised, std::uintmax_t found);

/// More bytes than DEFLATE can make of one.
inline constexpr std::uintmax_t kMostInflated = 1100;

/// The same where they are packed. \param most_from_byte what can be made of a packed byte
void check_packed_bytes(std::uintmax_t promised, std::uintmax_t packed, std::uintmax_t most_from_byte = kMostInflated);

/// The error of a head in memory whose data are in a file. \param name `, 'NAME'`, or empty
FileError data_apart(const std::string& name);

/// \param line of a head, as people count
[[noreturn]] void fail_at_line(std::size_t line, const std::string& what);

/// Is it a number of a place: finite, and far from where products of three overflow?
bool is_of_place(double value);
/// The same for a distance of voxels, which is not 0 and has no reciprocal that is too large.
bool is_spacing(double value);

}  // namespace scaleaxis::io
