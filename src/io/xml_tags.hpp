// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tags of an XML text one after the other: what formats need whose data are attributes.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace scaleaxis::io {

struct XmlTag {
    std::string_view name;  ///< without the prefix of a namespace; empty: the text has ended
    bool opens = false;
    bool closes = false;                                                    ///< `<a/>` does both
    std::vector<std::pair<std::string_view, std::string_view>> attributes;  ///< names without prefixes; raw values

    /// The value of this attribute; null if there is none.
    const std::string_view* find(std::string_view attribute) const;
};

/// A text with the characters that `&lt;` and the like stand for.
std::string without_entities(std::string_view text);

class XmlTags {
   public:
    explicit XmlTags(std::string_view text) : text_(text) {}

    /// The next tag; valid until the one after it. Comments and declarations are passed over.
    /// \throws FileError if the text ends within it
    const XmlTag& next();

   private:
    std::string_view text_;
    XmlTag tag_;
};

}  // namespace scaleaxis::io
