// SPDX-License-Identifier: Apache-2.0
#include "render_text.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace scaleaxis::render {
namespace {

// The characters from '!' to '~' as strokes on a grid: a stroke is a chain of points, each a digit for x and one for y,
// and a blank ends it. Baseline y = 2, small letters up to 6, capitals up to 8.
constexpr std::array<std::string_view, 94> kGlyphs{
    "0804 02",                           // !
    "0806 1816",                         // "
    "1218 3238 0444 0646",               // #
    "473818070615354443321203 2921",     // $
    "0248 0708181707 3332424333",        // %
    "420607182837360403122244",          // &
    "0806",                              // '
    "18070312",                          // (
    "08171302",                          // )
    "1713 0426 0624",                    // *
    "2327 0545",                         // +
    "1201",                              // ,
    "0535",                              // -
    "02",                                // .
    "0138",                              // /
    "030718384743321203",                // 0
    "062822",                            // 1
    "07183847460242",                    // 2
    "0718384746354443321203 2535",       // 3
    "32380444",                          // 4
    "480805354443321203",                // 5
    "473818070312324344351504",          // 6
    "084812",                            // 7
    "15060718384746351504031232434435",  // 8
    "463515060718384743321203",          // 9
    "02 05",                             // :
    "1201 15",                           // ;
    "370533",                            // <
    "0444 0646",                         // =
    "073503",                            // >
    "07183847462524 22",                 // ?
    "433212030718384744242646",          // @
    "022842 1434",                       // A
    "02083847463505 3544433202",         // B
    "4738180703123243",                  // C
    "02083847433202",                    // D
    "48080242 0535",                     // E
    "480802 0535",                       // F
    "47381807031232434525",              // G
    "0208 4248 0545",                    // H
    "0208",                              // I
    "3833221203",                        // J
    "0208 4804 1542",                    // K
    "080242",                            // L
    "0208244842",                        // M
    "02084248",                          // N
    "040618384644321204",                // O
    "02083847463505",                    // P
    "040618384644321204 2442",           // Q
    "02083847463505 2542",               // R
    "473818070615354443321203",          // S
    "0848 2822",                         // T
    "080312324348",                      // U
    "082248",                            // V
    "0812263248",                        // W
    "0248 0842",                         // X
    "082548 2522",                       // Y
    "08480242",                          // Z
    "18080212",                          // [
    "0831",                              // backslash
    "08181202",                          // ]
    "062846",                            // ^
    "0141",                              // _
    "0817",                              // `
    "3632 3526160503122233",             // a
    "0802 0516263533221203",             // b
    "3526160503122233",                  // c
    "3832 3526160503122233",             // d
    "04343526160503122233",              // e
    "281712 0626",                       // f
    "3631201001 3526160503122233",       // g
    "0802 0516263532",                   // h
    "0602 08",                           // i
    "161100 18",                         // j
    "0802 3603 1432",                    // k
    "080312",                            // l
    "0602 05162522 25364542",            // m
    "0602 0516263532",                   // n
    "050312223335261605",                // o
    "0600 0516263533221203",             // p
    "3630 3526160503122233",             // q
    "0602 051626",                       // r
    "35261605142433221203",              // s
    "181322 0626",                       // t
    "0603122233 3632",                   // u
    "062246",                            // v
    "0612253246",                        // w
    "0632 0236",                         // x
    "0622 4610",                         // y
    "06360232",                          // z
    "28171605141322",                    // {
    "0901",                              // |
    "08171625141302",                    // }
    "04153445",                          // ~
};

constexpr int kBaseline = 2;
constexpr int kCapitalHeight = 6;  // above the baseline
constexpr double kSpacing = 1.9;   // from the right side of a letter to the next
constexpr double kBlank = 3.4;

std::string_view glyph(char character) {
    return character >= '!' && character <= '~' ? kGlyphs[static_cast<std::size_t>(character - '!')]
                                                : kGlyphs['?' - '!'];
}

/// From the left side of a letter to that of the next one, in units of the grid.
double advance(char character) {
    if (character == ' ') return kBlank;
    int width = 0;
    const std::string_view strokes = glyph(character);
    for (std::size_t i = 0; i < strokes.size(); i += strokes[i] == ' ' ? 1 : 2)
        width = std::max(width, strokes[i] - '0');
    return width + kSpacing;
}

}  // namespace

double text_width(std::string_view text, double height) {
    double width = text.empty() ? 0.0 : -kSpacing;
    for (const char character : text) width += advance(character);
    return width * height / kCapitalHeight;
}

void draw_text(Canvas& canvas, std::string_view text, const Corner& start, double height) {
    const double unit = height / kCapitalHeight;
    const double half_width = 0.42 * unit;
    double left = start.x;
    for (const char character : text) {
        if (character != ' ') {
            const std::string_view strokes = glyph(character);
            const auto corner = [&](std::size_t i) {
                return Corner{left + unit * (strokes[i] - '0'), start.y - unit * (strokes[i + 1] - '0' - kBaseline),
                              start.z, start.color};
            };
            for (std::size_t i = 0; i < strokes.size(); i += strokes[i] == ' ' ? 1 : 2) {
                if (strokes[i] == ' ') continue;
                const bool is_last = i + 2 >= strokes.size() || strokes[i + 2] == ' ';
                fill_segment(canvas, corner(i), corner(is_last ? i : i + 2), half_width);
            }
        }
        left += unit * advance(character);
    }
}

}  // namespace scaleaxis::render
