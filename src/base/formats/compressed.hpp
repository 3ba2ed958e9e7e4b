// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bytes that are unpacked piece by piece, so that no unpacked copy is held in memory.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace scaleaxis::inline v1 {

/// Writes the next bytes of some data and returns how many: fewer than `most` at their end only. Copies share their
/// place in the data.
using ByteSource = std::function<std::size_t(char* to, std::size_t most)>;

ByteSource bytes_of(std::string_view content);

/// What gzip (of several members, too) or zlib made of the packed bytes, up to where they are torn off.
/// \throws FileError if they are damaged
ByteSource inflating(ByteSource packed);

/// The same for bzip2.
ByteSource bunzipping(ByteSource packed);

bool is_gzip(std::string_view content);

/// What gzip or zlib made of it, up to `most` bytes of it. \throws FileError
std::string inflated(std::string_view content, std::size_t most);

/// The first bytes of it, unpacked if it is gzip, as far as can be.
std::string beginning_of(std::string_view content, std::size_t most);

/// What DEFLATE made of it without a head, up to `most` bytes. \throws FileError
std::string inflated_raw(std::string_view content, std::size_t most);

}  // namespace scaleaxis::inline v1
