// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>

#include "base/files.hpp"
#include "base/formats/json.hpp"
#include "io/output_file.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/view.hpp"
#include "view/template.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// Where the template has room for the data.
constexpr std::string_view kPlace = "<!--scaleaxis:data-->";

std::string base64(std::string_view bytes) {
    static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            word = word << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += k <= count ? kDigits[word >> (18 - 6 * k) & 63] : '=';
        }
    }
    return text;
}

/// JSON that may stand in a script element: nothing in it looks like the element's end.
std::string script_json(const Json& value) {
    const std::string text = value.dump();
    std::string result;
    for (const char c : text) {
        if (c == '<') {
            result += "\\u003c";
        } else {
            result += c;
        }
    }
    return result;
}

}  // namespace

void check_view_output(const std::filesystem::path& file) {
    const std::string extension = io::to_lower(utf8_of(file.extension()));
    if (extension != ".html" && extension != ".htm") {
        throw FileError("cannot write " + utf8_of(file) + ": the name of a page has to end in .html");
    }
    const io::OutputFile probe(file);
}

void write_view(const std::filesystem::path& file, const std::string& title, ViewLayout layout,
                std::span<const std::string> models) {
    const std::string_view page = view::page_template();
    const std::size_t place = page.find(kPlace);
    io::OutputFile out(file);
    out.text(page.substr(0, place));
    out.text("<script type=\"application/json\" id=\"page\">",
             script_json({{"title", title},
                          {"layout", layout == ViewLayout::kContactSheet ? "contact-sheet" : "side-by-side"}}),
             "</script>\n");
    for (const std::string& model : models) {
        out.text("<script type=\"application/x-scaleaxis\">", base64(model), "</script>\n");
    }
    out.text(page.substr(place + kPlace.size()));
    out.commit();
}

}  // namespace scaleaxis::inline v1
