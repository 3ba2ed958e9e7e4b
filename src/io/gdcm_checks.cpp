// SPDX-License-Identifier: Apache-2.0
//
// DICOM (PS3.5, "Data Structures and Encoding"; PS3.10, "Media Storage"): elements one after the other, each with its
// length, some with sequences of elements in them. GDCM stops the program over what it does not expect: it only sees
// files whose elements have been walked over.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "io/bytes.hpp"
#include "io/faults.hpp"
#include "io/formats.hpp"
#include "io/stored_image.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr std::uint32_t kItem = 0xfffee000;
constexpr std::uint32_t kItemEnd = 0xfffee00d;
constexpr std::uint32_t kSequenceEnd = 0xfffee0dd;
constexpr std::uint32_t kTransferSyntax = 0x00020010;
constexpr std::uint32_t kPixelData = 0x7fe00010;

/// Kinds of values with a length of 16 bits, and with one of 32.
constexpr auto kShortKinds =
    std::to_array<std::string_view>({"AE", "AS", "AT", "CS", "DA", "DS", "DT", "FD", "FL", "IS", "LO",
                                     "LT", "PN", "SH", "SL", "SS", "ST", "TM", "UI", "UL", "US"});
constexpr auto kLongKinds =
    std::to_array<std::string_view>({"OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV", "UC", "UN", "UR", "UT", "UV"});

struct Encoding {
    std::endian order = std::endian::little;
    bool has_kinds = true;
};

/// The head of an element.
struct Element {
    std::uint32_t tag = 0;  ///< group and number
    std::string_view kind;  ///< empty: not said
    std::uint32_t length = 0;
};

/// Walks over all elements, and keeps the values of those outside sequences.
class Walk {
   public:
    explicit Walk(std::string_view content) : content_(content), at_(kPreamble) {}

    void run() {
        while (at_ < content_.size() && group_at(std::endian::little) == 2) {
            element(Encoding{}, 0);
        }
        const std::string syntax = text(kTransferSyntax);
        if (syntax.empty() || syntax == "1.2.840.10008.1.2.1.99") {
            throw unsupported("it is DICOM without a transfer syntax, or a deflated one; convert it to NIfTI or NRRD");
        }
        const Encoding encoding{.order = syntax == "1.2.840.10008.1.2.2" ? std::endian::big : std::endian::little,
                                .has_kinds = syntax != "1.2.840.10008.1.2"};
        do {
            element(encoding, 0);
        } while (at_ < content_.size());
        order_ = encoding.order;
    }

    /// The value of an element as text, without padding; empty if it is absent.
    std::string text(std::uint32_t tag) const {
        const auto found = values_.find(tag);
        std::string_view value = found == values_.end() ? std::string_view() : found->second;
        while (value.ends_with(' ') || value.ends_with('\0')) {
            value.remove_suffix(1);
        }
        return std::string(value);
    }
    /// The value of an element as an integer of 16 bits.
    std::optional<std::uint16_t> integer(std::uint32_t tag) const {
        const auto found = values_.find(tag);
        return found == values_.end() || found->second.size() != 2
                   ? std::nullopt
                   : std::optional(from_bytes<std::uint16_t>(found->second.data(), order_));
    }
    bool has_voxels() const { return has_voxels_; }
    /// The bytes of the voxels; none if they are packed.
    std::optional<std::size_t> voxel_bytes() const {
        const auto found = values_.find(kPixelData);
        return found == values_.end() ? std::nullopt : std::optional(found->second.size());
    }

   private:
    static constexpr std::size_t kPreamble = 132;
    static constexpr int kDeepest = 16;

    template <class Number>
    Number number_at(std::size_t at, std::endian order) const {
        if (at > content_.size() || content_.size() - at < sizeof(Number)) {
            throw truncated("the DICOM file ends too early");
        }
        return from_bytes<Number>(content_.data() + at, order);
    }
    template <class Number>
    Number take(std::endian order) {
        const Number number = number_at<Number>(at_, order);
        at_ += sizeof(Number);
        return number;
    }
    std::uint16_t group_at(std::endian order) const { return number_at<std::uint16_t>(at_, order); }

    [[noreturn]] void fail(const std::string& what) const {
        throw FileError(Diagnostic{
            "file.damaged",
            "it is no valid DICOM file: at byte " + std::to_string(at_) + ' ' + what + "; convert it to NIfTI or NRRD",
            "byte", static_cast<std::int64_t>(at_)});
    }

    Element head(const Encoding& encoding) {
        Element element;
        const auto group = take<std::uint16_t>(encoding.order);
        element.tag = std::uint32_t{group} << 16 | take<std::uint16_t>(encoding.order);
        if (group == 0xfffe || !encoding.has_kinds) {
            element.length = take<std::uint32_t>(encoding.order);
            return element;
        }
        number_at<std::uint16_t>(at_, encoding.order);
        element.kind = content_.substr(at_, 2);
        if (std::ranges::find(kShortKinds, element.kind) != kShortKinds.end()) {
            at_ += 2;
            element.length = take<std::uint16_t>(encoding.order);
        } else if (std::ranges::find(kLongKinds, element.kind) != kLongKinds.end()) {
            at_ += 4;
            element.length = take<std::uint32_t>(encoding.order);
        } else {
            fail("there is an element of the unknown kind " + io::quoted(element.kind));
        }
        return element;
    }

    void skip(std::uint32_t length) {
        if (length > content_.size() - at_) {
            throw truncated("the DICOM file ends too early");
        }
        at_ += length;
    }

    void element(const Encoding& encoding, int depth) {
        const Element found = head(encoding);
        has_voxels_ = has_voxels_ || (depth == 0 && found.tag == kPixelData);
        if (found.tag >> 16 == 0xfffe || depth > kDeepest) {
            fail("there is the end of an item without its beginning, or there are too many sequences in each other");
        }
        if (found.length == kUndefined) {
            if (found.tag == kPixelData) {
                fragments(encoding);
            } else if (found.kind == "SQ" || found.kind.empty()) {
                items(encoding, std::nullopt, depth);
            } else {
                fail("there is an element without a length");
            }
        } else if (found.kind == "SQ") {
            const std::size_t end = at_ + found.length;
            if (found.length > content_.size() - at_) {
                throw truncated("the DICOM file ends too early");
            }
            items(encoding, end, depth);
        } else {
            const std::size_t begin = at_;
            skip(found.length);
            if (depth == 0) {
                if (!values_.emplace(found.tag, content_.substr(begin, found.length)).second) {
                    fail("there is an element twice");
                }
            }
        }
    }

    /// The items of a sequence, up to its end or, if that is not known, to a mark.
    void items(const Encoding& encoding, std::optional<std::size_t> end, int depth) {
        while (!end || at_ < *end) {
            const Element item = head(encoding);
            if (item.tag == kSequenceEnd && item.length == 0) {
                return;
            }
            if (item.tag != kItem) {
                fail("there is no item of a sequence where one should be");
            }
            if (item.length == kUndefined) {
                while (!is_item_end(encoding)) {
                    element(encoding, depth + 1);
                }
                at_ += 8;
            } else {
                const std::size_t item_end = at_ + item.length;
                while (at_ < item_end) {
                    element(encoding, depth + 1);
                }
                if (at_ != item_end) {
                    fail("there is an element that is longer than the item that it is in");
                }
            }
        }
        if (at_ != *end) {
            fail("there is an item that is longer than the sequence that it is in");
        }
    }

    bool is_item_end(const Encoding& encoding) const {
        return (std::uint32_t{number_at<std::uint16_t>(at_, encoding.order)} << 16 |
                number_at<std::uint16_t>(at_ + 2, encoding.order)) == kItemEnd;
    }

    /// Packed voxels.
    void fragments(const Encoding& encoding) {
        while (true) {
            const Element item = head(encoding);
            if (item.tag == kSequenceEnd) {
                return;
            }
            if (item.tag != kItem || item.length == kUndefined) {
                fail("there is no part of the voxels where one should be");
            }
            skip(item.length);
        }
    }

    std::string_view content_;
    std::size_t at_ = 0;
    std::endian order_ = std::endian::little;
    std::map<std::uint32_t, std::string_view> values_;
    bool has_voxels_ = false;
};

/// The numbers of an element of text, which backslashes separate, are what an image can have.
void check_numbers(const Walk& walk, std::uint32_t tag, const std::string& name) {
    std::string text = walk.text(tag);
    std::ranges::replace(text, '\\', ' ');
    TextReader reader(text);
    for (std::string_view word = reader.any_word(); !word.empty(); word = reader.any_word()) {
        const std::optional<double> number = parse_number(word);
        if (!number || !is_of_place(*number)) {
            throw damaged("its " + name + " is " + io::quoted(text) + ", which no image has");
        }
    }
}

void check_sizes(const Walk& walk) {
    const auto size = [&](std::uint32_t tag) { return std::uintmax_t{walk.integer(tag).value_or(0)}; };
    const std::string frames = walk.text(0x00280008);
    const std::optional<std::int64_t> depth = frames.empty() ? 1 : parse_integer(frames);
    if (size(0x00280010) == 0 || size(0x00280011) == 0 || !depth || *depth < 1 || *depth > 1'000'000) {
        throw damaged("its head says a size that no image has");
    }
    const std::uintmax_t bits = size(0x00280100);
    if (bits == 0 || bits > 64 || bits % 8 != 0 || size(0x00280101) > bits || size(0x00280102) >= bits) {
        throw unsupported("its values have " + std::to_string(bits) + " bits, which cannot be read");
    }
    const std::uintmax_t samples = std::max<std::uintmax_t>(1, size(0x00280002));
    if (const std::optional<std::size_t> found = walk.voxel_bytes()) {
        check_bytes(size(0x00280010) * size(0x00280011) * static_cast<std::uintmax_t>(*depth) * samples * bits / 8,
                    *found);
    }
}

}  // namespace

bool check_dicom(std::string_view content) {
    Walk walk(content);
    walk.run();
    if (walk.has_voxels()) {  // others of a folder may have none
        check_sizes(walk);
    }
    check_numbers(walk, 0x00180050, "slice thickness");
    check_numbers(walk, 0x00180088, "spacing between slices");
    check_numbers(walk, 0x00200032, "position");
    check_numbers(walk, 0x00200037, "orientation");
    check_numbers(walk, 0x00280030, "pixel spacing");
    check_numbers(walk, 0x00281052, "rescale intercept");
    check_numbers(walk, 0x00281053, "rescale slope");
    return walk.has_voxels();
}

}  // namespace scaleaxis::io
