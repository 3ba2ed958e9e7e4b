// SPDX-License-Identifier: Apache-2.0
/// \file
/// Words and numbers of a text, line by line, independent of the locale.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::io {

/// The whole word as a number: decimal, or hexadecimal as C writes it (`0x1.8p-3`); `nan` and `inf` are numbers too.
std::optional<double> parse_number(std::string_view word);

/// The whole word as an integer.
std::optional<std::int64_t> parse_integer(std::string_view word);

/// An index as a file gives it; `kNone` where it cannot be one.
constexpr Index to_index(std::int64_t value) {
    return value >= 0 && value <= std::numeric_limits<Index>::max() ? static_cast<Index>(value) : kNone;
}

/// A word of a file as it can stand in a message: shortened, printable, in quotes.
std::string quoted(std::string_view word, std::size_t longest = 24);

/// Without the blanks at its ends.
std::string_view trimmed(std::string_view text);

/// The first line without its end; it is taken off the text.
std::string_view take_line(std::string_view& text);

/// What is between these separators.
std::vector<std::string_view> words_of(std::string_view text, std::string_view separators = " \t");

/// The text with `A` to `Z` in lower case.
std::string to_lower(std::string_view text);

/// A text from its first character on that is no blank, without a byte order mark.
std::string_view text_beginning(std::string_view text);

/// Reads a text from its beginning to its end. `#` begins a comment; lines end in any of the usual ways.
class TextReader {
   public:
    /// \param joins_lines a backslash at the end of a line continues it on the next
    explicit TextReader(std::string_view text, bool joins_lines = false);

    /// The next word of the current line; empty at the end of the line.
    std::string_view word();
    /// The next word of this or of a later line; empty at the end of the text.
    std::string_view any_word();
    /// The next word of the current line (of this or a later line, for `any_…`), which has to be a number.
    double number() { return to_number(word()); }
    double any_number() { return to_number(any_word()); }
    /// Three numbers.
    Point point();
    Point any_point();
    std::int64_t any_integer();
    /// The same as an index; `kNone` where it cannot be one.
    Index any_index() { return to_index(any_integer()); }
    /// The next integer, which has to be a number of items that the rest of the text can hold if the shortest of them
    /// has `shortest_item` characters: nothing is reserved for what a damaged file claims.
    std::size_t any_count(const std::string& items, std::size_t shortest_item);
    /// Is the next word of this or of a later line this one, in any case? It is not taken.
    bool is_next(std::string_view keyword);
    /// Takes that word, which has to be this one, in any case. \param what as messages call it
    void expect(std::string_view keyword, const std::string& what);
    /// Makes the last characters of the word just read the next to be read.
    void put_back(std::size_t count) { position_ -= count; }

    /// Goes to the next line. False at the end of the text.
    bool next_line();
    /// What follows the current line.
    std::string_view after_line();
    /// What has not been read yet.
    std::string_view rest() const { return text_.substr(position_); }

    /// Throws a `FileError` that names the current line.
    [[noreturn]] void fail(const std::string& what, const char* code = "file.syntax") const;
    /// The same where the text ends too early.
    [[noreturn]] void fail_at_end(const std::string& expected) const;

   private:
    double to_number(std::string_view found) const;
    bool is_at_end() const { return position_ == text_.size(); }
    /// Length of the line end at the current position; 0 if there is none.
    std::size_t line_end() const;
    /// Is the current character a backslash that joins this line to the next?
    bool is_at_joint() const;
    void skip_blanks();

    std::string_view text_;
    std::size_t position_ = 0;
    std::int64_t line_ = 1;
    bool joins_lines_ = false;
};

}  // namespace scaleaxis::io
