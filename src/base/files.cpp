// SPDX-License-Identifier: Apache-2.0
#include "base/files.hpp"

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#endif

namespace scaleaxis::inline v1 {

std::string utf8_of(const std::filesystem::path& file) {
    const std::u8string text = file.u8string();
    return {text.begin(), text.end()};
}

std::filesystem::path path_of(std::string_view utf8) { return std::u8string(utf8.begin(), utf8.end()); }

std::FILE* open_stream(const std::filesystem::path& file, const char* mode) {
#if defined(_WIN32)
    if (std::string_view(mode).ends_with('x')) {  // which not every C library there knows
        const int created = ::_wopen(file.c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY, _S_IREAD | _S_IWRITE);
        return created < 0 ? nullptr : ::_fdopen(created, "wb");
    }
    return ::_wfopen(file.c_str(), std::wstring(mode, mode + std::string_view(mode).size()).c_str());
#else
    return std::fopen(file.c_str(), mode);
#endif
}

}  // namespace scaleaxis::inline v1
