// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace scaleaxis::io {

bool is_gzip(std::string_view content);

/// What gzip or zlib made of it, up to `most` bytes of it.
/// \param may_be_damaged returns what can be had in place of a `FileError`
std::string inflated(std::string_view content, std::size_t most, bool may_be_damaged = false);

/// What DEFLATE made of it without a head, up to `most` bytes. \throws FileError
std::string inflated_raw(std::string_view content, std::size_t most);

/// How many bytes gzip or zlib made it of; up to the damage, if there is one.
std::uintmax_t inflated_size(std::string_view content);

}  // namespace scaleaxis::io
