// SPDX-License-Identifier: Apache-2.0
// The entry of libFuzzer, compiled once for each target.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto& targets = scaleaxis::test::fuzz_targets();
    static const auto target =
        std::ranges::find(targets, std::string_view(SCALEAXIS_FUZZ_TARGET), &scaleaxis::test::FuzzTarget::name);
    target->read(std::as_bytes(std::span(data, size)));
    return 0;
}
