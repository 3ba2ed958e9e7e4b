// SPDX-License-Identifier: Apache-2.0
#include "base/files.hpp"

#include <cerrno>

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#else
#include <unistd.h>
#endif

namespace scaleaxis::inline v1 {

std::string utf8_of(const std::filesystem::path& file) {
    const std::u8string text = file.u8string();
    return {text.begin(), text.end()};
}

std::filesystem::path path_of(std::string_view utf8) { return std::u8string(utf8.begin(), utf8.end()); }

std::FILE* open_stream(const std::filesystem::path& file, const char* mode) {
#if defined(_WIN32)
    return ::_wfopen(file.c_str(), std::wstring(mode, mode + std::string_view(mode).size()).c_str());
#else
    return std::fopen(file.c_str(), mode);
#endif
}

std::FILE* open_stdout() {
#if defined(_WIN32)
    const int copy = ::_dup(::_fileno(stdout));
    ::_setmode(copy, _O_BINARY);
    return ::_fdopen(copy, "wb");
#else
    return ::fdopen(::dup(STDOUT_FILENO), "wb");
#endif
}

int why_not_writable(const std::filesystem::path& file) {
#if defined(_WIN32)
    constexpr int kWrite = 2;
    return ::_waccess(file.c_str(), kWrite) == 0 ? 0 : errno;
#else
    return ::access(file.c_str(), W_OK) == 0 ? 0 : errno;
#endif
}

}  // namespace scaleaxis::inline v1
