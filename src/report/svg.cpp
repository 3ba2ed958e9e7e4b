// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>

#include "base/powers.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::inline v1 {
namespace {

// In pixels.
constexpr double kWidth = 720.0;
constexpr double kHeight = 420.0;
constexpr double kLeft = 60.0;
constexpr double kRight = 660.0;
constexpr double kTop = 50.0;
constexpr double kBottom = 360.0;

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    }
    return result;
}

class Plot {
   public:
    Plot(double largest_scale, double most_sheets) : log_end_(logarithm(largest_scale)), most_sheets_(most_sheets) {
        out_.setf(std::ios::fixed);
        out_.precision(1);
    }

    double x(double scale) const {
        return kLeft + (kRight - kLeft) * (log_end_ > 0.0 ? logarithm(scale) / log_end_ : 0.0);
    }
    static double y(double part) { return kBottom - (kBottom - kTop) * part; }

    std::ostringstream& out() { return out_; }

    void text(double at_x, double at_y, std::string_view anchor, std::string_view words,
              std::string_view color = "#333") {
        out_ << "<text x=\"" << at_x << "\" y=\"" << at_y << "\" text-anchor=\"" << anchor << "\" fill=\"" << color
             << "\">" << escaped(words) << "</text>\n";
    }
    void line(double x1, double y1, double x2, double y2) {
        out_ << "<line x1=\"" << x1 << "\" y1=\"" << y1 << "\" x2=\"" << x2 << "\" y2=\"" << y2
             << "\" stroke=\"#ddd\"/>\n";
    }
    template <class Part>
    void curve(std::span<const FiltrationLevel> levels, const Part& part, std::string_view color) {
        out_ << "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" << color << "\" points=\"";
        for (const FiltrationLevel& level : levels) {
            out_ << x(level.scale) << ',' << y(part(level)) << ' ';
        }
        out_ << "\"/>\n";
    }
    double most_sheets() const { return most_sheets_; }

   private:
    double log_end_;
    double most_sheets_;
    std::ostringstream out_;
};

// The shortest text that reads as the same number.
std::string shortest(double value) {
    char digits[32];
    return {digits, std::to_chars(std::begin(digits), std::end(digits), value).ptr};
}

std::string short_number(double value) {
    std::ostringstream out;
    out.precision(4);
    out << value;
    return out.str();
}

}  // namespace

std::string to_csv(std::span<const FiltrationLevel> levels) {
    std::string text = "scale,sheets,balls,area,curve_length,volume\n";
    for (const auto& [scale, sheets, balls, area, curve_length, volume] : levels) {
        text += shortest(scale) + ',' + std::to_string(sheets) + ',' + std::to_string(balls) + ',' + shortest(area) +
                ',' + shortest(curve_length) + ',' + shortest(volume) + '\n';
    }
    return text;
}

std::string to_svg(std::span<const FiltrationLevel> levels, const ScalePlateau& plateau, std::string_view title) {
    Index most_sheets = 1;
    double longest = 0.0;
    for (const FiltrationLevel& level : levels) {
        most_sheets = std::max(most_sheets, level.sheets);
        longest = std::max(longest, level.curve_length);
    }
    const double largest = levels.empty() ? 1.0 : levels.back().scale;
    Plot plot(largest, most_sheets);
    plot.out() << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << kWidth << "\" height=\"" << kHeight
               << "\" viewBox=\"0 0 " << kWidth << ' ' << kHeight
               << "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
                  "fill=\"white\"/>\n";
    plot.out() << "<rect x=\"" << plot.x(plateau.begin) << "\" y=\"" << kTop << "\" width=\""
               << plot.x(plateau.end) - plot.x(plateau.begin) << "\" height=\"" << kBottom - kTop
               << "\" fill=\"#f3efe0\"/>\n";
    plot.text(0.5 * (kLeft + kRight), 20.0, "middle", title);
    for (const double scale : {1.0, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0}) {
        if (scale <= largest * (1.0 + 1e-9)) {
            plot.line(plot.x(scale), kTop, plot.x(scale), kBottom);
            const bool is_crowded = scale == 1.05 && largest > 4.0;
            if (!is_crowded) {
                plot.text(plot.x(scale), kBottom + 16.0, "middle", short_number(scale));
            }
        }
    }
    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        plot.line(kLeft, Plot::y(part), kRight, Plot::y(part));
        plot.text(kLeft - 6.0, Plot::y(part) + 4.0, "end", short_number(100.0 * part) + " %");
        plot.text(kRight + 6.0, Plot::y(part) + 4.0, "start", short_number(part * most_sheets), "#7570b3");
    }
    plot.text(0.5 * (kLeft + kRight), kBottom + 36.0, "middle", "scale s; shaded: the longest plateau of the area");
    if (!levels.empty()) {
        const FiltrationLevel& whole = levels.front();
        const auto part_of = [](double value, double all) { return all > 0.0 ? value / all : 0.0; };
        plot.curve(
            levels, [&](const FiltrationLevel& l) { return part_of(l.area, whole.area); }, "#1b9e77");
        plot.curve(
            levels, [&](const FiltrationLevel& l) { return part_of(l.volume, whole.volume); }, "#1f78b4");
        plot.curve(
            levels, [&](const FiltrationLevel& l) { return part_of(l.balls, whole.balls); }, "#888");
        plot.curve(
            levels, [&](const FiltrationLevel& l) { return part_of(l.curve_length, longest); }, "#d95f02");
        plot.curve(
            levels, [&](const FiltrationLevel& l) { return part_of(l.sheets, most_sheets); }, "#7570b3");
    }
    double at = kLeft;
    for (const auto& [words, color] :
         std::array<std::array<std::string_view, 2>, 5>{{{"area of the sheets", "#1b9e77"},
                                                         {"volume of the balls", "#1f78b4"},
                                                         {"balls", "#888"},
                                                         {"length of curves", "#d95f02"},
                                                         {"number of sheets (right)", "#7570b3"}}}) {
        plot.text(at, 40.0, "start", words, color);
        at += 12.0 + 7.0 * static_cast<double>(words.size());
    }
    plot.out() << "</svg>\n";
    return plot.out().str();
}

}  // namespace scaleaxis::inline v1
