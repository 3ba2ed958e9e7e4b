// SPDX-License-Identifier: Apache-2.0
// zlib's functions that compress, without compressing: what the page shows is read where it was made, and the real ones take
// 28 kB of the module.
#include <string.h>
#include <zlib.h>

enum { kBlock = 65535 };  // the longest that DEFLATE stores

uLong compressBound(uLong size) { return size + 5 * (size / kBlock + 1) + 6; }

int compress2(Bytef* to, uLongf* to_size, const Bytef* from, uLong size, int level) {
    (void)level;
    if (*to_size < compressBound(size)) {
        return Z_BUF_ERROR;
    }
    Bytef* out = to;
    *out++ = 0x78;  // a window of 32 kB
    *out++ = 0x01;  // the fastest level
    const Bytef* rest = from;
    uLong left = size;
    do {
        const unsigned block = left < kBlock ? (unsigned)left : kBlock;
        left -= block;
        *out++ = left == 0;  // is it the last?
        *out++ = block & 255;
        *out++ = block >> 8;
        *out++ = ~block & 255;
        *out++ = ~block >> 8 & 255;
        memcpy(out, rest, block);
        out += block;
        rest += block;
    } while (left > 0);
    const uLong sum = adler32(adler32(0, Z_NULL, 0), from, (uInt)size);
    for (int shift = 24; shift >= 0; shift -= 8) {
        *out++ = sum >> shift & 255;
    }
    *to_size = (uLongf)(out - to);
    return Z_OK;
}
