// SPDX-License-Identifier: Apache-2.0
#include "terminal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "status.hpp"

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <windows.h>
#else
#include <sys/ioctl.h>
#include <unistd.h>
#endif

namespace scaleaxis::app {

namespace {

#if defined(_WIN32)
bool can_draw_on_stderr() {
    const HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
    DWORD mode = 0;
    return GetConsoleMode(console, &mode) != 0 &&
           SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

std::size_t terminal_columns() {
    CONSOLE_SCREEN_BUFFER_INFO info{};
    const bool is_known = GetConsoleScreenBufferInfo(GetStdHandle(STD_ERROR_HANDLE), &info) != 0;
    return is_known ? static_cast<std::size_t>(info.srWindow.Right - info.srWindow.Left + 1) : 80;
}
#else
bool can_draw_on_stderr() {
    const char* term = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && term != nullptr && std::string_view(term) != "dumb";
}

std::size_t terminal_columns() {
    winsize size{};
    const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return is_known ? size.ws_col : 80;
}
#endif

void print_line(std::string_view kind, std::string_view message) {
    std::fprintf(stderr, "scaleaxis: %.*s: %.*s\n", static_cast<int>(kind.size()), kind.data(),
                 static_cast<int>(message.size()), message.data());
}

/// How long the rest takes if it goes on as before; empty as long as that cannot be said.
std::string time_left(Clock::duration elapsed, double done) {
    const double seconds = std::chrono::duration<double>(elapsed).count();
    if (seconds < 2.0 || done < 0.01) {
        return {};
    }
    const double left = seconds * (1.0 - done) / done;
    const bool is_long = left >= 90.0;
    return std::to_string(std::lround(is_long ? left / 60.0 : left)) + (is_long ? " min left  " : " s left  ");
}

constexpr const char* kEraseLine = "\r\x1b[K";

}  // namespace

void prepare_streams() {
#if defined(_WIN32)
    ::_setmode(::_fileno(stdout), _O_BINARY);
    SetConsoleOutputCP(CP_UTF8);
#endif
}

void print_warning(std::string_view message) { print_line("warning", message); }

void print_error(std::string_view message) { print_line("error", message); }

void print_note(std::string_view message) { print_line("note", message); }

ProgressBar::ProgressBar(std::string title, Verbosity verbosity, const BatchPlace& place)
    : title_(std::move(title)), verbosity_(verbosity), place_(place), is_terminal_(can_draw_on_stderr()) {}

ProgressBar::~ProgressBar() { erase(); }

Execution ProgressBar::execution(int threads, const std::stop_token& cancel, const WorkShare& share) {
    const auto progress = [this, share](std::string_view stage, double fraction) {
        show(stage, share.begin + fraction * (share.end - share.begin));
        return true;
    };
    return {threads, progress, cancel};
}

void ProgressBar::erase() {
    if (is_drawn_) {
        std::fputs(kEraseLine, stderr);
        is_drawn_ = false;
    }
}

void ProgressBar::show(std::string_view stage, double fraction) {
    const auto now = Clock::now();
    const bool is_new_stage = stage != stage_;
    stage_ = stage;
    if (verbosity_ == Verbosity::kVerbose) {
        if (is_new_stage) {
            const double seconds = std::chrono::duration<double>(now - start_).count();
            std::fprintf(stderr, "%8.2f s  %s: %s\n", seconds, title_.c_str(), stage_.c_str());
        }
    } else if (verbosity_ == Verbosity::kNormal && is_terminal_) {
        const bool is_complete = fraction >= 1.0;
        if (is_new_stage || is_complete || now - last_drawn_ > std::chrono::milliseconds(100)) {
            draw(fraction);
            last_drawn_ = now;
            is_drawn_ = true;
        }
    }
}

void ProgressBar::draw(double fraction) const {
    const double done =
        (static_cast<double>(place_.number - 1) + std::clamp(fraction, 0.0, 1.0)) / static_cast<double>(place_.count);
    constexpr std::size_t kBarWidth = 30;
    const auto filled = static_cast<std::size_t>(std::lround(done * static_cast<double>(kBarWidth)));
    std::ostringstream line;
    line << '[' << std::string(filled, '#') << std::string(kBarWidth - filled, '.') << "] " << std::lround(100 * done)
         << " %  ";
    if (place_.count > 1) {
        line << place_.number << " of " << place_.count << "  ";
    }
    line << time_left(Clock::now() - place_.start, done) << title_ << ": " << stage_;
    // A wrapped line could not be erased.
    std::fputs((kEraseLine + line.str().substr(0, terminal_columns() - 1)).c_str(), stderr);
    std::fflush(stderr);
}

std::function<void(const Diagnostic&)> warn_above(ProgressBar& bar, const std::filesystem::path& input) {
    return [&bar, input](const Diagnostic& warning) {
        bar.erase();
        print_warning(input.string() + ": " + with_hints(warning));
    };
}

}  // namespace scaleaxis::app
