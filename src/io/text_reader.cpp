// SPDX-License-Identifier: Apache-2.0
#include "io/text_reader.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_newline(char c) { return c == '\n' || c == '\r'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

std::optional<double> parse_number(std::string_view word) {
    const bool is_negative = word.starts_with('-');
    if (is_negative || word.starts_with('+')) {
        word.remove_prefix(1);
    }
    if (word.starts_with('-')) {
        return std::nullopt;
    }
    auto format = std::chars_format::general;
    if (word.starts_with("0x") || word.starts_with("0X")) {
        word.remove_prefix(2);
        format = std::chars_format::hex;
    }
    double value = 0.0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value, format);
    if (stop != end || error == std::errc::invalid_argument) {
        return std::nullopt;
    }
    if (error == std::errc::result_out_of_range) {
        const bool is_tiny =
            word.find("e-") != word.npos || word.find("E-") != word.npos || word.find("p-") != word.npos;
        value = is_tiny ? 0.0 : std::numeric_limits<double>::infinity();
    }
    return is_negative ? -value : value;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
    if (word.starts_with('+')) {
        word.remove_prefix(1);
    }
    std::int64_t value = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    return stop == end && error == std::errc() ? std::optional(value) : std::nullopt;
}

std::string quoted(std::string_view word, std::size_t longest) {
    std::string result = "'";
    for (const char c : word.substr(0, longest)) {
        result += c >= ' ' && c <= '~' ? c : '?';
    }
    return result + (word.size() > longest ? "...'" : "'");
}

std::string_view text_beginning(std::string_view text) {
    text.remove_prefix(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    return text;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r";
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::string to_lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), lower);
    return result;
}

std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) {
        line.remove_suffix(1);
    }
    return line;
}

std::vector<std::string_view> words_of(std::string_view text, std::string_view separators) {
    std::vector<std::string_view> words;
    for (std::size_t end = 0;;) {
        const std::size_t begin = text.find_first_not_of(separators, end);
        if (begin == std::string_view::npos) {
            return words;
        }
        end = std::min(text.find_first_of(separators, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
    }
}

TextReader::TextReader(std::string_view text, bool joins_lines)
    : text_(text), position_(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0), joins_lines_(joins_lines) {}

std::size_t TextReader::line_end() const {
    if (is_at_end() || !is_newline(text_[position_])) {
        return 0;
    }
    return text_.substr(position_).starts_with("\r\n") ? 2 : 1;
}

bool TextReader::is_at_joint() const {
    return joins_lines_ && text_[position_] == '\\' && position_ + 1 < text_.size() && is_newline(text_[position_ + 1]);
}

void TextReader::skip_blanks() {
    while (!is_at_end()) {
        if (is_blank(text_[position_])) {
            ++position_;
        } else if (is_at_joint()) {
            ++position_;
            position_ += line_end();
            ++line_;
        } else {
            return;
        }
    }
}

std::string_view TextReader::word() {
    skip_blanks();
    const std::size_t begin = position_;
    while (!is_at_end()) {
        const char c = text_[position_];
        if (is_blank(c) || is_newline(c) || c == '#' || is_at_joint()) {
            break;
        }
        ++position_;
    }
    return text_.substr(begin, position_ - begin);
}

std::string_view TextReader::any_word() {
    for (;;) {
        const std::string_view found = word();
        if (!found.empty() || !next_line()) {
            return found;
        }
    }
}

Point TextReader::point() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
}

Point TextReader::any_point() {
    const double x = any_number();
    const double y = any_number();
    return {x, y, any_number()};
}

bool TextReader::is_next(std::string_view keyword) {
    const std::string_view found = any_word();
    put_back(found.size());
    return to_lower(found) == keyword;
}

void TextReader::expect(std::string_view keyword, const std::string& what) {
    if (const std::string_view found = any_word(); to_lower(found) != keyword) {
        if (found.empty()) {
            fail_at_end(what);
        }
        fail(quoted(found) + " stands where " + what + " should");
    }
}

std::int64_t TextReader::any_integer() {
    const std::string_view found = any_word();
    if (const auto value = parse_integer(found)) {
        return *value;
    }
    if (found.empty()) {
        fail_at_end("an integer");
    }
    fail(quoted(found) + " is not an integer");
}

std::size_t TextReader::any_count(const std::string& items, std::size_t shortest_item) {
    const std::int64_t count = any_integer();
    if (count < 0 || static_cast<std::uint64_t>(count) > rest().size() / shortest_item + 1) {
        fail("there cannot be " + std::to_string(count) + ' ' + items + ": the file is truncated or damaged",
             "file.truncated");
    }
    return static_cast<std::size_t>(count);
}

double TextReader::to_number(std::string_view found) const {
    if (const auto value = parse_number(found)) {
        return *value;
    }
    if (!found.empty()) {
        fail(quoted(found) + " is not a number");
    }
    if (is_at_end()) {
        fail_at_end("a number");
    }
    fail("a number is missing");
}

bool TextReader::next_line() {
    for (skip_blanks(); !is_at_end() && !is_newline(text_[position_]); skip_blanks()) {
        ++position_;
    }
    if (is_at_end()) {
        return false;
    }
    position_ += line_end();
    ++line_;
    return true;
}

std::string_view TextReader::after_line() {
    next_line();
    return rest();
}

void TextReader::fail_at_end(const std::string& expected) const {
    fail("the file ends where " + expected + " should follow: it is truncated", "file.truncated");
}

void TextReader::fail(const std::string& what, const char* code) const {
    throw FileError(Diagnostic{code, "line " + std::to_string(line_) + ": " + what, "line", line_});
}

}  // namespace scaleaxis::io
