// SPDX-License-Identifier: Apache-2.0
/// \file
/// A file that is there when it is complete, and not before.
#pragma once

#include <charconv>
#include <concepts>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/bytes.hpp"

namespace scaleaxis::io {

/// A file in the making: it has a temporary name in the folder of the final one until `commit` (with `.part0`,
/// `.part1`… appended, or these alone where that would be too long), and is removed if that is never reached. Pipes and
/// devices are written to directly, and so is `/dev/stdout`. All functions throw a `FileError` if the disk is full or
/// the folder cannot be written to.
class OutputFile {
   public:
    explicit OutputFile(std::filesystem::path file);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// Appends words, characters, and numbers in the shortest form that reads as the same value.
    template <class... Items>
    void text(const Items&... items) {
        (append(items), ...);
        flush_if_large();
    }

    /// Appends the bytes of numbers, little endian.
    template <class... Numbers>
    void binary(Numbers... numbers) {
        (append_bytes(numbers), ...);
        flush_if_large();
    }

    /// Gives the complete file its final name.
    void commit();

   private:
    void append(std::string_view words) { buffer_ += words; }
    void append(char c) { buffer_ += c; }
    template <class Number>
    requires std::integral<Number> || std::floating_point<Number>
    void append(Number value) {
        char digits[32];
        const auto [end, error] = std::to_chars(std::begin(digits), std::end(digits), value);
        buffer_.append(digits, end);
    }
    template <class Number>
    void append_bytes(Number value) {
        const auto bytes = to_bytes(value, std::endian::little);
        buffer_.append(bytes.data(), bytes.size());
    }
    void flush_if_large() {
        if (buffer_.size() > kBufferSize) {
            flush();
        }
    }
    void flush();

    static constexpr std::size_t kBufferSize = std::size_t{1} << 20;

    std::filesystem::path file_;
    std::filesystem::path temporary_;  ///< empty: none
    std::FILE* stream_ = nullptr;
    std::string buffer_;
};

/// Throws a `FileError` if the file cannot be written: its folder is absent or may not be written to.
void check_output_file(const std::filesystem::path& file);

}  // namespace scaleaxis::io
