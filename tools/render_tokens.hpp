// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A file as a string, and the words and numbers of a text one after the other, with the line for error messages.
#pragma once

#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::render {

/// The whole file.
/// \throws FileError
inline std::string read_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw FileError(file.string() + ": cannot be opened");
    std::string content{std::istreambuf_iterator<char>(stream), {}};
    if (stream.bad() || std::filesystem::is_directory(file)) throw FileError(file.string() + ": cannot be read");
    return content;
}

class Tokens {
   public:
    /// \param first_line number of the line that `text` starts with
    Tokens(std::string file, std::string_view text, int first_line = 1)
        : file_(std::move(file)), text_(text), line_(first_line) {}

    /// The next word, or an empty one at the end of the text.
    std::string_view word() {
        while (position_ < text_.size() && is_space(text_[position_])) {
            line_ += text_[position_] == '\n';
            ++position_;
        }
        const std::size_t begin = position_;
        while (position_ < text_.size() && !is_space(text_[position_])) ++position_;
        return text_.substr(begin, position_ - begin);
    }

    double number() {
        const std::string_view token = word();
        double value = 0.0;
        const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
        if (token.empty()) fail("the file ends where a number should be; it is cut short");
        if (error != std::errc{} || end != token.data() + token.size()) {
            fail("expected a number, found '" + std::string(token.substr(0, 40)) + "'");
        }
        return value;
    }

    void expect(std::string_view wanted) {
        const std::string_view token = word();
        if (token != wanted) {
            fail("expected '" + std::string(wanted) + "', found '" + std::string(token.substr(0, 40)) + "'");
        }
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw FileError(file_ + ", line " + std::to_string(line_) + ": " + what);
    }

   private:
    static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

    std::string file_;
    std::string_view text_;
    std::size_t position_ = 0;
    int line_;
};

}  // namespace scaleaxis::render
