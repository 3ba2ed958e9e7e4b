// SPDX-License-Identifier: Apache-2.0
/// \file
/// Numbers in binary files.
#pragma once

#include <algorithm>
#include <array>
#include <bit>

namespace scaleaxis::inline v1 {

template <class T>
using Bytes = std::array<char, sizeof(T)>;

/// The bytes of `value` in the given order.
template <class T>
Bytes<T> to_bytes(T value, std::endian order) {
    auto bytes = std::bit_cast<Bytes<T>>(value);
    if (order != std::endian::native) {
        std::ranges::reverse(bytes);
    }
    return bytes;
}

/// The value whose bytes begin at `data` in the given order.
template <class T>
T from_bytes(const char* data, std::endian order) {
    Bytes<T> bytes;
    std::copy_n(data, sizeof(T), bytes.begin());
    if (order != std::endian::native) {
        std::ranges::reverse(bytes);
    }
    return std::bit_cast<T>(bytes);
}

}  // namespace scaleaxis::inline v1
