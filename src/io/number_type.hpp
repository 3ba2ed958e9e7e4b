// SPDX-License-Identifier: Apache-2.0
/// \file
/// Numbers of a type that a file names.
#pragma once

#include <bit>
#include <cstddef>
#include <optional>
#include <string_view>

namespace scaleaxis::io {

/// As NumPy calls them: signed and unsigned integers, floating point, and the bytes of each.
enum class NumberType { kI1, kU1, kI2, kU2, kI4, kU4, kI8, kU8, kF2, kF4, kF8 };

/// The type of that name, as `i2`; none: there is no such type.
std::optional<NumberType> number_type(std::string_view name);

/// The type that a table says for a name, as `short i2 ushort u2`; none: it is not in the table.
std::optional<NumberType> number_type_in(std::string_view table, std::string_view name);

std::size_t bytes_per_number(NumberType type);

constexpr bool is_integer(NumberType type) { return type < NumberType::kF2; }

/// Is a number one of the type?
bool is_of_type(double value, NumberType type);

/// The number that begins at `from`.
double number_at(const char* from, NumberType type, std::endian order);

/// The nearest float. What is beyond 2^24, from where on not all whole numbers are floats, stays beyond it: so of the
/// labels of an image those up to 2^24 are told from all others.
float as_float(double value);

/// `count` numbers, which begin at `from`, as floats; see `as_float`.
void read_numbers(const char* from, std::size_t count, NumberType type, std::endian order, float* to);

}  // namespace scaleaxis::io
