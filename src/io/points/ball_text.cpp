// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <vector>

#include "io/formats.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

/// Reads the lines `x y z r` up to the end.
std::vector<Ball> read_lines(TextReader& reader) {
    std::vector<Ball> balls;
    for (std::string_view word = reader.any_word(); !word.empty(); word = reader.any_word()) {
        reader.put_back(word.size());
        Ball ball;
        for (double* value : {&ball.center.x, &ball.center.y, &ball.center.z, &ball.radius}) {
            *value = reader.number();
        }
        if (!reader.word().empty()) {
            reader.fail("a line of a ball has four numbers: x y z r");
        }
        balls.push_back(ball);
    }
    return balls;
}

void write_lines(OutputFile& out, std::span<const Ball> balls) {
    for (const Ball& ball : balls) {
        out.text(ball.center.x, ' ', ball.center.y, ' ', ball.center.z, ' ', ball.radius, '\n');
    }
}

}  // namespace

bool is_woff(std::string_view content) { return TextReader(content).any_word() == "WOFF"; }

std::vector<Ball> read_woff_balls(std::string_view content) {
    TextReader reader(content);
    if (reader.any_word() != "WOFF") {
        reader.fail("a .woff file begins with `WOFF`");
    }
    const std::int64_t count = reader.any_integer();
    reader.next_line();  // the numbers of faces and edges
    std::vector<Ball> balls = read_lines(reader);
    if (static_cast<std::int64_t>(balls.size()) != count) {
        reader.fail("the header announces " + std::to_string(count) + " balls, but the file has " +
                    std::to_string(balls.size()));
    }
    return balls;
}

void write_woff_balls(OutputFile& out, std::span<const Ball> balls) {
    out.text("WOFF ", balls.size(), " 0 0\n");
    write_lines(out, balls);
}

/// Is the first line four numbers?
bool is_ball_text(std::string_view content) {
    TextReader reader(content);
    for (std::string_view word : {reader.any_word(), reader.word(), reader.word(), reader.word()}) {
        if (!parse_number(word)) {
            return false;
        }
    }
    return reader.word().empty();
}

std::vector<Ball> read_ball_text(std::string_view content) {
    TextReader reader(content);
    return read_lines(reader);
}

void write_ball_text(OutputFile& out, std::span<const Ball> balls) {
    out.text("# x y z radius\n");
    write_lines(out, balls);
}

}  // namespace scaleaxis::io
