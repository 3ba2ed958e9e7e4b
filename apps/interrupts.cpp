// SPDX-License-Identifier: Apache-2.0
#include "interrupts.hpp"

#include <csignal>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "scaleaxis/errors.hpp"

#if defined(_WIN32)
#include <windows.h>
#else
#include <pthread.h>
#endif

namespace scaleaxis::app {

namespace {

std::stop_token& interrupts_of_command() {
    static std::stop_token token;
    return token;
}

/// The temporary files of this process, and their lock.
struct TemporaryFiles {
    std::mutex mutex;
    std::set<std::filesystem::path> files;
};

TemporaryFiles& temporary_files() {
    static auto* const files = new TemporaryFiles;  // the watcher of signals may look at it after `main`
    return *files;
}

void remove_temporary_files() {
    const std::lock_guard lock(temporary_files().mutex);
    for (const std::filesystem::path& file : temporary_files().files) {
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
    }
}

#if defined(_WIN32)
std::stop_source& source_of_interrupts() {
    static auto* const source = new std::stop_source;  // a handler has a thread of its own, also after `main`
    return *source;
}

BOOL WINAPI handle_interrupt(DWORD) {
    const bool is_first = source_of_interrupts().request_stop();
    if (!is_first) {
        remove_temporary_files();
    }
    return is_first ? TRUE : FALSE;  // FALSE: the program ends
}
#endif

}  // namespace

#if defined(_WIN32)
std::stop_token catch_interrupts() {
    SetConsoleCtrlHandler(handle_interrupt, TRUE);
    return source_of_interrupts().get_token();
}
#else
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
        sigwait(&signals, &signal);  // the second one kills the program
        remove_temporary_files();
        std::signal(signal, SIG_DFL);
        pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
        std::raise(signal);
    }).detach();
    return token;
}
#endif

const std::stop_token& current_interrupts() { return interrupts_of_command(); }

void set_current_interrupts(const std::stop_token& cancel) { interrupts_of_command() = cancel; }

TemporaryFile::TemporaryFile(std::filesystem::path file) : file_(std::move(file)) {
    const std::lock_guard lock(temporary_files().mutex);
    temporary_files().files.insert(file_);
}

TemporaryFile::~TemporaryFile() {
    const std::lock_guard lock(temporary_files().mutex);
    temporary_files().files.erase(file_);
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
}

void stop_if_requested(const std::stop_token& cancel) {
    if (cancel.stop_requested()) {
        throw Cancelled();
    }
}

void ignore_file_size_signal() {
#if defined(SIGXFSZ)
    std::signal(SIGXFSZ, SIG_IGN);
#endif
}

}  // namespace scaleaxis::app
