// SPDX-License-Identifier: Apache-2.0
#include "io/images/image_head.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/faults.hpp"
#include "base/files.hpp"
#include "base/vectors.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

/// `%d` or `%03d` in a name, filled with a number.
std::string filled(std::string_view pattern, std::int64_t number) {
    constexpr std::size_t kMostDigits = 20;
    const std::size_t begin = pattern.find('%');
    const std::size_t end = pattern.find('d', begin);
    const std::string_view width = pattern.substr(begin + 1, end - begin - 1);
    const std::optional<std::int64_t> digits = width.empty() ? 0 : parse_integer(width);
    if (end == std::string_view::npos || number < 0 || !digits || *digits < 0 ||
        *digits > static_cast<std::int64_t>(kMostDigits) || pattern.find('%', end) != std::string_view::npos) {
        throw unsupported("its data are in several files, " + io::quoted(pattern) +
                          ": their names need one part as `%d` or `%03d`");
    }
    std::string text = std::to_string(number);
    const auto missing = static_cast<std::size_t>(*digits) - std::min<std::size_t>(*digits, text.size());
    text.insert(0, missing, width.starts_with('0') ? '0' : ' ');
    return std::string(pattern.substr(0, begin)) + text + std::string(pattern.substr(end + 1));
}

/// \param name a pattern, and the first number, the last one, and perhaps the step
std::vector<std::string> files_of_pattern(std::string_view name) {
    constexpr std::int64_t kMostFiles = 100'000;
    const std::vector<std::string_view> words = words_of(name);
    const auto number = [&](std::size_t word) { return word < words.size() ? parse_integer(words[word]) : 1; };
    const std::optional<std::int64_t> first = number(1);
    const std::optional<std::int64_t> last = number(2);
    const std::optional<std::int64_t> step = number(3);
    if (words.size() < 3 || !first || !last || !step || *step == 0 || std::max({*first, *last, *step}) > kMostFiles ||
        std::min({*first, *last, *step}) < -kMostFiles || (*last - *first) / *step < 0) {
        throw unsupported("its data are in several files, " + io::quoted(name) +
                          ": the first number, the last one and the step are needed");
    }
    std::vector<std::string> files;
    for (std::int64_t i = 0; i <= (*last - *first) / *step; ++i) {
        files.push_back(filled(words[0], *first + i * *step));
    }
    return files;
}

}  // namespace

void HeadField::fail(const std::string& what) const { fail_at_line(line, what); }

std::vector<std::string_view> HeadField::words(std::size_t count) const {
    std::vector<std::string_view> found = words_of(value);
    if (found.size() != count) {
        fail(io::quoted(name) + " needs " + std::to_string(count) + " words, not " + std::to_string(found.size()));
    }
    return found;
}

std::int64_t HeadField::integer(std::int64_t least, std::int64_t most) const {
    const std::optional<std::int64_t> number = parse_integer(value);
    if (!number || *number < least || *number > most) {
        fail(io::quoted(value) + " cannot be the value of " + io::quoted(name));
    }
    return *number;
}

std::vector<std::int64_t> HeadField::sizes(std::size_t count) const {
    return each_of<std::int64_t>(words(count), [&](std::string_view word) {
        return HeadField{name, word, line}.integer(1);
    });
}

std::vector<double> HeadField::numbers(const std::vector<std::string_view>& words, bool may_be_absent) const {
    std::vector<double> result;
    for (const std::string_view word : words) {
        const std::optional<double> number = may_be_absent && word == "none" ? NAN : parse_number(word);
        if (!number || !(is_of_place(*number) || (may_be_absent && std::isnan(*number)))) {
            fail(io::quoted(word) + " cannot be a number of " + io::quoted(name));
        }
        result.push_back(*number);
    }
    return result;
}

NumberType HeadField::type(std::string_view table, std::string_view name_of_type) const {
    if (const std::optional<NumberType> type = number_type_in(table, to_lower(name_of_type))) {
        return *type;
    }
    fail("values of type " + io::quoted(name_of_type) + " cannot be read");
}

void ImageHead::add(const HeadField& field) {
    if (find(field.name) != nullptr) {
        field.fail(io::quoted(field.name) + " is there twice");
    }
    fields_.push_back(field);
}

const HeadField* ImageHead::find(std::string_view name) const {
    const auto found = std::ranges::find(fields_, name, &HeadField::name);
    return found == fields_.end() ? nullptr : &*found;
}

const HeadField& ImageHead::at(std::string_view name) const {
    if (const HeadField* field = find(name)) {
        return *field;
    }
    throw damaged("its head has no line " + io::quoted(name));
}

std::string ImageHead::text(std::string_view name) const {
    const HeadField* field = find(name);
    return field == nullptr ? std::string() : to_lower(field->value);
}

std::int64_t ImageHead::integer(std::string_view name, std::int64_t least, std::int64_t otherwise) const {
    const HeadField* field = find(name);
    return field == nullptr ? otherwise : field->integer(least);
}

std::vector<StoredData> data_files(std::string_view name, std::string_view list, const std::filesystem::path& head) {
    if (head.empty()) {
        throw data_apart(", " + io::quoted(name));
    }
    std::vector<StoredData> files;
    const auto add = [&](std::string_view file) { files.push_back({{}, head.parent_path() / path_of(file)}); };
    if (name.starts_with("LIST")) {
        while (!list.empty()) {
            if (const std::string_view line = take_line(list); !line.empty()) {
                add(line);
            }
        }
    } else if (name.find('%') != std::string_view::npos) {
        std::ranges::for_each(files_of_pattern(name), add);
    } else {
        add(name);
    }
    return files;
}

}  // namespace scaleaxis::io
