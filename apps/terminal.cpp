// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::app {

namespace {

// A signal handler can reach nothing else.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

bool can_draw_on_stderr() {
    const char* term = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && term != nullptr && std::string_view(term) != "dumb";
}

std::size_t terminal_columns() {
    winsize size{};
    const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return is_known ? size.ws_col : 80;
}

void print_line(std::string_view kind, std::string_view message) {
    std::fprintf(stderr, "scaleaxis: %.*s: %.*s\n", static_cast<int>(kind.size()), kind.data(),
                 static_cast<int>(message.size()), message.data());
}

constexpr const char* kEraseLine = "\r\x1b[K";

}  // namespace

void print_warning(std::string_view message) { print_line("warning", message); }

void print_error(std::string_view message) { print_line("error", message); }

void catch_interrupts() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = true; };
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);  // the second signal has its default effect
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool is_interrupted() { return interrupted; }

void stop_if_interrupted() {
    if (is_interrupted()) {
        throw Cancelled();
    }
}

ProgressBar::ProgressBar(std::string title, Verbosity verbosity)
    : title_(std::move(title)), verbosity_(verbosity), is_terminal_(can_draw_on_stderr()) {}

ProgressBar::~ProgressBar() { erase(); }

void ProgressBar::erase() {
    if (is_drawn_) {
        std::fputs(kEraseLine, stderr);
        is_drawn_ = false;
    }
}

bool ProgressBar::update(std::string_view stage, double fraction) {
    const auto now = Clock::now();
    const bool is_new_stage = stage != stage_;
    stage_ = stage;
    if (verbosity_ == Verbosity::kVerbose) {
        if (is_new_stage) {
            const double seconds = std::chrono::duration<double>(now - start_).count();
            std::fprintf(stderr, "%8.2f s  %s: %s\n", seconds, title_.c_str(), stage_.c_str());
        }
    } else if (verbosity_ == Verbosity::kNormal && is_terminal_) {
        if (is_new_stage || now - last_drawn_ > std::chrono::milliseconds(100)) {
            draw(fraction);
            last_drawn_ = now;
            is_drawn_ = true;
        }
    }
    return !is_interrupted();
}

void ProgressBar::draw(double fraction) const {
    const double done = std::clamp(fraction, 0.0, 1.0);
    constexpr std::size_t kBarWidth = 30;
    const auto filled = static_cast<std::size_t>(std::lround(done * static_cast<double>(kBarWidth)));
    std::string line = "[";
    line.append(filled, '#').append(kBarWidth - filled, '.').append("] ");
    line.append(std::to_string(std::lround(100 * done))).append(" %  ");
    line.append(title_).append(": ").append(stage_);
    // A wrapped line could not be erased.
    line.resize(std::min(line.size(), terminal_columns() - 1));
    std::fputs((kEraseLine + line).c_str(), stderr);
    std::fflush(stderr);
}

}  // namespace scaleaxis::app
