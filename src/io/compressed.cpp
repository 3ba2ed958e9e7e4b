// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/compressed.hpp"

#include <zlib.h>

#include <algorithm>
#include <memory>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::io {

bool is_gzip(std::string_view content) { return content.starts_with("\x1f\x8b"); }

std::string inflated(std::string_view content, std::size_t most, bool may_be_damaged) {
    constexpr int kEitherFormat = 32;
    constexpr std::size_t kPart = std::size_t{1} << 20;
    z_stream stream{};
    if (inflateInit2(&stream, kEitherFormat + MAX_WBITS) != Z_OK) {
        throw FileError("cannot be decompressed: no memory");
    }
    const std::unique_ptr<z_stream, int (*)(z_stream*)> ends(&stream, inflateEnd);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
    stream.avail_in = static_cast<uInt>(content.size());
    std::string result;
    int status = Z_OK;
    while (status == Z_OK && result.size() < most) {
        const std::size_t begin = result.size();
        const std::size_t part = std::min(kPart, most - begin);
        result.resize(begin + part);
        stream.next_out = reinterpret_cast<Bytef*>(result.data() + begin);
        stream.avail_out = static_cast<uInt>(part);
        status = inflate(&stream, Z_NO_FLUSH);
        result.resize(begin + part - stream.avail_out);
    }
    if (status != Z_STREAM_END && result.size() < most && !may_be_damaged) {
        throw FileError(status == Z_BUF_ERROR || status == Z_OK ? "the compressed data end before their end"
                                                                : "the compressed data are damaged");
    }
    return result;
}

}  // namespace scaleaxis::io
