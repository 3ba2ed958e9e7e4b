// SPDX-License-Identifier: Apache-2.0
#include "interrupts.hpp"

#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <thread>
#include <utility>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::app {

std::stop_token catch_interrupts() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // all later threads inherit this: only the watcher gets them
    std::stop_source source;
    std::stop_token token = source.get_token();
    std::thread([signals, source = std::move(source)]() mutable {
        int signal = 0;
        sigwait(&signals, &signal);
        source.request_stop();
        std::signal(SIGINT, SIG_DFL);
        std::signal(SIGTERM, SIG_DFL);
        pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
        while (true) {
            pause();  // the next signal kills the program here
        }
    }).detach();
    return token;
}

namespace {

std::stop_token& interrupts_of_command() {
    static std::stop_token token;
    return token;
}

}  // namespace

const std::stop_token& current_interrupts() { return interrupts_of_command(); }

void set_current_interrupts(const std::stop_token& cancel) { interrupts_of_command() = cancel; }

void stop_if_requested(const std::stop_token& cancel) {
    if (cancel.stop_requested()) {
        throw Cancelled();
    }
}

void ignore_file_size_signal() { std::signal(SIGXFSZ, SIG_IGN); }

}  // namespace scaleaxis::app
