// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the Insight Toolkit does not notice by itself: data that end too early, which it fills with anything; heads that
// promise more than the file can hold, for which it takes the memory; and what makes it stop the program or never end.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "io/bytes.hpp"
#include "io/compressed.hpp"
#include "io/formats.hpp"
#include "io/input_file.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::io {
namespace {

namespace fs = std::filesystem;

/// Of all compressions that these formats have, none makes a file smaller by more.
constexpr std::uintmax_t kMostPacked = 1100;

void check_bytes(std::uintmax_t promised, std::uintmax_t found) {
    if (found < promised) {
        throw FileError("its head says " + std::to_string(promised) + " bytes of data, but there are " +
                        std::to_string(found));
    }
}

/// For what cannot be told without unpacking: are there enough of them for anything?
void check_packed_bytes(std::uintmax_t promised, std::uintmax_t packed) {
    if (packed < promised / kMostPacked) {
        throw FileError("its head says " + std::to_string(promised) + " bytes of data, which are not in the " +
                        std::to_string(packed) + " bytes that there are");
    }
}

std::uintmax_t size_of_data(const fs::path& file) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) {
        throw FileError("its data file " + file.filename().string() + ": " + error.message());
    }
    return size;
}

/// What follows `key` at the beginning of a line of a head; empty if no line has it.
std::string value_of(std::string_view content, const std::string& key) {
    const std::size_t at = content.find("\n" + key);
    if (at == std::string_view::npos) {
        return {};
    }
    const std::size_t begin = std::min(content.find_first_not_of(' ', at + 1 + key.size()), content.size());
    return std::string(content.substr(begin, content.find_first_of("\r\n", begin) - begin));
}

void check_nifti(const fs::path& file, std::string_view content) {
    constexpr std::size_t kHead = 348;
    const std::string unpacked = is_gzip(content) ? inflated(content, kHead, true) : "";
    const std::string_view head = is_gzip(content) ? std::string_view(unpacked) : content;
    if (head.size() < kHead) {
        return;  // no reader takes it
    }
    const auto is_in = [&](std::endian order) { return from_bytes<std::int32_t>(head.data(), order) == kHead; };
    if (!is_in(std::endian::little) && !is_in(std::endian::big)) {
        return;  // version 2, which no reader takes either
    }
    const std::endian order = is_in(std::endian::little) ? std::endian::little : std::endian::big;
    const auto short_at = [&](std::size_t at) { return from_bytes<std::int16_t>(head.data() + at, order); };
    const auto check_finite = [&](std::size_t at, int count) {
        for (int i = 0; i < count; ++i) {
            if (!std::isfinite(from_bytes<float>(head.data() + at + 4 * i, order))) {
                throw FileError("its spacing, origin or directions are no finite numbers");
            }
        }
    };
    check_finite(80, 3);
    if (short_at(252) > 0) {
        check_finite(256, 6);
    }
    if (short_at(254) > 0) {
        check_finite(280, 12);
    }
    double bits = short_at(72);  // of a voxel
    for (int d = 1; d <= short_at(40) && d <= 7; ++d) {
        bits *= short_at(40 + 2 * d);
    }
    const float offset = from_bytes<float>(head.data() + 108, order);
    if (!(bits > 0.0 && bits < 0x1p60 && offset >= 0.0F && offset < 0x1p31F)) {
        throw FileError("its head says a size that no image has");
    }
    const auto promised = static_cast<std::uintmax_t>(offset) + static_cast<std::uintmax_t>(bits / 8.0);
    const fs::path data = fs::path(file).replace_extension(".img");
    if (head.substr(344).starts_with("n")) {
        check_bytes(promised, is_gzip(content) ? inflated_size(content) : content.size());
    } else if (fs::exists(data)) {  // a pair of files, this one without data
        check_bytes(promised, size_of_data(data));
    }
}

/// Pages that refer to each other in a circle, lie beyond the end of the file, or have different sizes.
void check_tiff(std::string_view content) {
    const std::endian order = content.starts_with("I") ? std::endian::little : std::endian::big;
    const bool is_big = content.substr(0, 4).find('+') != std::string_view::npos;
    const std::size_t offset_bytes = is_big ? 8 : 4;
    const std::size_t count_bytes = is_big ? 8 : 2;
    const std::size_t entry_bytes = is_big ? 20 : 12;
    std::set<std::uint64_t> pages;
    std::optional<std::array<std::uint64_t, 2>> size;
    const auto number_at = [&](std::uint64_t at, std::size_t bytes) -> std::uint64_t {
        if (at > content.size() || content.size() - at < bytes) {
            throw FileError("the file ends before its page " + std::to_string(pages.size()) + " does");
        }
        const char* data = content.data() + at;
        return bytes == 2   ? from_bytes<std::uint16_t>(data, order)
               : bytes == 4 ? from_bytes<std::uint32_t>(data, order)
                            : from_bytes<std::uint64_t>(data, order);
    };
    std::uint64_t next = number_at(is_big ? 8 : 4, offset_bytes);
    while (next != 0) {
        if (!pages.insert(next).second) {
            throw FileError("its page " + std::to_string(pages.size()) + " refers to an earlier one");
        }
        const std::uint64_t count = number_at(next, count_bytes);
        if (count > content.size() / entry_bytes) {
            throw FileError("its page " + std::to_string(pages.size()) + " has a size that none has");
        }
        std::array<std::uint64_t, 2> page{};
        bool is_preview = false;
        for (std::uint64_t entry = next + count_bytes; entry < next + count_bytes + count * entry_bytes;
             entry += entry_bytes) {
            constexpr std::uint64_t kKind = 254, kWidth = 256, kHeight = 257, kShort = 3;
            const std::uint64_t tag = number_at(entry, 2);
            if (tag == kKind || tag == kWidth || tag == kHeight) {
                const std::uint64_t value =
                    number_at(entry + 4 + offset_bytes, number_at(entry + 2, 2) == kShort ? 2 : 4);
                if (tag == kKind) {
                    is_preview = value % 2 == 1;
                } else {
                    page[tag - kWidth] = value;
                }
            }
        }
        if (!is_preview) {
            if (size.value_or(page) != page) {
                throw FileError("its page " + std::to_string(pages.size()) + " has another size than those before it");
            }
            size = page;
        }
        next = number_at(next + count_bytes + count * entry_bytes, offset_bytes);
    }
}

/// The elements at the beginning, and the end of the voxels, which come last.
void check_dicom(std::string_view content) {
    using namespace std::string_view_literals;
    const auto fail = [] { throw FileError("the DICOM file ends too early"); };
    const auto number_at = [&](std::size_t at) {
        if (content.size() < at + 4) {
            fail();
        }
        return std::size_t{from_bytes<std::uint32_t>(content.data() + at, std::endian::little)};
    };
    for (std::size_t at = 132; content.substr(at).starts_with("\x02\x00"sv);) {
        const std::size_t word = number_at(at + 4);  // the kind, and the length unless that has a word of its own
        const bool is_long = content.substr(at + 4).starts_with("O") || content.substr(at + 4).starts_with("U");
        const std::size_t length =
            is_long && content.substr(at + 6).starts_with("\0\0"sv) ? number_at(at + 8) + 12 : (word >> 16) + 8;
        if (length > content.size() - at) {
            fail();
        }
        at += length;
    }
    constexpr std::size_t kUndefined = 0xffffffff;
    const std::size_t voxels = content.rfind("\xe0\x7f\x10\x00"sv);
    if (voxels != std::string_view::npos) {
        const bool has_kind = content.substr(voxels + 4).starts_with("O");
        const std::size_t begin = voxels + (has_kind ? 12 : 8);
        const std::size_t length = number_at(begin - 4);
        const bool ends = length == kUndefined ? content.rfind("\xfe\xff\xdd\xe0"sv) != std::string_view::npos
                                               : begin + length <= content.size();
        if (!ends) {
            fail();
        }
    }
}

void check_nrrd(const fs::path& file, std::string_view content, std::uintmax_t bytes) {
    const std::string_view head = content.substr(0, content.find("\n\n"));
    std::string data = value_of(head, "data file: ");
    if (data.empty()) {
        data = value_of(head, "datafile: ");
    }
    if (data.starts_with("LIST") || data.find('%') != std::string::npos) {
        return;
    }
    const std::uintmax_t found = data.empty() ? content.size() : size_of_data(file.parent_path() / data);
    value_of(head, "encoding: ") == "raw" ? check_bytes(bytes, found) : check_packed_bytes(bytes, found);
}

void check_meta_image(const fs::path& file, std::string_view content, std::uintmax_t bytes) {
    const std::string data = value_of(content, "ElementDataFile =");
    const bool is_local = to_lower(data) == "local";
    const std::size_t head = content.find('\n', content.find("\nElementDataFile") + 1) + 1;
    if (data == "LIST") {
        std::uintmax_t found = 0;
        TextReader names(content.substr(head));
        for (std::string_view name = names.any_word(); !name.empty(); name = names.any_word()) {
            found += size_of_data(file.parent_path() / name);
        }
        check_bytes(bytes, found);
        return;
    }
    if (data.find_first_of(" %") != std::string::npos) {
        throw FileError("its data are in several files, " + io::quoted(data) +
                        ": this is only read with their names in a " + "LIST");
    }
    if (to_lower(value_of(content, "CompressedData =")) != "true") {
        check_bytes(bytes, is_local ? content.size() - head : size_of_data(file.parent_path() / data));
        return;
    }
    if (is_local && value_of(content, "CompressedDataSize =").empty()) {
        throw FileError("its head says no CompressedDataSize");
    }
    check_bytes(bytes,
                is_local ? inflated_size(content.substr(head)) : inflated_size(read_file(file.parent_path() / data)));
}

void check_vtk_image(std::string_view content, std::uintmax_t voxels, std::uintmax_t bytes) {
    constexpr std::size_t kMostOfHead = 4096;
    const std::string head = to_lower(content.substr(0, kMostOfHead));
    const auto next_line = [&](std::size_t at) { return std::min(head.find('\n', at), content.size() - 1) + 1; };
    std::size_t begin = head.find("\nscalars");
    if (begin == std::string::npos) {
        return;  // no reader takes it
    }
    begin = next_line(begin + 1);
    if (head.substr(begin).starts_with("lookup_table")) {
        begin = next_line(begin);
    }
    if (head.find("\nascii") > head.find("\ndataset")) {
        check_bytes(bytes, content.size() - begin);
        return;
    }
    TextReader words(content.substr(begin));
    std::uintmax_t found = 0;
    while (found < voxels && !words.any_word().empty()) {
        ++found;
    }
    if (found < voxels) {
        throw FileError("its head says " + std::to_string(voxels) + " values, but there are " + std::to_string(found));
    }
}

}  // namespace

void check_itk_head(const fs::path& file, std::string_view content) {
    if (is_nifti(content)) {
        check_nifti(file, content);
    } else if (is_tiff(content)) {
        check_tiff(content);
    } else if (is_dicom(content)) {
        check_dicom(content);
    }
}

void check_itk_length(const fs::path& file, std::string_view content, std::uintmax_t voxels, std::uintmax_t bytes) {
    if (is_nrrd(content)) {
        check_nrrd(file, content, bytes);
    } else if (is_meta_image(content)) {
        check_meta_image(file, content, bytes);
    } else if (is_vtk_image(content)) {
        check_vtk_image(content, voxels, bytes);
    } else if (!is_nifti(content)) {
        check_packed_bytes(bytes, content.size());
    }
}

}  // namespace scaleaxis::io
