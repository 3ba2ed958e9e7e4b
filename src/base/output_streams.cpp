// SPDX-License-Identifier: Apache-2.0
#include <cerrno>

#include "base/files.hpp"

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#else
#include <unistd.h>
#endif

namespace scaleaxis::inline v1 {

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
