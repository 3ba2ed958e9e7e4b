// SPDX-License-Identifier: Apache-2.0
//
// The pages of TIFF (Adobe, "TIFF Revision 6.0", 1992): a chain of directories of fields.
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "io/bytes.hpp"
#include "io/faults.hpp"
#include "io/itk_checks.hpp"

namespace scaleaxis::io {
namespace {

/// What all pages of a volume have in common. The toolkit takes it from the first one and believes that the others
/// have it too: a row of a page with fewer bits is read beyond its end.
struct Page {
    std::uint64_t width = 0;
    std::uint64_t height = 0;
    std::uint64_t bits = 1;  ///< of a sample; this and the next are what the format says for absent fields
    std::uint64_t samples = 1;
    std::uint64_t sample_format = 1;  ///< 1: unsigned, 2: signed, 3: floating point
    std::uint64_t planes = 1;
    std::uint64_t photometry = 0;
    std::optional<std::uint64_t> kind;  ///< 1: preview, 2: page, 4: mask

    bool is_ignored() const { return kind && (*kind & 5) != 0; }
    bool is_like(const Page& other) const {
        return bits == other.bits && samples == other.samples && sample_format == other.sample_format &&
               planes == other.planes && photometry == other.photometry;
    }
};

class Reader {
   public:
    explicit Reader(std::string_view content)
        : content_(content),
          order_(content.starts_with("I") ? std::endian::little : std::endian::big),
          is_big_(content.substr(0, 4).find('+') != std::string_view::npos) {
        next_ = number_at(is_big_ ? 8 : 4, offset_bytes());
    }

    bool is_at_end() const { return next_ == 0; }
    /// For messages.
    std::string name() const { return "its page " + std::to_string(begins_.size()); }

    Page next_page() {
        const std::uint64_t begin = next_;
        if (!begins_.insert(begin).second) {
            throw damaged(name() + " refers to an earlier one");
        }
        const std::size_t count_bytes = is_big_ ? 8 : 2;
        const std::size_t entry_bytes = is_big_ ? 20 : 12;
        const std::uint64_t count = number_at(begin, count_bytes);
        if (count > content_.size() / entry_bytes) {
            throw damaged(name() + " has a size that none has");
        }
        Page page;
        for (std::uint64_t i = 0; i < count; ++i) {
            read_field(begin + count_bytes + i * entry_bytes, page);
        }
        next_ = number_at(begin + count_bytes + count * entry_bytes, offset_bytes());
        return page;
    }

   private:
    std::size_t offset_bytes() const { return is_big_ ? 8 : 4; }

    std::uint64_t number_at(std::uint64_t at, std::size_t bytes) const {
        if (at > content_.size() || content_.size() - at < bytes) {
            throw truncated("the file ends before " + name() + " does");
        }
        const char* data = content_.data() + at;
        return bytes == 2   ? from_bytes<std::uint16_t>(data, order_)
               : bytes == 4 ? from_bytes<std::uint32_t>(data, order_)
                            : from_bytes<std::uint64_t>(data, order_);
    }

    void read_field(std::uint64_t at, Page& page) const {
        constexpr std::uint64_t kShort = 3;
        const std::uint64_t type = number_at(at + 2, 2);
        // The toolkit takes memory for all values of a field before it looks for them.
        constexpr std::array<std::uint64_t, 19> kBytes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
        const std::uint64_t bytes = type < kBytes.size() ? kBytes[type] : 0;
        if (bytes > 0 && number_at(at + 4, offset_bytes()) > content_.size() / bytes) {
            throw truncated(name() + " has a field with more values than there are in the file");
        }
        const auto value = [&] { return number_at(at + 4 + offset_bytes(), type == kShort ? 2 : 4); };
        // Several numbers are elsewhere: those of colours, of which the first is enough.
        const auto first = [&] {
            const std::uint64_t count = number_at(at + 4, offset_bytes());
            const bool is_here = count * 2 <= offset_bytes();
            return is_here ? value() : number_at(number_at(at + 4 + offset_bytes(), offset_bytes()), 2);
        };
        switch (number_at(at, 2)) {
            case 254:
                page.kind = value();
                break;
            case 256:
                page.width = value();
                break;
            case 257:
                page.height = value();
                break;
            case 258:
                page.bits = first();
                break;
            case 262:
                page.photometry = value();
                break;
            case 277:
                page.samples = value();
                break;
            case 284:
                page.planes = value();
                break;
            case 339:
                page.sample_format = first();
                break;
            default:
                break;
        }
    }

    std::string_view content_;
    std::endian order_;
    bool is_big_ = false;
    std::uint64_t next_ = 0;
    std::set<std::uint64_t> begins_;  ///< of the pages so far
};

void check_values(const Page& page) {
    if (page.samples == 1 && page.bits == 32 && page.sample_format != 3) {
        throw unsupported("its values are integers of 32 bits, which cannot be read: save it with 16 bits, or as NRRD");
    }
}

}  // namespace

/// Pages that refer to each other in a circle, lie beyond the end of the file, or differ from each other.
void check_tiff(std::string_view content) {
    Reader reader(content);
    std::optional<Page> first;
    std::size_t pages = 0;
    std::size_t marked = 0;  ///< those that are marked as whole pages
    bool has_ignored = false;
    while (!reader.is_at_end()) {
        const Page page = reader.next_page();
        if (page.is_ignored()) {
            has_ignored = true;
            continue;
        }
        if (has_ignored) {
            throw unsupported(reader.name() + " follows a preview; save the image again without previews");
        }
        if (!first) {
            check_values(page);
            first = page;
        }
        if (page.width != first->width || page.height != first->height) {
            throw damaged(reader.name() + " has another size than those before it");
        }
        if (!page.is_like(*first)) {
            throw damaged(reader.name() + " has values of another kind than those before it");
        }
        ++pages;
        marked += page.kind == std::uint64_t{0} ? 1 : 0;
    }
    if (marked != 0 && marked != pages) {
        throw unsupported("only some of its pages are marked as such; save the image again");
    }
}

}  // namespace scaleaxis::io
