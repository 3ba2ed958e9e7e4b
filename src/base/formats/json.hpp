// SPDX-License-Identifier: Apache-2.0
/// \file
/// Values of JSON. Objects keep the order of their members. Text is parsed and written by nlohmann-json, whose headers
/// are slow to compile and stay in json.cpp.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <ranges>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "scaleaxis/export.hpp"

namespace scaleaxis::inline v1 {

/// A value is not what it has to be: "there is no member 'scale'", "'x' is no number".
class SCALEAXIS_EXPORT JsonError : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
};

class SCALEAXIS_EXPORT Json {
   public:
    using Elements = std::vector<Json>;
    using Member = std::pair<std::string, Json>;
    using Members = std::vector<Member>;

    Json(std::nullptr_t = nullptr) noexcept;
    Json(const char* text);
    Json(std::string_view text);
    Json(std::string text);
    template <class Number>
    requires(std::is_arithmetic_v<Number> || std::is_enum_v<Number>) Json(Number number) : Json(stored(number)) {}
    template <std::ranges::input_range Range>
    requires(!std::convertible_to<Range, std::string_view> && !std::same_as<std::remove_cvref_t<Range>, Json>)
        Json(const Range& range)
        : Json(array()) {
        for (const auto& element : range) {
            push_back(element);
        }
    }
    struct Field;
    /// An object, `{{"name", value}, ...}`, of different names.
    Json(std::initializer_list<Field> fields);
    /// An array, of coordinates and the like.
    Json(std::initializer_list<double> numbers);
    Json(const Json& other);
    Json(Json&& other) noexcept;
    Json& operator=(Json other) noexcept;
    ~Json();

    static Json array(std::initializer_list<Json> elements = {});
    static Json object();
    /// \returns null, and `is_valid` false, if the text is no JSON
    static Json parse(std::string_view text, bool* is_valid = nullptr);
    /// What is no UTF-8 becomes replacement characters. \param indent of each level; negative: all in one line
    std::string dump(int indent = -1) const;

    bool is_null() const { return value_.index() == 0; }
    bool is_number() const { return value_.index() >= 2 && value_.index() <= 4; }
    bool is_string() const { return std::holds_alternative<std::string>(value_); }
    bool is_array() const { return std::holds_alternative<Elements>(value_); }
    bool is_object() const { return std::holds_alternative<Members>(value_); }

    /// A number, a bool, an enumerator, or a `std::string`. \throws JsonError
    template <class Value>
    Value get() const {
        if constexpr (std::same_as<Value, std::string>) {
            return text();
        } else if constexpr (std::same_as<Value, bool>) {
            return is_true();
        } else if constexpr (std::floating_point<Value>) {
            return static_cast<Value>(number());
        } else {
            return static_cast<Value>(integer());
        }
    }

    /// How many elements or members.
    std::size_t size() const;
    /// \throws JsonError if it is no array
    const Elements& elements() const;
    Elements& elements();
    /// \throws JsonError if it is no object
    const Members& members() const;

    bool contains(std::string_view name) const { return find(name) != nullptr; }
    /// Null if it is no object that has this member.
    const Json* find(std::string_view name) const;
    /// \throws JsonError if there is no such member
    const Json& at(std::string_view name) const;
    /// The member, which is added if it is not there; null becomes an object.
    Json& operator[](std::string_view name);
    /// The member, or else `otherwise`.
    template <class Value>
    Value value(std::string_view name, Value otherwise) const {
        const Json* member = find(name);
        if constexpr (std::same_as<Value, Json>) {
            return member != nullptr ? *member : otherwise;
        } else {
            return member != nullptr ? member->get<Value>() : otherwise;
        }
    }
    void erase(std::string_view name);
    /// Adds the members of another object, in place of those of their names.
    void update(const Json& other);
    /// Adds an element; null becomes an array.
    void push_back(Json element);

    bool operator==(const Json& other) const;

   private:
    // Whole numbers are unsigned only if they have to be, so that equal ones are equal.
    using Stored =
        std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Elements, Members>;

    template <class Number>
    static Stored stored(Number number) {
        if constexpr (std::same_as<Number, bool>) {
            return number;
        } else if constexpr (std::floating_point<Number>) {
            return static_cast<double>(number);
        } else if constexpr (std::is_enum_v<Number>) {
            return static_cast<std::int64_t>(number);
        } else if (std::in_range<std::int64_t>(number)) {
            return static_cast<std::int64_t>(number);
        } else {
            return static_cast<std::uint64_t>(number);
        }
    }
    explicit Json(Stored value) noexcept;

    friend struct JsonText;

    const std::string& text() const;
    double number() const;
    std::int64_t integer() const;
    bool is_true() const;

    Stored value_;
};

struct Json::Field {
    std::string_view name;
    mutable Json value;  // taken from the list
};

}  // namespace scaleaxis::inline v1
