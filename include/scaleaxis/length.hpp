// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lengths that options take: relative to the size of the input, or in its units.
#pragma once

namespace scaleaxis::inline v1 {

/// A length that says what it is measured in: relative to the diagonal of the bounding box of what the option is about,
/// or absolute. No plain number becomes one: as an option, a plain number is a length in units of the input.
class Length {
   public:
    static constexpr Length relative(double part_of_diagonal) { return {part_of_diagonal, false}; }
    static constexpr Length absolute(double length) { return {length, true}; }

    /// As it was given: a part of the diagonal, or a length in units of the input.
    constexpr double value() const { return value_; }
    constexpr bool is_absolute() const { return is_absolute_; }

    /// In units of an input whose bounding box has this diagonal.
    constexpr double of(double diagonal) const { return is_absolute_ ? value_ : value_ * diagonal; }

    friend constexpr bool operator==(const Length&, const Length&) = default;

   private:
    constexpr Length(double value, bool is_absolute) : value_(value), is_absolute_(is_absolute) {}

    double value_;
    bool is_absolute_;
};

}  // namespace scaleaxis::inline v1
