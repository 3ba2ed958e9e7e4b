// SPDX-License-Identifier: Apache-2.0
/// \file
/// Results for JavaScript: one value of JSON, with arrays that it copies from memory.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/formats/json.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::wasm {

/// The type of the numbers that elements consist of, as JavaScript chooses its arrays by it, and how many there are.
template <class Element>
struct Numbers;
template <>
struct Numbers<double> {
    static constexpr const char* kType = "f64";
};
template <>
struct Numbers<Point> : Numbers<double> {};
template <>
struct Numbers<Ball> : Numbers<double> {};
template <>
struct Numbers<Index> {
    static constexpr const char* kType = "i32";
};
template <std::size_t size>
struct Numbers<std::array<Index, size>> : Numbers<Index> {};
template <>
struct Numbers<char> {
    static constexpr const char* kType = "u8";
};

class Answer {
   public:
    Json value = Json::object();

    /// Stands for an array in `value`. \param numbers a vector or a string, kept until the answer goes
    template <class Array>
    Json array(Array numbers) {
        const auto kept = std::make_shared<const Array>(std::move(numbers));
        kept_.push_back(kept);
        Json stand_in = Json::object();
        stand_in["$array"] =
            Json::array({Numbers<typename Array::value_type>::kType, reinterpret_cast<std::uintptr_t>(kept->data()),
                         kept->size() * sizeof(typename Array::value_type)});
        return stand_in;
    }

   private:
    std::vector<std::shared_ptr<const void>> kept_;
};

}  // namespace scaleaxis::wasm
