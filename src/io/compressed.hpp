// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace scaleaxis::io {

bool is_gzip(std::string_view content);

/// What gzip or zlib made of it, up to `most` bytes of it.
/// \param may_be_damaged returns what can be had in place of a `FileError`
std::string inflated(std::string_view content, std::size_t most, bool may_be_damaged = false);

}  // namespace scaleaxis::io
