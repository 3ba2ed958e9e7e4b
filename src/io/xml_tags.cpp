// SPDX-License-Identifier: Apache-2.0
#include "io/xml_tags.hpp"

#include <algorithm>
#include <array>

#include "io/faults.hpp"

namespace scaleaxis::io {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

FileError cut() { return truncated("the XML ends within a tag: it is truncated or damaged"); }

std::string_view local(std::string_view name) {
    const std::size_t colon = name.find(':');
    return colon == name.npos ? name : name.substr(colon + 1);
}

/// Cuts off what comes before the first of these characters.
std::string_view take_until(std::string_view& text, std::string_view characters) {
    const std::size_t end = text.find_first_of(characters);
    if (end == text.npos) {
        throw cut();
    }
    const std::string_view result = text.substr(0, end);
    text.remove_prefix(end);
    return result;
}

void skip_blanks(std::string_view& text) { text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size())); }

void skip_behind(std::string_view& text, std::string_view end) {
    const std::size_t at = text.find(end);
    if (at == text.npos) {
        throw cut();
    }
    text.remove_prefix(at + end.size());
}

}  // namespace

const std::string_view* XmlTag::find(std::string_view attribute) const {
    const auto found = std::ranges::find(attributes, attribute, &std::pair<std::string_view, std::string_view>::first);
    return found == attributes.end() ? nullptr : &found->second;
}

std::string without_entities(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
        {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}}};
    std::string result;
    while (!text.empty()) {
        const auto found =
            std::ranges::find_if(kEntities, [&](const auto& entity) { return text.starts_with(entity.first); });
        result += found == kEntities.end() ? text.front() : found->second;
        text.remove_prefix(found == kEntities.end() ? 1 : found->first.size());
    }
    return result;
}

const XmlTag& XmlTags::next() {
    tag_.attributes.clear();
    tag_.name = {};
    while (true) {
        const std::size_t begin = text_.find('<');
        if (begin == text_.npos) {
            return tag_;
        }
        text_.remove_prefix(begin + 1);
        if (text_.starts_with("!--")) {
            skip_behind(text_, "-->");
        } else if (text_.starts_with("![CDATA[")) {
            skip_behind(text_, "]]>");
        } else if (text_.starts_with('?') || text_.starts_with('!')) {
            skip_behind(text_, ">");
        } else {
            break;
        }
    }
    const bool is_end = text_.starts_with('/');
    text_.remove_prefix(is_end ? 1 : 0);
    tag_.name = local(take_until(text_, " \t\r\n/>"));
    if (tag_.name.find('<') != tag_.name.npos) {
        throw cut();
    }
    for (skip_blanks(text_); !text_.starts_with('/') && !text_.starts_with('>'); skip_blanks(text_)) {
        const std::string_view name = local(take_until(text_, " \t\r\n=/>"));
        skip_blanks(text_);
        if (!text_.starts_with('=')) {
            throw damaged("an attribute of <" + std::string(tag_.name) + "> in the XML has no value");
        }
        text_.remove_prefix(1);
        skip_blanks(text_);
        const std::string_view quote = text_.substr(0, 1);
        if (quote != "\"" && quote != "'") {
            throw damaged("an attribute of <" + std::string(tag_.name) + "> in the XML has no value");
        }
        text_.remove_prefix(1);
        tag_.attributes.emplace_back(name, take_until(text_, quote));
        text_.remove_prefix(1);
    }
    tag_.opens = !is_end;
    tag_.closes = is_end || text_.starts_with('/');
    skip_behind(text_, ">");
    return tag_;
}

}  // namespace scaleaxis::io
