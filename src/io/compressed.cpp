// SPDX-License-Identifier: Apache-2.0
#include "io/compressed.hpp"

#include <zlib.h>

#include <algorithm>

#include "io/faults.hpp"

namespace scaleaxis::io {

bool is_gzip(std::string_view content) { return content.starts_with("\x1f\x8b"); }

namespace {

constexpr std::size_t kPart = std::size_t{1} << 20;

class Inflater {
   public:
    static constexpr int kEitherFormat = 32 + MAX_WBITS;
    static constexpr int kWithoutHead = -MAX_WBITS;

    explicit Inflater(std::string_view content, int format = kEitherFormat) {
        if (inflateInit2(&stream_, format) != Z_OK) {
            throw FileError(Diagnostic{"file.open", "cannot be decompressed: no memory"});
        }
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
        stream_.avail_in = static_cast<uInt>(content.size());
    }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    ~Inflater() { inflateEnd(&stream_); }

    /// Writes the next bytes and returns how many.
    std::size_t next(char* to, std::size_t most) {
        stream_.next_out = reinterpret_cast<Bytef*>(to);
        stream_.avail_out = static_cast<uInt>(most);
        status_ = inflate(&stream_, Z_NO_FLUSH);
        return most - stream_.avail_out;
    }
    int status() const { return status_; }  ///< of zlib: Z_OK as long as there may be more

   private:
    z_stream stream_{};
    int status_ = Z_OK;
};

std::string all_of(Inflater& inflater, std::size_t most, bool may_be_damaged) {
    std::string result;
    while (inflater.status() == Z_OK && result.size() < most) {
        const std::size_t begin = result.size();
        const std::size_t part = std::min(kPart, most - begin);
        result.resize(begin + part);
        result.resize(begin + inflater.next(result.data() + begin, part));
    }
    const int status = inflater.status();
    if (status != Z_STREAM_END && result.size() < most && !may_be_damaged) {
        throw status == Z_BUF_ERROR || status == Z_OK ? truncated("the compressed data end before their end")
                                                      : damaged("the compressed data are damaged");
    }
    return result;
}

}  // namespace

std::string inflated(std::string_view content, std::size_t most, bool may_be_damaged) {
    Inflater inflater(content);
    return all_of(inflater, most, may_be_damaged);
}

std::string inflated_raw(std::string_view content, std::size_t most) {
    Inflater inflater(content, Inflater::kWithoutHead);
    return all_of(inflater, most, false);
}

std::uintmax_t inflated_size(std::string_view content) {
    Inflater inflater(content);
    std::string part(kPart, '\0');
    std::uintmax_t size = 0;
    while (inflater.status() == Z_OK) {
        size += inflater.next(part.data(), part.size());
    }
    return size;
}

}  // namespace scaleaxis::io
