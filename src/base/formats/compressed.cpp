// SPDX-License-Identifier: Apache-2.0
#include "base/formats/compressed.hpp"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/faults.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::size_t kUnpackedPart = std::size_t{1} << 18;

/// A stream of zlib, and what its functions say.
struct Deflate {
    static constexpr int kEitherHead = 32 + MAX_WBITS;
    static constexpr int kWithoutHead = -MAX_WBITS;
    static constexpr char kFirstByte = '\x1f';  // of gzip
    using Stream = z_stream;
    using Byte = Bytef;

    static bool start(Stream& stream, int format) { return inflateInit2(&stream, format) == Z_OK; }
    static void end(Stream& stream) { inflateEnd(&stream); }
    /// \returns whether the stream has ended; none: it is damaged
    static std::optional<bool> unpack(Stream& stream) {
        const int status = inflate(&stream, Z_NO_FLUSH);
        return status == Z_OK || status == Z_BUF_ERROR || status == Z_STREAM_END ? std::optional(status == Z_STREAM_END)
                                                                                 : std::nullopt;
    }
};

/// The same of bzip2.
struct Bzip2 {
    static constexpr char kFirstByte = 'B';
    using Stream = bz_stream;
    using Byte = char;

    static bool start(Stream& stream, int) { return BZ2_bzDecompressInit(&stream, 0, 0) == BZ_OK; }
    static void end(Stream& stream) { BZ2_bzDecompressEnd(&stream); }
    static std::optional<bool> unpack(Stream& stream) {
        const int status = BZ2_bzDecompress(&stream);
        return status == BZ_OK || status == BZ_STREAM_END ? std::optional(status == BZ_STREAM_END) : std::nullopt;
    }
};

template <class Codec>
class Unpacker {
   public:
    explicit Unpacker(ByteSource packed, int format = Deflate::kEitherHead)
        : packed_(std::move(packed)), buffer_(kUnpackedPart), format_(format) {
        start();
    }
    ~Unpacker() { Codec::end(stream_); }
    Unpacker(const Unpacker&) = delete;
    Unpacker& operator=(const Unpacker&) = delete;

    /// As `ByteSource`, up to the damage if there is one.
    std::size_t next(char* to, std::size_t most) {
        std::size_t total = 0;
        while (total < most && !is_at_end_) {
            refill();
            const auto part = static_cast<unsigned>(std::min<std::size_t>(most - total, kUnpackedPart));
            stream_.next_out = reinterpret_cast<typename Codec::Byte*>(to + total);
            stream_.avail_out = part;
            const std::optional<bool> is_end = Codec::unpack(stream_);
            total += part - stream_.avail_out;
            is_damaged_ = !is_end.has_value();
            is_whole_ = is_end.value_or(false);
            is_at_end_ = is_damaged_ || (is_whole_ ? !restart() : stream_.avail_out == part && is_all_given_);
        }
        return total;
    }
    bool is_damaged() const { return is_damaged_; }
    bool is_whole() const { return is_whole_; }  ///< have all streams ended as they should?

   private:
    void start() {
        if (!Codec::start(stream_, format_)) {
            throw FileError(Diagnostic{"file.memory", "cannot be decompressed: no memory"});
        }
    }
    void refill() {
        if (stream_.avail_in == 0 && !is_all_given_) {
            const std::size_t size = packed_(buffer_.data(), buffer_.size());
            is_all_given_ = size < buffer_.size();
            stream_.next_in = reinterpret_cast<typename Codec::Byte*>(buffer_.data());
            stream_.avail_in = static_cast<unsigned>(size);
        }
    }
    /// With a stream that follows the one that has ended. \returns false if none does
    bool restart() {
        refill();
        if (stream_.avail_in == 0 || static_cast<char>(*stream_.next_in) != Codec::kFirstByte) {
            return false;
        }
        const auto [data, size] = std::pair(stream_.next_in, stream_.avail_in);
        Codec::end(stream_);
        stream_ = {};
        start();
        stream_.next_in = data;
        stream_.avail_in = size;
        return true;
    }

    ByteSource packed_;
    std::vector<char> buffer_;
    int format_ = 0;
    typename Codec::Stream stream_{};
    bool is_all_given_ = false;
    bool is_at_end_ = false;
    bool is_damaged_ = false;
    bool is_whole_ = false;
};

FileError damaged_data() { return damaged("the compressed data are damaged"); }

template <class Codec>
ByteSource unpacking(ByteSource packed) {
    const auto unpacker = std::make_shared<Unpacker<Codec>>(std::move(packed));
    return [unpacker](char* to, std::size_t most) {
        const std::size_t count = unpacker->next(to, most);
        if (unpacker->is_damaged()) {
            throw damaged_data();
        }
        return count;
    };
}

/// Up to `most` bytes of it.
std::string all_of(std::string_view content, int format, std::size_t most, bool may_be_damaged) {
    Unpacker<Deflate> unpacker(bytes_of(content), format);
    std::string result;
    for (std::size_t count = kUnpackedPart; count == kUnpackedPart && result.size() < most;) {
        const std::size_t begin = result.size();
        result.resize(begin + std::min(kUnpackedPart, most - begin));
        count = unpacker.next(result.data() + begin, result.size() - begin);
        result.resize(begin + count);
    }
    if (result.size() < most && !unpacker.is_whole() && !may_be_damaged) {
        throw unpacker.is_damaged() ? damaged_data() : truncated("the compressed data end before their end");
    }
    return result;
}

}  // namespace

ByteSource bytes_of(std::string_view content) {
    const auto rest = std::make_shared<std::string_view>(content);
    return [rest](char* to, std::size_t most) {
        const std::size_t count = rest->copy(to, most);
        rest->remove_prefix(count);
        return count;
    };
}

ByteSource inflating(ByteSource packed) { return unpacking<Deflate>(std::move(packed)); }
ByteSource bunzipping(ByteSource packed) { return unpacking<Bzip2>(std::move(packed)); }

bool is_gzip(std::string_view content) { return content.starts_with("\x1f\x8b"); }

std::string inflated(std::string_view content, std::size_t most) {
    return all_of(content, Deflate::kEitherHead, most, false);
}

std::string beginning_of(std::string_view content, std::size_t most) {
    return is_gzip(content) ? all_of(content, Deflate::kEitherHead, most, true) : std::string(content.substr(0, most));
}

std::string inflated_raw(std::string_view content, std::size_t most) {
    return all_of(content, Deflate::kWithoutHead, most, false);
}

}  // namespace scaleaxis::inline v1
