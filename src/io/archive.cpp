// SPDX-License-Identifier: Apache-2.0
#include "io/archive.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstddef>

#include "base/bytes.hpp"
#include "base/faults.hpp"
#include "base/formats/compressed.hpp"
#include "io/input_file.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::uint64_t kUnknown32 = 0xFFFFFFFF;  // the number is one of 64 bits elsewhere
constexpr std::uint64_t kMostDeflated = 1032;     // what DEFLATE makes of one byte
constexpr std::uint64_t kStored = 0;
constexpr std::uint64_t kDeflated = 8;

FileError no_archive() { return damaged("the directory of the archive is damaged"); }

std::string_view piece(std::string_view archive, std::uint64_t at, std::uint64_t size) {
    if (at > archive.size() || archive.size() - at < size) {
        throw no_archive();
    }
    return archive.substr(at, size);
}

/// The unsigned number of this type at a place.
template <class T>
std::uint64_t number(std::string_view archive, std::uint64_t at) {
    return from_bytes<T>(piece(archive, at, sizeof(T)).data(), std::endian::little);
}

std::uint64_t u16(std::string_view archive, std::uint64_t at) { return number<std::uint16_t>(archive, at); }
std::uint64_t u32(std::string_view archive, std::uint64_t at) { return number<std::uint32_t>(archive, at); }
std::uint64_t u64(std::string_view archive, std::uint64_t at) { return number<std::uint64_t>(archive, at); }

struct Directory {
    std::uint64_t entries = 0;
    std::uint64_t begin = 0;
};

Directory find_directory(std::string_view archive) {
    constexpr std::size_t kEndSize = 22;
    const std::size_t end = archive.rfind("PK\x05\x06");
    if (end == archive.npos || archive.size() - end < kEndSize) {
        throw truncated("the archive has no directory at its end: it is truncated");
    }
    Directory directory{u16(archive, end + 10), u32(archive, end + 16)};
    constexpr std::size_t kLocatorSize = 20;
    if (directory.begin == kUnknown32 && end >= kLocatorSize) {
        const std::uint64_t long_end = u64(archive, end - kLocatorSize + 8);
        directory = {u64(archive, long_end + 32), u64(archive, long_end + 48)};
    }
    return directory;
}

/// The numbers of an entry, which stand in a further field where they are too large for the usual one.
struct Entry {
    std::uint64_t size;
    std::uint64_t packed;
    std::uint64_t header;
};

void read_long_numbers(std::string_view extra, Entry& entry) {
    for (std::uint64_t at = 0; at + 4 <= extra.size(); at += 4 + u16(extra, at + 2)) {
        if (u16(extra, at) == 1) {
            std::uint64_t next = at + 4;
            for (std::uint64_t* value : {&entry.size, &entry.packed, &entry.header}) {
                if (*value == kUnknown32) {
                    *value = u64(extra, next);
                    next += sizeof(std::uint64_t);
                }
            }
        }
    }
}

}  // namespace

std::vector<ArchivePart> archive_parts(std::string_view archive) {
    constexpr std::uint64_t kEntrySize = 46;
    constexpr std::uint64_t kHeaderSize = 30;
    const Directory directory = find_directory(archive);
    std::vector<ArchivePart> parts;
    std::uint64_t total = 0;
    std::uint64_t at = directory.begin;
    for (std::uint64_t i = 0; i < directory.entries; ++i) {
        if (piece(archive, at, 4) != "PK\x01\x02") {
            throw no_archive();
        }
        Entry entry{u32(archive, at + 24), u32(archive, at + 20), u32(archive, at + 42)};
        const std::uint64_t name_size = u16(archive, at + 28);
        const std::uint64_t extra_size = u16(archive, at + 30);
        const std::string_view name = piece(archive, at + kEntrySize, name_size);
        read_long_numbers(piece(archive, at + kEntrySize + name_size, extra_size), entry);
        const std::uint64_t method = u16(archive, at + 10);
        if ((u16(archive, at + 8) & 1) != 0 || (method != kStored && method != kDeflated)) {
            throw unsupported("a part of the archive is encrypted, or packed in an unusual way: pack it by DEFLATE");
        }
        if (piece(archive, entry.header, 4) != "PK\x03\x04") {
            throw no_archive();
        }
        const std::uint64_t data =
            entry.header + kHeaderSize + u16(archive, entry.header + 26) + u16(archive, entry.header + 28);
        const std::string_view packed = piece(archive, data, entry.packed);
        if (entry.size / kMostDeflated > packed.size() || (method == kStored && entry.size != packed.size())) {
            throw damaged("a part of the archive cannot have the size that its directory says");
        }
        check_size(total += std::max<std::uint64_t>(entry.size, 1));
        parts.push_back({std::string(name), packed, entry.size, static_cast<std::uint32_t>(u32(archive, at + 16)),
                         method == kStored});
        at += kEntrySize + name_size + extra_size + u16(archive, at + 32);
    }
    return parts;
}

std::string unpacked(const ArchivePart& part) {
    std::string result = part.is_stored ? std::string(part.packed) : inflated_raw(part.packed, part.size);
    const auto* bytes = reinterpret_cast<const Bytef*>(result.data());
    if (result.size() != part.size || crc32(0, bytes, static_cast<uInt>(result.size())) != part.sum) {
        throw damaged("the part '" + part.name + "' of the archive is damaged");
    }
    return result;
}

}  // namespace scaleaxis::io
