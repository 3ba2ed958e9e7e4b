// SPDX-License-Identifier: Apache-2.0
#include "xacro.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "outputs.hpp"
#include "scaleaxis/errors.hpp"

#if __has_include(<spawn.h>)
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace scaleaxis::app {

namespace fs = std::filesystem;

bool is_xacro(const fs::path& file) { return format_of(file, "") == "xacro"; }

#if __has_include(<spawn.h>)

namespace {

using ScratchFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

std::string text_in(std::FILE* file) {
    std::rewind(file);
    std::string text;
    std::array<char, 65536> buffer;
    for (std::size_t size = 0; (size = std::fread(buffer.data(), 1, buffer.size(), file)) > 0;) {
        text.append(buffer.data(), size);
    }
    return text;
}

std::string last_line(std::string text) {
    text.erase(text.find_last_not_of(" \n\r") + 1);
    return text.substr(text.rfind('\n') + 1);
}

}  // namespace

std::string expanded_xacro(const fs::path& file, const std::vector<std::string>& arguments) {
    if (!fs::is_regular_file(file)) {
        throw FileError(file.string() + ": cannot be opened");
    }
    // Files rather than pipes: neither of two can fill up.
    const ScratchFile out(std::tmpfile(), &std::fclose), err(std::tmpfile(), &std::fclose);
    if (!out || !err) {
        throw FileError(file.string() + ": there is no place for what xacro makes of it");
    }
    std::vector<std::string> words{"xacro", fs::absolute(file).string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    std::ranges::transform(words, std::back_inserter(pointers), [](std::string& word) { return word.data(); });
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(out.get()), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(err.get()), STDERR_FILENO);
    pid_t child = 0;
    const int fault = posix_spawnp(&child, "xacro", &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (fault != 0) {
        throw FileError(file.string() + ": the program xacro expands it, and is not installed: pip install xacro");
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (status != 0) {
        const std::string why = last_line(text_in(err.get()));
        throw FileError(file.string() + ": xacro does not expand it" + (why.empty() ? "" : ": " + why));
    }
    return text_in(out.get());
}

#else

std::string expanded_xacro(const fs::path& file, const std::vector<std::string>&) {
    throw FileError(file.string() + ": expand it by xacro first");
}

#endif

}  // namespace scaleaxis::app
