// SPDX-License-Identifier: Apache-2.0
//
// Assimp takes the memory that a head asks for: whether the content can fill it is looked at before.
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/bytes.hpp"
#include "io/faults.hpp"
#include "io/formats.hpp"

namespace scaleaxis::io {
namespace {

std::uint64_t u32(std::string_view content, std::size_t at) {
    return from_bytes<std::uint32_t>(content.data() + at, std::endian::little);
}

/// Binary glTF: a head of 12 bytes, and chunks with a head of 8.
void check_glb(std::string_view content) {
    constexpr std::size_t kHead = 12;
    constexpr std::size_t kChunkHead = 8;
    const auto fail = [&](std::uint64_t promised) {
        throw truncated("its head announces " + std::to_string(promised) + " bytes, the file has " +
                        std::to_string(content.size()) + ": it is truncated or damaged");
    };
    if (content.size() < kHead + kChunkHead) {
        throw truncated("the file ends within its head: it is truncated");
    }
    const std::uint64_t length = u32(content, 8);
    if (length > content.size()) {
        fail(length);
    }
    if (u32(content, 4) < 2) {
        return;  // of version 1, which has no chunks
    }
    for (std::uint64_t at = kHead; at + kChunkHead <= length;) {
        const std::uint64_t end = at + kChunkHead + u32(content, at);
        if (end > length) {
            fail(end);
        }
        at = end;
    }
}

}  // namespace

void check_scene(std::string_view content) {
    if (is_glb(content)) {
        check_glb(content);
    }
}

}  // namespace scaleaxis::io
