// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pieces of messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// "1 edge", "2 edges". \param many empty: an s is appended
std::string counted(std::int64_t count, std::string_view one, std::string_view many = {});

/// "1 component, 2 tunnels, 0 voids, Euler characteristic -1".
std::string in_words(const Topology& topology);

/// \param digits at most, those that count
std::string to_text(double value, int digits = 3);

/// A message in the making. Numbers are as streams write them, but the same in all locales.
class Words {
   public:
    explicit Words(int digits = 6) : digits_(digits) {}

    template <class Item>
    Words& operator<<(const Item& item) {
        if constexpr (std::is_floating_point_v<Item>) {
            text_ += to_text(item, digits_);
        } else if constexpr (std::is_integral_v<Item> && !std::is_same_v<Item, char>) {
            text_ += std::to_string(item);
        } else {
            text_ += item;
        }
        return *this;
    }
    const std::string& str() const { return text_; }

   private:
    std::string text_;
    int digits_;  ///< of numbers that are not whole
};

/// "12.3 %" of a whole.
std::string percentage(double part, double whole);

/// "(x y z)", of nine digits each.
std::string to_text(const Point& p);

}  // namespace scaleaxis::inline v1
