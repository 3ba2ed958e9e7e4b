// SPDX-License-Identifier: Apache-2.0
#include "io/images/stored_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "base/faults.hpp"
#include "base/formats/compressed.hpp"
#include "io/input_file.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::io {
namespace {

constexpr double kMostOfPlace = 1e12;
constexpr std::size_t kChunk = std::size_t{1} << 20;  // bytes, of whole numbers

std::size_t voxels_of(const StoredImage& stored) {
    std::size_t voxels = 1;
    for (const std::int64_t size : stored.sizes) {
        voxels *= static_cast<std::size_t>(size);
    }
    return voxels;
}

/// The size of a part as it is stored.
std::uintmax_t size_of(const StoredData& data) {
    const std::uintmax_t in_file = data.file.empty() ? 0 : size_of_file(data.file);
    return data.bytes.size() + in_file - std::min(in_file, data.begin);
}

ByteSource stored_bytes(const StoredData& data) {
    ByteSource beginning = bytes_of(data.bytes);
    if (data.file.empty()) {
        return beginning;
    }
    return [beginning = std::move(beginning), rest = bytes_of_file(data.file, data.begin)](char* to, std::size_t most) {
        const std::size_t count = beginning(to, most);
        return count < most ? count + rest(to + count, most - count) : count;
    };
}

/// Two hexadecimal digits a byte, with blanks anywhere.
ByteSource from_hex(ByteSource text) {
    return [text = std::move(text)](char* to, std::size_t most) {
        std::size_t count = 0;  // of digits
        for (char c = 0; count < 2 * most && text(&c, 1) == 1;) {
            if (std::string_view(" \t\r\n\v\f").find(c) != std::string_view::npos) {
                continue;
            }
            const std::size_t digit = std::string_view("0123456789abcdef").find(to_lower({&c, 1}));
            if (digit == std::string_view::npos) {
                throw damaged(io::quoted({&c, 1}) + " is no hexadecimal digit");
            }
            to[count / 2] =
                static_cast<char>(count % 2 == 0 ? digit << 4 : static_cast<unsigned char>(to[count / 2]) | digit);
            ++count;
        }
        return count / 2;
    };
}

/// Skips at most `bytes` bytes; returns how many there were.
std::uintmax_t skip(const ByteSource& source, std::uintmax_t bytes) {
    std::vector<char> buffer(static_cast<std::size_t>(std::min<std::uintmax_t>(kChunk, bytes)));
    std::uintmax_t total = 0;
    for (std::size_t asked = 1, count = 1; count == asked && total < bytes; total += count) {
        asked = static_cast<std::size_t>(std::min<std::uintmax_t>(buffer.size(), bytes - total));
        count = source(buffer.data(), asked);
    }
    return total;
}

ByteSource unpacked_bytes(const StoredImage& stored, const StoredData& part) {
    ByteSource source = stored_bytes(part);
    char c = 0;
    for (std::int64_t line = 0; line < stored.skipped_lines && source(&c, 1) == 1; line += c == '\n' ? 1 : 0) {
    }
    return stored.packing == Packing::kZlib    ? inflating(std::move(source))
           : stored.packing == Packing::kBzip2 ? bunzipping(std::move(source))
           : stored.packing == Packing::kHex   ? from_hex(std::move(source))
                                               : source;
}

/// The same without what is skipped. \param promised bytes
ByteSource number_bytes(const StoredImage& stored, const StoredData& part, std::uintmax_t promised) {
    auto skipped = static_cast<std::uintmax_t>(stored.skipped_bytes);
    if (stored.skipped_bytes < 0) {
        const std::uintmax_t all = skip(unpacked_bytes(stored, part), std::numeric_limits<std::uintmax_t>::max());
        check_bytes(promised, all);
        skipped = all - promised;
    }
    ByteSource source = unpacked_bytes(stored, part);
    skip(source, skipped);
    return source;
}

/// Where a number belongs in an image whose first axis runs fastest, if `before` come before it in an array of its
/// sizes whose last one does.
std::size_t transposed(std::size_t before, const std::vector<std::int64_t>& sizes) {
    const auto size = [&](int axis) { return static_cast<std::size_t>(sizes[axis]); };
    const std::size_t row = before / size(2);
    return (before % size(2) * size(1) + row % size(1)) * size(0) + row / size(1);
}

std::vector<float> read_binary(const StoredImage& stored, std::size_t voxels, std::uintmax_t stored_bytes) {
    const std::size_t bytes = bytes_per_number(stored.type);
    if (stored.parts.empty() || voxels % stored.parts.size() != 0) {
        throw damaged("its " + std::to_string(voxels) + " voxels cannot be in " + std::to_string(stored.parts.size()) +
                      " files of one size");
    }
    const std::size_t end_of_part = voxels / stored.parts.size();
    std::vector<float> values;
    // bzip2 may make more of a byte: then the memory grows with what there is.
    values.reserve(static_cast<std::size_t>(std::min<std::uintmax_t>(voxels, stored_bytes * kMostInflated)));
    std::vector<char> buffer(kChunk);
    std::vector<float> numbers;
    std::size_t done = 0;
    std::uintmax_t found = 0;
    bool has_more = false;
    for (const StoredData& part : stored.parts) {
        const ByteSource source = number_bytes(stored, part, end_of_part * bytes);
        std::size_t left = end_of_part;
        for (bool has_ended = false; left > 0 && !has_ended;) {
            const std::size_t asked = std::min(left, buffer.size() / bytes);
            const std::size_t count = source(buffer.data(), asked * bytes);
            const std::size_t read = count / bytes;
            if (!stored.is_last_axis_fastest) {
                values.resize(done + read);
                read_numbers(buffer.data(), read, stored.type, stored.order, values.data() + done);
            } else {
                values.resize(voxels);
                numbers.resize(read);
                read_numbers(buffer.data(), read, stored.type, stored.order, numbers.data());
                for (std::size_t i = 0; i < read; ++i) {
                    values[transposed(done + i, stored.sizes)] = numbers[i];
                }
            }
            done += read;
            found += count;
            left -= read;
            has_ended = count < asked * bytes;
        }
        has_more = left == 0 && source(buffer.data(), 1) == 1;  // checks the sum at the end of packed data, too
    }
    check_bytes(voxels * bytes, found);
    if (stored.is_exact && has_more) {
        throw damaged("its head says " + std::to_string(found) + " bytes of data, but there are more");
    }
    return values;
}

std::vector<float> read_text(const StoredImage& stored, std::size_t voxels, std::uintmax_t stored_bytes) {
    constexpr std::string_view kSeparators = " ,\t\r\n\v\f";
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(std::min<std::uintmax_t>(voxels, stored_bytes / 2 + 1)));
    std::string word;
    for (const StoredData& part : stored.parts) {
        const ByteSource source = number_bytes(stored, part, 0);
        for (bool has_ended = false; (values.size() < voxels || stored.is_exact) && !has_ended;) {
            char c = ' ';
            has_ended = source(&c, 1) == 0;
            if (kSeparators.find(c) == std::string_view::npos) {
                word += c;
            } else if (!word.empty()) {
                const std::optional<double> number = parse_number(word);
                if (!number || !is_of_type(*number, stored.type)) {
                    throw damaged("its value " + std::to_string(values.size() + 1) + " of " + std::to_string(voxels) +
                                  " is " + io::quoted(word) + ", which is no number of its type");
                }
                values.push_back(as_float(*number));
                word.clear();
            }
        }
    }
    if (values.size() != voxels) {
        const std::string what =
            "its head says " + std::to_string(voxels) + " values, but there are " + std::to_string(values.size());
        throw values.size() < voxels ? truncated(what) : damaged(what);
    }
    return values;
}

}  // namespace

StoredData data_behind_head(std::string_view rest, std::string_view content, const std::filesystem::path& file) {
    if (rest.empty() && !file.empty() && size_of_file(file) > content.size()) {
        throw unsupported("its head does not end in its first " + std::to_string(content.size()) + " bytes");
    }
    return {rest, file, content.size()};
}

bool is_of_place(double value) { return std::abs(value) <= kMostOfPlace; }

bool is_spacing(double value) { return is_of_place(value) && std::abs(value) >= 1.0 / kMostOfPlace; }

void check_bytes(std::uintmax_t promised, std::uintmax_t found) {
    if (found < promised) {
        throw truncated("its head says " + std::to_string(promised) + " bytes of data, but there are " +
                        std::to_string(found));
    }
}

void check_packed_bytes(std::uintmax_t promised, std::uintmax_t packed, std::uintmax_t most_from_byte) {
    if (packed < promised / most_from_byte) {
        throw truncated("its head says " + std::to_string(promised) + " bytes of data, which are not in the " +
                        std::to_string(packed) + " bytes that there are");
    }
}

void fail_at_line(std::size_t line, const std::string& what) {
    throw FileError(Diagnostic{"file.syntax", "line " + std::to_string(line) + ": " + what, "line",
                               static_cast<std::int64_t>(line)});
}

FileError data_apart(const std::string& name) {
    return unsupported("its data are in a file of their own" + name + ": this is only read from a file beside it");
}

Image frame_of(const StoredImage& stored) {
    if (stored.channels != 1) {
        throw unsupported("the image has " + std::to_string(stored.channels) +
                          " values a voxel (colours, vectors?); one is needed");
    }
    if (stored.sizes.size() < 3) {
        throw unsupported("the image has " + std::to_string(stored.sizes.size()) + " dimensions; three are needed");
    }
    double voxels = 1.0;
    for (std::size_t axis = 0; axis < stored.sizes.size(); ++axis) {
        const std::int64_t size = stored.sizes[axis];
        voxels *= static_cast<double>(size);
        if (size < 1 || size > std::numeric_limits<Index>::max() || !(voxels < 0x1p40)) {
            throw damaged("its head says a size that no image has");
        }
        if (axis >= 3 && size > 1) {
            throw unsupported("the image has " + std::to_string(stored.sizes.size()) + " dimensions, of sizes up to " +
                              std::to_string(*std::max_element(stored.sizes.begin() + 3, stored.sizes.end())) +
                              " beyond the third; one volume is needed");
        }
    }
    Image image = stored.frame;
    const auto is_place = [](const Point& p) { return is_of_place(p.x) && is_of_place(p.y) && is_of_place(p.z); };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        image.sizes[axis] = static_cast<Index>(stored.sizes[axis]);
        if (!is_place(image.origin) || !is_place(image.steps[axis]) || !is_spacing(norm(image.steps[axis]))) {
            throw damaged("its spacing, origin or directions are no finite numbers that an image can have");
        }
    }
    return image;
}

Image read_stored(const StoredImage& stored) {
    Image image = frame_of(stored);
    const std::size_t voxels = voxels_of(stored);
    std::uintmax_t bytes = 0;
    std::uintmax_t usable_bytes = 0;
    for (const StoredData& part : stored.parts) {
        const std::uintmax_t size = size_of(part);
        bytes += size;
        usable_bytes +=
            size - std::min(size, static_cast<std::uintmax_t>(std::max<std::int64_t>(0, stored.skipped_bytes)));
    }
    if (stored.packing == Packing::kText) {
        image.values = read_text(stored, voxels, bytes);
        return image;
    }
    if (stored.packing == Packing::kNone) {
        check_bytes(voxels * bytes_per_number(stored.type), usable_bytes);
    }
    image.values = read_binary(stored, voxels, bytes);
    return image;
}

}  // namespace scaleaxis::io
